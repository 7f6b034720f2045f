/* Computes collisions with all kinds of colliders: with axis-aligned boxes and the floor (Heinz
 * 2019, 3.5), where the floor is a box that is infinite except at its top; with round shapes
 * (shared/collide_round.h); with shapes that may turn (shared/collide_oriented.h); and with
 * surfaces from grids (shared/collide_field.h).
 *
 * In the swept mode (shared/sweep.h), a piece of a path is a segment. Each of a box's six faces
 * moves evenly in that time, so its distance from the particle changes evenly along the segment.
 * The particle is inside while all six distances are positive. The earliest entry is the impact.
 * The particle is set there, its velocity relative to the box is answered as in the thesis, and its
 * way continues from there. So no particle is fast enough to tunnel. */
#ifndef KILN_SHARED_COLLIDE_H
#define KILN_SHARED_COLLIDE_H

#include "shared/collide_answer.h"
#include "shared/uses.h"

/* Kinds of shapes in frames of their own, as a mask. */
#define COLLIDE_KINDS_ORIENTED ((1u << COLLIDER_TERRAIN) - (1u << COLLIDER_ORIENTED_BOX))

#define COLLIDE_IS_ROUND(collider)                                                                 \
    ((USES(USES_COLLIDERS, COLLIDER_SPHERE) || USES(USES_COLLIDERS, COLLIDER_CYLINDER)) &&         \
     (collider).kind != COLLIDER_BOX)
#define COLLIDE_IS_ORIENTED(collider)                                                              \
    (USES_ANY(USES_COLLIDERS, COLLIDE_KINDS_ORIENTED) &&                                           \
     (collider).kind >= COLLIDER_ORIENTED_BOX && (collider).kind < COLLIDER_TERRAIN)

/* Shaders of scenes without colliders from grids are compiled without their code. This kind is
 * tested first. */
#if defined(GL_core_profile) && !defined(COLLIDE_FIELD) && !defined(COLLIDE_VOLUME)
#define COLLIDE_HAS_FIELDS         0
#define COLLIDE_HAS_VOLUMES        0
#define COLLIDE_IS_FIELD(collider) false
#else
#define COLLIDE_HAS_FIELDS         1
#define COLLIDE_IS_FIELD(collider) ((collider).kind >= COLLIDER_TERRAIN)
#include "shared/collide_field.h"
#endif

/* Kinds of colliders that a ball meets with its centre. */
#define COLLIDE_MEETS_CENTRES(kind) ((kind) == COLLIDER_VOLUME || (kind) == COLLIDER_DEPTH)

/* Impacts in one step. After the last, a particle rests for the remainder of the step: on a
 * collider that may turn, which could otherwise pass over it, or else in space. */
#define COLLIDE_BOUNCES 4u

/* Returns the velocity of a face of a box, m/s. */
FN float3 collide_box_velocity(S(kiln_collider) c, uint face, float steps_per_s)
{
    EXACT float3 low = FLOAT3(c.min_end.x - c.min.x, c.min_end.y - c.min.y, c.min_end.z - c.min.z);
    EXACT float3 high = FLOAT3(c.max_end.x - c.max.x, c.max_end.y - c.max.y, c.max_end.z - c.max.z);
    EXACT float3 both = float3_add(low, high);
    EXACT float3 motion = float3_scale(both, 0.5f);
    uint axis = face >> 1u;
    EXACT float of_face = collide_component((face & 1u) != 0u ? high : low, axis);
    motion = collide_with_component(motion, axis, of_face);
    EXACT float3 y = float3_scale(motion, steps_per_s);
    return y;
}

/* A surface at an impact, for any kind of collider. */
struct collide_blow {
    float3 position; /* just outside of the surface */
    float3 normal;
    float3 facet;    /* normal of the lattice of a grid, which is not interpolated; else `normal` */
    float3 ground;   /* velocity of the surface, m/s */
    float3 turning;  /* rad/s */
    float outwards;  /* component along the normal of the velocity relative to the surface, m/s */
    float3 relative; /* that velocity */
    float3 mirrored; /* that velocity after a mirror */
};

/* Completes a blow by the velocity before it, for a surface of any direction. */
FN S(collide_blow) collide_blow_off(S(collide_blow) blow, float3 velocity)
{
    EXACT S(collide_blow) y = blow;
    y.relative = float3_sub(velocity, blow.ground);
    y.outwards = float3_dot(y.relative, blow.normal);
    EXACT float twice = -2.0f * y.outwards;
    y.mirrored = float3_add_scaled(y.relative, blow.normal, twice);
    return y;
}

