/* Collision with axis-aligned boxes and the floor (Heinz 2019, 3.5), which is one more box, high at
 * its top and without end in all other directions.
 *
 * Swept: the path of the step is a segment, and each of a box's six faces moves evenly during the
 * step, so the distance to it changes evenly along the path; the particle is inside while all six
 * distances are positive. The earliest entry is the impact: the position is set there, the velocity
 * relative to the box answers as in the thesis, and the rest of the step goes on from there.
 * Nothing can be fast enough to tunnel.
 */
#ifndef KILN_SHARED_COLLIDE_H
#define KILN_SHARED_COLLIDE_H

#include "shared/layout.h"
#include "shared/random.h"

/* Impacts in one step; after the last, a particle rests for the remainder of the step. */
#define COLLIDE_BOUNCES 4u

/* Faces: 0 and 1 of x, the lower and the upper, 2 and 3 of y, 4 and 5 of z. */
#define COLLIDE_FACES 6u

FN float collide_component(float3 v, uint axis)
{
    EXACT float y = axis == 0u ? v.x : axis == 1u ? v.y : v.z;
    return y;
}

FN float3 collide_with_component(float3 v, uint axis, float value)
{
    EXACT float3 y =
        FLOAT3(axis == 0u ? value : v.x, axis == 1u ? value : v.y, axis == 2u ? value : v.z);
    return y;
}

/* Between a at the start and b at the end of the step; exactly b at the end. */
FN float collide_moving(float a, float b, float since)
{
    EXACT float y = a + (b - a) * since;
    EXACT float moved = since >= 1.0f ? b : y;
    return moved;
}

struct collide_box {
    float3 min, max;
};

/* The box when the part `since` of the step has passed. */
FN S(collide_box) collide_box_at(S(kiln_collider) c, float since)
{
    EXACT S(collide_box) box;
    box.min = FLOAT3(collide_moving(c.min.x, c.min_end.x, since),
                     collide_moving(c.min.y, c.min_end.y, since),
                     collide_moving(c.min.z, c.min_end.z, since));
    box.max = FLOAT3(collide_moving(c.max.x, c.max_end.x, since),
                     collide_moving(c.max.y, c.max_end.y, since),
                     collide_moving(c.max.z, c.max_end.z, since));
    return box;
}

FN bool collide_inside(S(collide_box) box, float3 p)
{
    return p.x > box.min.x && p.x < box.max.x && p.y > box.min.y && p.y < box.max.y &&
           p.z > box.min.z && p.z < box.max.z;
}

/* What is known of a segment and a box after some of the faces. */
struct collide_span {
    float enter; /* parts of the segment */
    float leave;
    uint face;    /* of the entry */
    bool misses;  /* outside of one face all the way */
    bool outside; /* starts outside of some face */
};

/* One face more: d0 and d1 are the distances to it, positive inside, at the segment's ends. */
FN S(collide_span) collide_face(S(collide_span) before, uint face, float d0, float d1)
{
    EXACT S(collide_span) span = before;
    bool in0 = d0 > 0.0f;
    bool in1 = d1 > 0.0f;
    span.misses = span.misses || (!in0 && !in1);
    span.outside = span.outside || !in0;
    if (in0 != in1) {
        EXACT float change = d0 - d1;
        EXACT float quotient = exact_div(d0, change);
        EXACT float part = exact_min(quotient, 1.0f);
        if (in1 && part >= span.enter) {
            span.enter = part;
            span.face = face;
        }
        if (in0)
            span.leave = exact_min(span.leave, part);
    }
    return span;
}

/* The segment from a (when the box is at `start`) to b (when it is at `end`). */
FN S(collide_span) collide_segment(S(collide_box) start, S(collide_box) end, float3 a, float3 b)
{
    EXACT S(collide_span) span;
    span.enter = 0.0f;
    span.leave = 2.0f;
    span.face = 0u;
    span.misses = false;
    span.outside = false;
    span = collide_face(span, 0u, a.x - start.min.x, b.x - end.min.x);
    span = collide_face(span, 1u, start.max.x - a.x, end.max.x - b.x);
    if (span.misses)
        return span;
    span = collide_face(span, 2u, a.y - start.min.y, b.y - end.min.y);
    span = collide_face(span, 3u, start.max.y - a.y, end.max.y - b.y);
    if (span.misses)
        return span;
    span = collide_face(span, 4u, a.z - start.min.z, b.z - end.min.z);
    span = collide_face(span, 5u, start.max.z - a.z, end.max.z - b.z);
    return span;
}

