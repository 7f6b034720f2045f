/* Follows a particle's way through a step among colliders by the integrator of the scene, from
 * impact to impact.
 *
 * With `semi_implicit` the way is a straight line at the velocity after the step's forces, and a
 * surface answers that velocity. The errors of energy at bounces do not add up.
 *
 * With `position_first`, its mirror image, the line is flown and answered at the velocity before
 * the forces. These then act on the velocity after the impacts.
 *
 * With `trapezoid` and `rk4` the way is a curve. The impact is found by regula falsi, where each
 * guess is a shorter step of the integrator. The surface answers the velocity there, and another
 * step of the integrator leads to the next impact or the end. So both integrators keep their
 * orders. A particle that lies on a surface hits it with less than the velocity that the forces
 * give in the step. It flies the rest of the step as with semi_implicit, so that surfaces carry it,
 * also in their edges. A surface is missed if the curve passes it between two places whose straight
 * connection does not; it is at most acceleration * time^2 / 8 deep. */
#ifndef KILN_SHARED_SWEEP_H
#define KILN_SHARED_SWEEP_H

#include "shared/carry.h"
#include "shared/collide.h"
#include "shared/integrate.h"

/* Shaders of scenes that use semi_implicit are compiled without the code of the others. */
#if defined(GL_core_profile) && !defined(SWEEP_ALL)
#define SWEEP_IS_CURVED      false
#define SWEEP_POSITION_FIRST false
#else
#define SWEEP_IS_CURVED      (STEP_INTEGRATION >= INTEGRATE_TRAPEZOID)
#define SWEEP_POSITION_FIRST (STEP_INTEGRATION == INTEGRATE_POSITION_FIRST)
#endif

/* Shaders of systems outside of families are compiled without the first impact. */
#if defined(GL_core_profile) && !defined(FAMILY)
#define SWEEP_TOUCHES false
#else
#define SWEEP_TOUCHES true
#endif

/* Guesses of the time of an impact. The error of each is that of the one before, times the velocity
 * that the forces give in a step, divided by twice the velocity of the impact. */
#define SWEEP_GUESSES 3u

/* m: allowed error of a guess. */
#define SWEEP_CLOSE 3.814697265625e-6f

/* The most pieces of a way: for each impact two for a guess, the one with the impact, and the one
 * behind it. */
#define SWEEP_PIECES (COLLIDE_BOUNCES * (2u * SWEEP_GUESSES + 2u))

/* A particle on its way. The present piece goes from `now` to `ahead`. */
struct sweep_path {
    S(collide_state) now;
    S(collide_state) ahead;
    S(collide_hit) hit; /* the last impact */
    float until;        /* the part of the step at which the way ends */
    float later;        /* time by which the curve is known to have hit a surface */
    float aim;          /* end of the next piece */
    float3 push;        /* m in a whole step, by other particles of its system */
    uint bounces;
    uint guesses; /* guesses so far of the time of the next impact */
    bool curved;
};

FN S(sweep_path) sweep_start(SIM_PARAM S(collide_state) start, S(collide_state) end, float3 push,
                             bool curved)
{
    EXACT S(sweep_path) path;
    path.now = start;
    path.ahead = end;
    path.hit.part = -1.0f;
    path.hit.box = 0u;
    path.hit.face = 0u;
    path.until = end.since;
    path.later = end.since;
    path.aim = end.since;
    path.push = push;
    path.bounces = 0u;
    path.guesses = 0u;
    path.curved = curved;
    if (!path.curved && !SWEEP_POSITION_FIRST)
        path.now.velocity = end.velocity;
    return path;
}

/* Returns the end of the next piece of a curve or of a straight line. carried: m in a whole step,
 * by the node that the particle moves with (carry.h). */
FN S(collide_state) sweep_ahead(SIM_PARAM S(sweep_path) path, float3 carried,
                                S(value_clocks) clocks)
{
    EXACT S(collide_state) ahead = path.now;
    EXACT float part = path.aim - path.now.since;
    if (path.curved) {
        ahead = integrate(SIM path.now, path.aim, clocks);
        ahead.position = float3_add_scaled(ahead.position, path.push, part);
        ahead.position = carry_on(SIM ahead.position, carried, part);
        return ahead;
    }
    EXACT float time_s = part * STEP(derived.dt_s);
    ahead.position = float3_add_scaled(path.now.position, path.now.velocity, time_s);
    ahead.position = carry_on(SIM ahead.position, carried, part);
    ahead.since = path.aim;
    return ahead;
}