FN S(collide_blow) collide_box_blow(SIM_PARAM S(collide_state) s, S(kiln_collider) c, uint face)
{
    EXACT S(collide_blow) blow;
    EXACT S(collide_box) box = collide_box_at(c, s.since);
    uint axis = face >> 1u;
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    blow.position = collide_put_beside(box, face, s.position);
    blow.normal = collide_normal_of(face);
    blow.facet = blow.normal;
    blow.ground = collide_box_velocity(c, face, AROUND(steps_per_s));
    blow.turning = collide_not_turning();
    blow.relative = float3_sub(s.velocity, blow.ground);
    EXACT float across = collide_component(blow.relative, axis);
    blow.outwards = across * out_sign;
    blow.mirrored = collide_with_component(blow.relative, axis, -across);
    return blow;
}

FN S(collide_blow) collide_round_blow(SIM_PARAM S(collide_state) s, S(kiln_collider) c, uint face)
{
    EXACT S(collide_blow) blow;
    EXACT S(collide_round) shape = collide_round_at(c, s.since);
    EXACT float gap = collide_round_gap(shape);
    blow.normal = collide_round_normal(c.kind, shape, face, s.position);
    blow.facet = blow.normal;
    blow.position = collide_round_put(c.kind, shape, face, s.position, gap);
    blow.ground = collide_round_velocity(c, face, blow.normal, AROUND(steps_per_s));
    blow.turning = collide_not_turning();
    blow = collide_blow_off(blow, s.velocity);
    return blow;
}

FN S(collide_blow) collide_oriented_blow(SIM_PARAM S(collide_state) s, uint number, uint face,
                                         float radius)
{
    EXACT S(collide_blow) blow;
    EXACT S(collide_contact) contact = collide_oriented_contact(
        SIM number, radius, s.since, face, s.position, AROUND(steps_per_s), 1.0f);
    EXACT float4 around = AROUND(colliders[number].spin);
    EXACT float rate = around.w * AROUND(steps_per_s);
    EXACT float3 axis = FLOAT3(around.x, around.y, around.z);
    blow.position = contact.position;
    blow.normal = contact.normal;
    blow.facet = contact.normal;
    blow.ground = contact.velocity;
    blow.turning = float3_scale(axis, rate);
    blow = collide_blow_off(blow, s.velocity);
    return blow;
}

#if COLLIDE_HAS_FIELDS

FN S(collide_blow) collide_field_blow(SIM_PARAM S(collide_state) s, S(kiln_collider) c, uint face)
{
    EXACT S(collide_blow) blow;
    EXACT S(collide_ground) ground = collide_field_ground(SIM c, face, s.since, s.position);
    blow.position = ground.position;
    blow.normal = ground.normal;
    blow.facet = ground.facet;
    blow.ground = ground.velocity;
    blow.turning = collide_not_turning();
    blow = collide_blow_off(blow, s.velocity);
    return blow;
}

/* Does collide_clamp for colliders from grids. */
FN S(collide_state) collide_field_clamp(SIM_PARAM S(collide_state) s, S(kiln_collider) c,
                                        S(collide_answer) answer)
{
    EXACT S(collide_state) after = s;
    EXACT S(collide_ground) ground =
        collide_field_ground(SIM c, COLLIDE_SURFACE, s.since, s.position);
    after.position = ground.position;
    EXACT float3 bounced = collide_bounce_off(answer, s.velocity, ground.normal, true);
    after = collide_stay(answer, after, bounced, ground.normal);
    return after;
}

#endif

/* Returns the surface at an impact on a face of a collider. */
FN S(collide_blow) collide_blow_at(SIM_PARAM S(collide_state) s, S(kiln_collider) c, uint number,
                                   uint face, float radius)
{
    EXACT S(collide_blow) blow;
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c)) {
        blow = collide_field_blow(SIM s, c, face);
        return blow;
    }
#endif
    if (COLLIDE_IS_ORIENTED(c))
        blow = collide_oriented_blow(SIM s, number, face, radius);
    else if (COLLIDE_IS_ROUND(c))
        blow = collide_round_blow(SIM s, c, face);
    else
        blow = collide_box_blow(SIM s, c, face);
    return blow;
}

/* Returns the state after an impact on a face of a collider. All kinds of colliders share one
 * answer, since compilers of GLSL insert each call. */