/* The face that a point inside is nearest to. */
FN uint collide_nearest_face(S(collide_box) box, float3 p)
{
    uint face = 0u;
    EXACT float least = p.x - box.min.x;
    EXACT float d = box.max.x - p.x;
    face = d < least ? 1u : face;
    least = exact_min(d, least);
    d = p.y - box.min.y;
    face = d < least ? 2u : face;
    least = exact_min(d, least);
    d = box.max.y - p.y;
    face = d < least ? 3u : face;
    least = exact_min(d, least);
    d = p.z - box.min.z;
    face = d < least ? 4u : face;
    least = exact_min(d, least);
    d = box.max.z - p.z;
    face = d < least ? 5u : face;
    return face;
}

/* The coordinate just outside of a face: 0.06 mm, or the two units in the last place that make a
 * difference far from the origin. */
FN float collide_beside(float at, bool upper)
{
    EXACT float gap = 6.103515625e-5f + exact_abs(at) * 2.384185791015625e-7f;
    EXACT float y = upper ? at + gap : at - gap;
    return y;
}

FN float3 collide_put_beside(S(collide_box) box, uint face, float3 p)
{
    uint axis = face >> 1u;
    bool upper = (face & 1u) != 0u;
    EXACT float at = upper ? collide_component(box.max, axis) : collide_component(box.min, axis);
    EXACT float beside = collide_beside(at, upper);
    EXACT float3 y = collide_with_component(p, axis, beside);
    return y;
}

/* Metres a second of a box; across a face, that of the face. */
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

/* How a particle answers an impact. */
struct collide_answer {
    float randomness; /* 0 mirror .. 1 any direction of the hemisphere */
    float slowdown;   /* factor on the speed */
    uint stream;      /* the particle's */
    uint purpose;     /* of two numbers for this impact */
};

/* The velocity (relative to the box) after an impact: a linear combination of the mirrored and a
 * random direction, with the slowed speed. The random direction is of the hemisphere about the
 * face's normal, so that it never points inwards; with `literal`, about the mirrored direction. */
FN float3 collide_bounce(S(collide_answer) answer, float3 velocity, uint face, bool literal)
{
    uint axis = face >> 1u;
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    EXACT float across = collide_component(velocity, axis);
    EXACT float outwards = across * out_sign;
    if (outwards >= 0.0f)
        return velocity;
    EXACT float3 mirrored = collide_with_component(velocity, axis, -across);
    EXACT float square = float3_dot(velocity, velocity);
    EXACT float speed = exact_sqrt(square);
    EXACT float3 zero = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float3 normal = collide_with_component(zero, axis, out_sign);
    EXACT float3 straight = float3_normalize(mirrored, normal);
    EXACT float3 pole = normal;
    if (literal)
        pole = straight;
    EXACT float3 astray = random_direction(answer.stream, answer.purpose, pole, 0.0f);
    EXACT float kept = 1.0f - answer.randomness;
    EXACT float3 part = float3_scale(straight, kept);
    EXACT float3 mixed = float3_add_scaled(part, astray, answer.randomness);
    EXACT float3 direction = float3_normalize(mixed, straight);
    EXACT float slowed = speed * answer.slowdown;
    EXACT float3 y = float3_scale(direction, slowed);
    return y;
}

struct collide_state {
    float3 position;
    float3 velocity;
    float since; /* part of the step that has passed */
};

/* The state after an impact on a face of a box. */
FN S(collide_state) collide_impact(SIM_PARAM S(collide_state) s, S(kiln_collider) c, uint face,
                                   S(collide_answer) answer)
{
    EXACT S(collide_state) after = s;
    EXACT S(collide_box) box = collide_box_at(c, s.since);
    after.position = collide_put_beside(box, face, s.position);
    EXACT float3 ground = collide_box_velocity(c, face, COLLIDERS(steps_per_s));
    EXACT float3 relative = float3_sub(s.velocity, ground);
    EXACT float3 bounced = collide_bounce(answer, relative, face, false);
    after.velocity = float3_add(ground, bounced);
    return after;
}

/* The first impact of a step, for whoever asks. */
struct collide_touch {
    float3 position; /* just outside of the face */
    float3 velocity; /* after the impact */
    float since;     /* part of the step that had passed */
    uint face;
    bool happened;
};

/* How a particle's way through a step ends, and how it began to bounce. */
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
    touch.face = 0u;
    touch.happened = false;
    return touch;
}

FN S(collide_touch) collide_touched(S(collide_state) s, uint face)
{
    EXACT S(collide_touch) touch;
    touch.position = s.position;
    touch.velocity = s.velocity;
    touch.since = s.since;
    touch.face = face;
    touch.happened = true;
    return touch;
}

struct collide_hit {
    float part; /* of the segment; below 0: no hit */
    uint box;
    uint face;
};

/* The first impact on the way from s to `end` when the part `until` of the step has passed. A start
 * inside a box (born there) is an impact at once on its nearest face. */