/* Returns the change of the velocity by forces along the piece. */
FN float3 sweep_change(S(sweep_path) path)
{
    EXACT float3 change = float3_sub(path.ahead.velocity, path.now.velocity);
    return change;
}

/* Returns the state at the impact, after this part of the piece. */
FN S(collide_state) sweep_meeting(S(sweep_path) path, float part)
{
    EXACT S(collide_state) y = path.now;
    EXACT float3 way = float3_sub(path.ahead.position, path.now.position);
    EXACT float3 change = sweep_change(path);
    EXACT float time = path.ahead.since - path.now.since;
    y.position = float3_add_scaled(path.now.position, way, part);
    y.since = path.now.since + time * part;
    if (path.curved)
        y.velocity = float3_add_scaled(path.now.velocity, change, part);
    return y;
}

/* Returns whether a blow is less than what the forces give in the piece, as for a particle that
 * lies on a surface. */
FN bool sweep_is_gentle(S(sweep_path) path, float3 blow)
{
    EXACT float3 change = sweep_change(path);
    EXACT float given = float3_dot(change, change);
    EXACT float taken = float3_dot(blow, blow);
    return taken <= given;
}

/* Returns whether the time of an impact must be found more closely. It need not if the curve's bend
 * makes no difference. */
FN bool sweep_is_rough(SIM_PARAM S(sweep_path) path, float part)
{
    EXACT float3 change = sweep_change(path);
    EXACT float time_s = (path.ahead.since - path.now.since) * STEP(derived.dt_s);
    EXACT float given = float3_length(change);
    EXACT float bend = 0.5f * given * time_s * part * (1.0f - part);
    return path.guesses < SWEEP_GUESSES && bend > SWEEP_CLOSE;
}

/* Corrects the energy of a particle that leaves a surface. The impact has put it a little in front
 * of the surface, at a height that it climbs against the forces; without the correction, each
 * bounce would add the energy of that height. A slow particle is left as it is, since the climb
 * would take long. */
FN S(collide_state) sweep_climb(SIM_PARAM S(collide_state) left, S(sweep_path) path, float3 from,
                                float3 blow)
{
    EXACT S(collide_state) y = left;
    EXACT float3 outwards = float3_normalize(blow, blow);
    EXACT float3 lift = float3_sub(left.position, from);
    EXACT float3 change = sweep_change(path);
    EXACT float height = float3_dot(lift, outwards);
    EXACT float speed = float3_dot(left.velocity, outwards);
    EXACT float given = float3_dot(change, change);
    EXACT float part = exact_div(height, speed * STEP(derived.dt_s));
    EXACT float of_piece = exact_div(part, path.ahead.since - path.now.since);
    bool climbs = height > 0.0f && speed > 0.0f && speed * speed > given;
    if (climbs && part < path.until - left.since) {
        y.velocity = float3_add_scaled(left.velocity, change, of_piece);
        y.since = left.since + part;
    }
    return y;
}

/* Moves past a piece without an impact. */
FN S(sweep_path) sweep_past(S(sweep_path) before)
{
    EXACT S(sweep_path) path = before;
    path.now.position = path.ahead.position;
    if (!path.curved)
        return path;
    path.now = path.ahead;
    if (path.ahead.since == path.later) {
        path.later = path.until;
        path.guesses = 0u;
    }
    path.aim = path.later;
    return path;
}

/* Moves on from an impact, to the end if no other impact follows. left: the state behind it, with
 * the velocity in the world; from, blow: as for sweep_climb. */
FN S(sweep_path) sweep_off(SIM_PARAM S(sweep_path) before, S(collide_hit) hit,
                           S(collide_state) left, float3 from, float3 blow, float3 carried)
{
    EXACT S(sweep_path) path = before;
    path.now = left;
    if (before.curved)
        path.now = sweep_climb(SIM left, before, from, blow);
    path.now.velocity = carry_to_world(SIM path.now.velocity, carried, -1.0f);
    path.hit = hit;
    path.later = path.until;
    path.aim = path.until;
    path.push = FLOAT3(0.0f, 0.0f, 0.0f);
    path.bounces++;
    path.guesses = 0u;
    return path;
}