FN S(collide_state) collide_impact(SIM_PARAM S(collide_state) s, uint number, uint face,
                                   S(collide_answer) of_all)
{
    EXACT S(collide_state) after = s;
    EXACT S(kiln_collider) c = collide_around(SIM number, of_all.radius);
    EXACT S(collide_answer) answer = collide_answer_of(of_all, c);
    EXACT S(collide_blow) blow = collide_blow_at(SIM s, c, number, face, of_all.radius);
    after.position = blow.position;
    EXACT float3 bounced = blow.relative;
    if (blow.outwards < 0.0f)
        bounced = collide_scatter(answer, blow.relative, blow.mirrored, blow.normal, blow.outwards,
                                  false);
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c))
        bounced = collide_clear_of(bounced, blow.facet);
#endif
    after = collide_leave(answer, after, blow.relative, bounced, blow.normal, blow.ground,
                          blow.turning);
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c) && COLLIDE_SPINS(answer)) {
        /* the velocity changes along the interpolated surface */
        EXACT float3 left = float3_sub(after.velocity, blow.ground);
        EXACT float3 clear = collide_clear_of(left, blow.facet);
        after.velocity = float3_add(blow.ground, clear);
    }
#endif
    return after;
}

/* The first impact of a step, for traces. */
struct collide_touch {
    float3 position; /* just outside of the face */
    float3 velocity; /* after the impact */
    float since;     /* part of the step before the impact */
    float reach;     /* m: distance from the surface to the position */
    uint face;       /* face, for collide_normal_of */
    uint number;     /* of the collider */
    bool happened;
};

/* The end of a particle's way through a step, and its first impact. */
struct collide_way {
    S(collide_state) end;
    S(collide_touch) first;
};

FN S(collide_touch) collide_no_touch(void)
{
    EXACT S(collide_touch) touch;
    touch.position = FLOAT3(0.0f, 0.0f, 0.0f);
    touch.velocity = FLOAT3(0.0f, 0.0f, 0.0f);
    touch.since = 0.0f;
    touch.reach = 0.0f;
    touch.face = 0u;
    touch.number = 0u;
    touch.happened = false;
    return touch;
}

FN S(collide_touch) collide_touched(S(collide_state) s, uint number, uint face)
{
    EXACT S(collide_touch) touch;
    touch.position = s.position;
    touch.velocity = s.velocity;
    touch.since = s.since;
    touch.reach = 0.0f;
    touch.face = face;
    touch.number = number;
    touch.happened = true;
    return touch;
}

struct collide_hit {
    float part; /* part of the segment before the impact; below 0: no impact */
    uint box;
    uint face;
};

/* Intersects a segment with a box or a round shape, between two parts of the step. */
FN_CLOSE S(collide_span) collide_solid_through(S(kiln_collider) c, float since, float until,
                                               float3 from, float3 end)
{
    EXACT S(collide_span) span;
    if (COLLIDE_IS_ROUND(c)) {
        EXACT S(collide_round) round_at_start = collide_round_at(c, since);
        EXACT S(collide_round) round_at_end = collide_round_at(c, until);
        span = collide_round_segment(c.kind, round_at_start, round_at_end, from, end);
    } else {
        EXACT S(collide_box) at_start = collide_box_at(c, since);
        EXACT S(collide_box) at_end = collide_box_at(c, until);
        span = collide_segment(at_start, at_end, from, end);
    }
    return span;
}

/* Intersects a segment with a collider of any kind. */
FN S(collide_span) collide_through(SIM_PARAM uint number, float radius, float since, float until,
                                   float3 from, float3 end)
{
    EXACT S(collide_span) span;
#ifndef GL_core_profile
    /* the collider is not copied */
    if (radius == 0.0f && AROUND(colliders[number].kind) <= COLLIDER_CYLINDER) {
        span = collide_solid_through(AROUND(colliders[number]), since, until, from, end);
        return span;
    }
#endif
    EXACT S(kiln_collider) c = collide_around(SIM number, radius);
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c)) {
        span = collide_field_segment(SIM c, since, until, from, end);
        return span;
    }
#endif
    if (COLLIDE_IS_ORIENTED(c))
        span = collide_oriented_through(SIM number, radius, since, until, from, end);
    else
        span = collide_solid_through(c, since, until, from, end);
    return span;
}

/* Returns the face that a point inside is nearest to after the part `since` of the step. */
FN uint collide_nearest(SIM_PARAM uint number, float radius, float since, float3 p)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, radius);
    uint face;
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c))
        return COLLIDE_SURFACE;
