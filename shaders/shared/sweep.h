/* A particle's way through a step among colliders: to an impact, and from it on, by the integrator
 * of the scene.
 *
 * With `semi_implicit` it is a straight line at the velocity after the step's forces, and a surface
 * answers that velocity. What a bounce gives or takes by that does not add up.
 *
 * With `position_first`, its mirror image, the line is flown and answered at the velocity before
 * the forces, which then act on what the impacts have left.
 *
 * With `trapezoid` and `rk4` it is a curve. Where one meets a surface is found by regula falsi,
 * each guess being a shorter step of the integrator; the surface answers the velocity there, and
 * another step of the integrator leads from it to the next impact or the end. So both keep their
 * orders. What lies on a surface is struck by less than the forces give in the step: it flies the
 * rest of the step as with semi_implicit, so that surfaces bear what the forces give, also in their
 * edges. What a curve meets between two places whose straight connection meets nothing is not seen;
 * it is at most acceleration * time^2 / 8 deep.
 */
#ifndef KILN_SHARED_SWEEP_H
#define KILN_SHARED_SWEEP_H

#include "shared/collide.h"
#include "shared/integrate.h"

/* Shaders of scenes that move by semi_implicit are spared the code of the others. */
#if defined(GL_core_profile) && !defined(SWEEP_ALL)
#define SWEEP_IS_CURVED      false
#define SWEEP_POSITION_FIRST false
#else
#define SWEEP_IS_CURVED      (STEP(integration) >= INTEGRATE_TRAPEZOID)
#define SWEEP_POSITION_FIRST (STEP(integration) == INTEGRATE_POSITION_FIRST)
#endif

/* Guesses of the time of an impact. Each is off by less than the one before, by a factor of the
 * velocity that the forces give in a step to twice that of the impact. */
#define SWEEP_GUESSES 3u

/* m: what a guess may be off by. */
#define SWEEP_CLOSE 3.814697265625e-6f

/* Pieces of a way that are looked at: two for a guess, the one that meets, and the one behind it.
 */
#define SWEEP_PIECES (COLLIDE_BOUNCES * (2u * SWEEP_GUESSES + 2u))