FN S(collide_hit) collide_first(SIM_PARAM S(collide_state) s, float3 end, float until)
{
    EXACT S(collide_hit) hit;
    hit.part = -1.0f;
    hit.box = 0u;
    hit.face = 0u;
    for (uint i = 0u; i < COLLIDERS(count); i++) {
        EXACT S(kiln_collider) c = COLLIDERS(boxes[i]);
        EXACT S(collide_box) at_start = collide_box_at(c, s.since);
        EXACT S(collide_box) at_end = collide_box_at(c, until);
        EXACT S(collide_span) span = collide_segment(at_start, at_end, s.position, end);
        bool inside = !span.misses && !span.outside;
        bool enters = !span.misses && span.outside && span.enter < span.leave;
        if ((inside || enters) && (hit.part < 0.0f || span.enter < hit.part)) {
            hit.part = span.enter;
            hit.box = i;
            hit.face = inside ? collide_nearest_face(at_start, s.position) : span.face;
        }
    }
    return hit;
}

/* The last resort, when the bounces of a step are used up between boxes that close in: up, until no
 * box is around. Each pass leaves at least one box below. */
FN float3 collide_rise(SIM_PARAM float3 position, float until)
{
    EXACT float3 p = position;
    for (uint pass = 0u; pass < COLLIDERS(count); pass++) {
        bool free = true;
        for (uint i = 0u; i < COLLIDERS(count); i++) {
            EXACT S(collide_box) box = collide_box_at(COLLIDERS(boxes[i]), until);
            if (collide_inside(box, p)) {
                p = collide_put_beside(box, 3u, p);
                free = false;
            }
        }
        if (free)
            return p;
    }
    return p;
}

/* Of the random numbers of an impact, of at most 8 in a step. */
FN uint collide_purpose(SIM_PARAM uint bounce)
{
    return RANDOM_BOUNCE + (STEP(step) << 4u) + (bounce << 1u);
}

/* From s, whose position is where the particle is and `end` where it would be when the part `until`
 * of the step (1: all of it) has passed; the result is at that time, outside of every box. */
FN S(collide_way)
    collide_swept(SIM_PARAM S(collide_state) s, float3 end, float until, S(collide_answer) answer)
{
    EXACT S(collide_way) way;
    way.first = collide_no_touch();
    EXACT S(collide_state) now = s;
    EXACT float3 target = end;
    EXACT float dt_s = STEP(derived.dt_s);
    EXACT S(collide_answer) draw = answer;
    for (uint bounce = 0u; bounce < COLLIDE_BOUNCES; bounce++) {
        EXACT S(collide_hit) hit = collide_first(SIM now, target, until);
        if (hit.part < 0.0f) {
            now.position = target;
            way.end = now;
            return way;
        }
        EXACT float3 ahead = float3_sub(target, now.position);
        now.position = float3_add_scaled(now.position, ahead, hit.part);
        EXACT float left = until - now.since;
        now.since = now.since + left * hit.part;
        draw.purpose = collide_purpose(SIM bounce);
        now = collide_impact(SIM now, COLLIDERS(boxes[hit.box]), hit.face, draw);
        if (bounce == 0u)
            way.first = collide_touched(now, hit.face);
        EXACT float rest_s = (until - now.since) * dt_s;
        target = float3_add_scaled(now.position, now.velocity, rest_s);
    }
    now.position = collide_rise(SIM now.position, until);
    way.end = now;
    return way;
}

/* The thesis's way: whoever ends inside a box is put on the nearest face. Fast particles tunnel. */
FN S(collide_way)
    collide_clamp(SIM_PARAM S(collide_state) s, float3 end, float until, S(collide_answer) answer)
{
    EXACT S(collide_way) way;
    way.first = collide_no_touch();
    EXACT S(collide_state) now = s;
    now.position = end;
    now.since = until;
    EXACT S(collide_answer) draw = answer;
    uint impacts = 0u;
    for (uint i = 0u; i < COLLIDERS(count); i++) {
        EXACT S(collide_box) box = collide_box_at(COLLIDERS(boxes[i]), until);
        if (collide_inside(box, now.position)) {
            uint face = collide_nearest_face(box, now.position);
            uint axis = face >> 1u;
            EXACT float at = (face & 1u) != 0u ? collide_component(box.max, axis)
                                               : collide_component(box.min, axis);
            now.position = collide_with_component(now.position, axis, at);
            draw.purpose = collide_purpose(SIM impacts & 7u);
            impacts++;
            now.velocity = collide_bounce(draw, now.velocity, face, true);
            if (impacts == 1u)
                way.first = collide_touched(now, face);
        }
    }
    way.end = now;
    return way;
}

#endif