#endif
    if (COLLIDE_IS_ORIENTED(c)) {
        face = collide_oriented_nearest(SIM number, radius, since, p);
    } else if (COLLIDE_IS_ROUND(c)) {
        EXACT S(collide_round) shape = collide_round_at(c, since);
        face = collide_round_nearest(c.kind, shape, p);
    } else {
        EXACT S(collide_box) box = collide_box_at(c, since);
        face = collide_nearest_face(box, p);
    }
    return face;
}

/* Returns whether a point is inside after the part `until` of the step. */
FN bool collide_is_inside(SIM_PARAM uint number, float radius, float until, float3 p)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, radius);
    bool inside;
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c)) {
        inside = collide_field_inside(SIM c, until, p);
        return inside;
    }
#endif
    if (COLLIDE_IS_ORIENTED(c)) {
        inside = collide_oriented_inside(SIM number, radius, until, p);
    } else if (COLLIDE_IS_ROUND(c)) {
        EXACT S(collide_round) shape = collide_round_at(c, until);
        inside = collide_round_inside(c.kind, shape, p);
    } else {
        EXACT S(collide_box) box = collide_box_at(c, until);
        inside = collide_inside(box, p);
    }
    return inside;
}

/* Returns the face of an impact, from which collide_normal_of computes the normal later. */
FN uint collide_face_met(SIM_PARAM uint number, float radius, S(collide_state) s, uint face)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, radius);
    uint met = face;
#if COLLIDE_HAS_FIELDS
    if (COLLIDE_IS_FIELD(c)) {
        EXACT S(collide_ground) ground = collide_field_ground(SIM c, face, s.since, s.position);
        return collide_pack_normal(ground.normal);
    }
#endif
    if (COLLIDE_IS_ORIENTED(c)) {
        EXACT S(collide_contact) contact =
            collide_oriented_contact(SIM number, radius, s.since, face, s.position, 1.0f, 1.0f);
        met = collide_pack_normal(contact.normal);
    } else if (COLLIDE_IS_ROUND(c)) {
        EXACT S(collide_round) shape = collide_round_at(c, s.since);
        EXACT float3 normal = collide_round_normal(c.kind, shape, face, s.position);
        met = collide_pack_normal(normal);
    }
    return met;
}

/* Finds the first impact on the way from s to `end`, which is reached after the part `until` of the
 * step. If a particle starts inside a box because it was born there, the impact is at once, on the
 * nearest face. */
FN S(collide_hit) collide_first(SIM_PARAM S(collide_state) s, float3 end, float until, float radius)
{
    EXACT S(collide_hit) hit;
    hit.part = -1.0f;
    hit.box = 0u;
    hit.face = 0u;
#ifndef GL_core_profile
    const bool whole = s.since == 0.0f && until == 1.0f;
#endif
    for (uint i = 0u; i < AROUND(collider_count); i++) {
#ifndef GL_core_profile
        if ((whole ? AROUND(colliders[i].kind) != COLLIDER_PLANE
                   : collide_stands(&AROUND(colliders[i]))) &&
            !collide_may_meet(&AROUND(colliders[i]), radius, s.position, end))
            continue;
#endif
        EXACT S(collide_span) span =
            collide_through(SIM i, radius, s.since, until, s.position, end);
        bool inside = !span.misses && !span.outside;
        bool enters = !span.misses && span.outside && span.enter < span.leave;
        if ((inside || enters) && (hit.part < 0.0f || span.enter < hit.part)) {
            hit.part = span.enter;
            hit.box = i;
            hit.face = inside ? collide_nearest(SIM i, radius, s.since, s.position) : span.face;
        }
    }
    return hit;
}

/* Moves a particle up until it is in no box. It is the last resort, when the impacts of a step are
 * used up between boxes that close in. Each pass leaves at least one box below. A collider that may
 * turn is left through its surface. */
FN float3 collide_rise(SIM_PARAM float3 position, float until, float radius)
{
    EXACT float3 p = position;
    for (uint pass = 0u; pass < AROUND(collider_count); pass++) {
        bool free = true;
        for (uint i = 0u; i < AROUND(collider_count); i++) {
            if (collide_is_inside(SIM i, radius, until, p)) {
                EXACT S(kiln_collider) c = collide_around(SIM i, radius);
                EXACT S(collide_box) box = collide_box_at(c, until);
#if COLLIDE_HAS_FIELDS
                box = collide_field_below(SIM c, box, p);
#endif
                if (COLLIDE_IS_ORIENTED(AROUND(colliders[i])) &&
                    (pass < 2u || AROUND(colliders[i].kind) == COLLIDER_PLANE))
                    p = collide_oriented_rise(SIM i, radius, until, p);
                else
                    p = collide_put_beside(box, 3u, p);
                free = false;
            }
        }
        if (free)
            return p;
    }
    return p;
}