/* A particle on its way. Between `now` and `ahead` is the piece that is looked at. */
struct sweep_path {
    S(collide_state) now;
    S(collide_state) ahead;
    S(collide_hit) hit; /* the last impact */
    float until;        /* the part of the step at which the way ends */
    float later;        /* by when the curve is known to have met something */
    float aim;          /* where the next piece is to end */
    float3 push;        /* m in a whole step, from the others of its system */
    uint bounces;
    uint guesses; /* of the time of the next impact */
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

/* To the end of the next piece: of a curve, or of a straight line. */
FN S(collide_state) sweep_ahead(SIM_PARAM S(sweep_path) path, float life)
{
    EXACT S(collide_state) ahead = path.now;
    EXACT float part = path.aim - path.now.since;
    if (path.curved) {
        ahead = integrate(SIM path.now, path.aim, life);
        ahead.position = float3_add_scaled(ahead.position, path.push, part);
        return ahead;
    }
    EXACT float time_s = part * STEP(derived.dt_s);
    ahead.position = float3_add_scaled(path.now.position, path.now.velocity, time_s);
    ahead.since = path.aim;
    return ahead;
}

/* The change of the velocity that the forces make along the piece. */
FN float3 sweep_change(S(sweep_path) path)
{
    EXACT float3 change = float3_sub(path.ahead.velocity, path.now.velocity);
    return change;
}

/* The state at which the piece meets something, after this part of it. */
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

/* Is a blow less than what the forces give in the piece? So it is to what lies on a surface. */
FN bool sweep_is_gentle(S(sweep_path) path, float3 blow)
{
    EXACT float3 change = sweep_change(path);
    EXACT float given = float3_dot(change, change);
    EXACT float taken = float3_dot(blow, blow);
    return taken <= given;
}

/* Is the time of a meeting to be found more closely? Not where the bend of the curve makes no
 * difference. */
FN bool sweep_is_rough(SIM_PARAM S(sweep_path) path, float part)
{
    EXACT float3 change = sweep_change(path);
    EXACT float time_s = (path.ahead.since - path.now.since) * STEP(derived.dt_s);
    EXACT float given = float3_length(change);
    EXACT float bend = 0.5f * given * time_s * part * (1.0f - part);
    return path.guesses < SWEEP_GUESSES && bend > SWEEP_CLOSE;
}

/* What leaves a surface has been put a little in front of it. It climbs there under the forces that
 * it has on the way, or each bounce would give it the energy of that height. What leaves slowly is
 * left as it is: it would take long. */
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

/* Past a piece that meets nothing. */
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

/* From an impact, to the end if nothing else is met. */
FN S(sweep_path) sweep_off(S(sweep_path) before, S(collide_hit) hit, S(collide_state) left)
{
    EXACT S(sweep_path) path = before;
    path.now = left;
    path.hit = hit;
    path.later = path.until;
    path.aim = path.until;
    path.push = FLOAT3(0.0f, 0.0f, 0.0f);
    path.bounces++;
    path.guesses = 0u;
    return path;
}

/* The first impact of a step, from the state behind it. */
FN S(collide_touch) sweep_touch(SIM_PARAM S(collide_state) s, S(collide_hit) hit, float radius)
{
    uint kind = AROUND(colliders[hit.box].kind);
    EXACT S(collide_touch) touch =
        collide_touched(s, collide_face_met(SIM hit.box, radius, s, hit.face));
    touch.reach = COLLIDE_MEETS_CENTRES(kind) ? 0.0f : radius;
    return touch;
}

/* The rest of a step after the last impact that it may have: carried by what was met last. */
FN S(collide_state) sweep_stay(SIM_PARAM S(sweep_path) path, float radius)
{
    EXACT S(collide_state) now = path.now;
    uint last = path.hit.box;
#if COLLIDE_HAS_VOLUMES
    if (AROUND(colliders[last].kind) == COLLIDER_VOLUME)
        now.position =
            volume_carry(SIM AROUND(colliders[last]), path.hit.face, path.until, now.position);
#endif
    if (COLLIDE_IS_TURNED(AROUND(colliders[last])))
        now.position = collide_turned_carry(SIM last, now.since, path.until, now.position);
    now.position = collide_rise(SIM now.position, path.until, radius);
    return now;
}

/* sweep, by the kind of way. */
FN S(collide_way) sweep_along(SIM_PARAM S(collide_state) start, S(collide_state) end, float3 push,
                              float life, S(collide_answer) answer, bool curved)
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
            draw.purpose = collide_purpose(SIM path.bounces);
            EXACT S(collide_state) left = collide_impact(SIM at, hit.box, hit.face, draw);
            EXACT float3 blow = float3_sub(left.velocity, at.velocity);
            if (path.curved && path.guesses == 0u && sweep_is_gentle(path, blow)) {
                path.curved = false;
                path.now.velocity = path.ahead.velocity;
                continue; /* along the same piece */
            }
            if (path.curved && sweep_is_rough(SIM path, hit.part)) {
                path.later = path.ahead.since;
                path.aim = at.since;
                path.guesses++;
            } else {
                if (path.bounces == 0u)
                    way.first = sweep_touch(SIM left, hit, answer.radius);
                if (path.curved)
                    left = sweep_climb(SIM left, path, at.position, blow);
                path = sweep_off(path, hit, left);
            }
        }
        path.ahead = sweep_ahead(SIM path, life);
    }
    way.end = sweep_stay(SIM path, answer.radius);
    return way;
}

/* From `start` to the time of `end`, which is where it would be without colliders; with `push`, m,
 * from the others of its system in that. The result is outside of every collider. */
FN S(collide_way) sweep(SIM_PARAM S(collide_state) start, S(collide_state) end, float3 push,
                        float life, S(collide_answer) answer)
{
    EXACT S(collide_way) way;
#ifndef GL_core_profile /* where compilers make two loops of it */
    if (!SWEEP_IS_CURVED) {
        way = sweep_along(SIM start, end, push, life, answer, false);
        return way;
    }
#endif
    way = sweep_along(SIM start, end, push, life, answer, SWEEP_IS_CURVED);
    return way;
}

#endif