/* Returns the first impact of a step, from the state behind it in the world. */
FN S(collide_touch) sweep_touch(SIM_PARAM S(collide_state) s, S(collide_hit) hit, float radius,
                                float3 carried)
{
    uint kind = AROUND(colliders[hit.box].kind);
    EXACT S(collide_touch) touch =
        collide_touched(s, hit.box, collide_face_met(SIM hit.box, radius, s, hit.face));
    touch.velocity = carry_to_world(SIM touch.velocity, carried, -1.0f);
    touch.reach = COLLIDE_MEETS_CENTRES(kind) ? 0.0f : radius;
    return touch;
}

/* Returns the end of a step after its last possible impact: the particle is carried by the surface
 * that it hit last. */
FN S(collide_state) sweep_stay(SIM_PARAM S(sweep_path) path, float radius)
{
    EXACT S(collide_state) now = path.now;
    uint last = path.hit.box;
#if COLLIDE_HAS_VOLUMES
    if (AROUND(colliders[last].kind) == COLLIDER_VOLUME)
        now.position =
            volume_carry(SIM AROUND(colliders[last]), path.hit.face, path.until, now.position);
#endif
    if (COLLIDE_IS_ORIENTED(AROUND(colliders[last])))
        now.position = collide_oriented_carry(SIM last, now.since, path.until, now.position);
    now.position = collide_rise(SIM now.position, path.until, radius);
    return now;
}

/* Does sweep for the given kind of way. */
FN S(collide_way) sweep_along(SIM_PARAM S(collide_state) start, S(collide_state) end, float3 push,
                              float3 carried, S(value_clocks) clocks, S(collide_answer) answer,
                              bool curved)
{
    EXACT S(collide_way) way;
    way.first = collide_no_touch();
    EXACT S(collide_answer) draw = answer;
    EXACT S(sweep_path) path = sweep_start(SIM start, end, push, curved);
    for (uint piece = 0u; piece < SWEEP_PIECES && path.bounces < COLLIDE_BOUNCES; piece++) {
        S(collide_hit) hit =
            collide_first(SIM path.now, path.ahead.position, path.ahead.since, answer.radius);
        if (hit.part < 0.0f) {
            bool arrives = path.ahead.since == path.until;
            path = sweep_past(path);
            way.end = path.now;
            if (arrives)
                return way;
        } else {
            EXACT S(collide_state) at = sweep_meeting(path, hit.part);
            at.velocity = carry_to_world(SIM at.velocity, carried, 1.0f);
            draw.purpose = collide_purpose(SIM path.bounces);
            EXACT S(collide_state) left = collide_impact(SIM at, hit.box, hit.face, draw);
            EXACT float3 blow = float3_sub(left.velocity, at.velocity);
            if (path.curved && path.guesses == 0u && sweep_is_gentle(path, blow)) {
                path.curved = false;
                path.now.velocity = path.ahead.velocity;
                continue; /* continues along the same piece */
            }
            if (path.curved && sweep_is_rough(SIM path, hit.part)) {
                path.later = path.ahead.since;
                path.aim = at.since;
                path.guesses++;
            } else {
                if (SWEEP_TOUCHES && path.bounces == 0u)
                    way.first = sweep_touch(SIM left, hit, answer.radius, carried);
                path = sweep_off(SIM path, hit, left, at.position, blow, carried);
            }
        }
        path.ahead = sweep_ahead(SIM path, carried, clocks);
    }
    way.end = sweep_stay(SIM path, answer.radius);
    return way;
}

/* Follows a particle from `start` to the time of `end`, its place without colliders. `push`, m, is
 * the part of that by other particles of its system, and `carried` that of a whole step by the node
 * that it moves with. The result is outside of every collider. */
FN S(collide_way) sweep(SIM_PARAM S(collide_state) start, S(collide_state) end, float3 push,
                        float3 carried, S(value_clocks) clocks, S(collide_answer) answer)
{
    EXACT S(collide_way) way;
#ifndef GL_core_profile /* in C, where compilers then make two loops */
    if (!SWEEP_IS_CURVED) {
        way = sweep_along(SIM start, end, push, carried, clocks, answer, false);
        return way;
    }
#endif
    way = sweep_along(SIM start, end, push, carried, clocks, answer, SWEEP_IS_CURVED);
    return way;
}

#endif