/* Returns the purpose of the random numbers of an impact; there are at most 8 impacts in a step. */
FN uint collide_purpose(SIM_PARAM uint bounce)
{
    return RANDOM_BOUNCE + (STEP(step) << 4u) + (bounce << 1u);
}

/* Returns the state from which the face at a particle is found after the particle was put in front
 * of a surface. The cells of a volume know the plane at the earlier place; all other colliders use
 * the present place. */
FN S(collide_state) collide_seen_from(S(kiln_collider) c, S(collide_state) before,
                                      S(collide_state) now)
{
    if (c.kind == COLLIDER_VOLUME)
        return before;
    return now;
}

/* Puts a point onto the face of a box. */
FN S(collide_state) collide_box_clamp(S(collide_box) box, S(collide_state) s, uint face,
                                      S(collide_answer) answer)
{
    EXACT S(collide_state) now = s;
    uint axis = face >> 1u;
    EXACT float at =
        (face & 1u) != 0u ? collide_component(box.max, axis) : collide_component(box.min, axis);
    now.position = collide_with_component(now.position, axis, at);
    EXACT float3 bounced = collide_bounce(answer, now.velocity, face, true);
    EXACT float3 normal = collide_normal_of(face);
    now = collide_stay(answer, now, bounced, normal);
    return now;
}

/* Collides as the thesis does: a particle that ends inside a box is put onto the nearest face. Fast
 * particles tunnel. */
FN S(collide_way) collide_clamp(SIM_PARAM S(collide_state) s, float3 end, float until,
                                S(collide_answer) answer)
{
    EXACT S(collide_way) way;
    way.first = collide_no_touch();
    EXACT S(collide_state) now = s;
    now.position = end;
    now.since = until;
    EXACT S(collide_answer) draw = answer;
    uint impacts = 0u;
    for (uint i = 0u; i < AROUND(collider_count); i++) {
        EXACT S(kiln_collider) c = collide_around(SIM i, answer.radius);
        EXACT S(collide_box) box = collide_box_at(c, until);
        bool inside = collide_is_inside(SIM i, answer.radius, until, now.position);
        draw = collide_answer_of(answer, c);
        if (inside && COLLIDE_IS_FIELD(c)) {
#if COLLIDE_HAS_FIELDS
            draw.purpose = collide_purpose(SIM impacts & 7u);
            impacts++;
            EXACT S(collide_state) before = now;
            now = collide_field_clamp(SIM now, c, draw);
            if (impacts == 1u)
                way.first = collide_touched(now, i,
                                            collide_face_met(SIM i, answer.radius,
                                                             collide_seen_from(c, before, now),
                                                             COLLIDE_SURFACE));
#endif
        } else if (inside && COLLIDE_IS_ORIENTED(c)) {
            uint nearest = collide_oriented_nearest(SIM i, answer.radius, until, now.position);
            EXACT S(collide_contact) contact = collide_oriented_contact(
                SIM i, answer.radius, until, nearest, now.position, 1.0f, 0.0f);
            now.position = contact.position;
            draw.purpose = collide_purpose(SIM impacts & 7u);
            impacts++;
            EXACT float3 bounced = collide_bounce_off(draw, now.velocity, contact.normal, true);
            now = collide_stay(draw, now, bounced, contact.normal);
            if (impacts == 1u)
                way.first = collide_touched(now, i, collide_pack_normal(contact.normal));
        } else if (inside && COLLIDE_IS_ROUND(c)) {
            EXACT S(collide_round) shape = collide_round_at(c, until);
            uint side = collide_round_nearest(c.kind, shape, now.position);
            EXACT float3 normal = collide_round_normal(c.kind, shape, side, now.position);
            now.position = collide_round_put(c.kind, shape, side, now.position, 0.0f);
            draw.purpose = collide_purpose(SIM impacts & 7u);
            impacts++;
            EXACT float3 bounced = collide_bounce_off(draw, now.velocity, normal, true);
            now = collide_stay(draw, now, bounced, normal);
            if (impacts == 1u)
                way.first = collide_touched(now, i, collide_pack_normal(normal));
        } else if (inside) {
            uint face = collide_nearest_face(box, now.position);
            draw.purpose = collide_purpose(SIM impacts & 7u);
            impacts++;
            now = collide_box_clamp(box, now, face, draw);
            if (impacts == 1u)
                way.first = collide_touched(now, i, face);
        }
    }
    way.end = now;
    return way;
}

#endif
