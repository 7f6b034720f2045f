/* Intersects segments with shapes that have a frame of their own, which may move and turn, for
 * shared/collide.h: boxes of any direction, cylinders whose axis turns, capsules along the frame's
 * y, and the half space below its y = 0.
 *
 * The frame is known at any time of the step. In it, the shape only grows, and a particle's path is
 * a segment between its places at two times. Where the frame turns, the true path between these is
 * curved, so the step is divided into pieces of at most 1/32 rad. The pieces are connected and
 * their ends are exact, so no particle slips through. */
#ifndef KILN_SHARED_COLLIDE_ORIENTED_H
#define KILN_SHARED_COLLIDE_ORIENTED_H

#include "shared/collide_around.h"
#include "shared/collide_round.h"

#define COLLIDE_PIECES_PER_RAD 32.0f
#define COLLIDE_MOST_PIECES    32.0f

struct collide_frame {
    float3 center;
    float4 pose;
    float3 extent;
    float radius;
};

/* Returns the pose after the part `since` of the step. */
FN float4 collide_pose_at(S(kiln_collider) c, float since)
{
    EXACT float4 p = c.pose;
    if (c.spin.w == 0.0f)
        return p;
    EXACT float angle = 0.5f * c.spin.w * since;
    EXACT S(exact_angle) turn = exact_sincos(angle);
    EXACT float w = turn.cosine;
    EXACT float x = c.spin.x * turn.sine;
    EXACT float y = c.spin.y * turn.sine;
    EXACT float z = c.spin.z * turn.sine;
    EXACT float4 rotated =
        FLOAT4(w * p.x + x * p.w + y * p.z - z * p.y, w * p.y + y * p.w + z * p.x - x * p.z,
               w * p.z + z * p.w + x * p.y - y * p.x, w * p.w - x * p.x - y * p.y - z * p.z);
    return rotated;
}

FN S(collide_frame) collide_frame_at(S(kiln_collider) c, float since)
{
    EXACT S(collide_frame) frame;
    frame.center = FLOAT3(collide_moving(c.center.x, c.center_end.x, since),
                          collide_moving(c.center.y, c.center_end.y, since),
                          collide_moving(c.center.z, c.center_end.z, since));
    frame.radius = collide_moving(c.center.w, c.center_end.w, since);
    frame.extent = FLOAT3(collide_moving(c.extent.x, c.extent_end.x, since),
                          collide_moving(c.extent.y, c.extent_end.y, since),
                          collide_moving(c.extent.z, c.extent_end.z, since));
    frame.pose = collide_pose_at(c, since);
    return frame;
}

FN float3 collide_to_frame(S(collide_frame) frame, float3 p)
{
    EXACT float3 from = float3_sub(p, frame.center);
    EXACT float4 back = FLOAT4(-frame.pose.x, -frame.pose.y, -frame.pose.z, frame.pose.w);
    EXACT float3 y = float3_turn(back, from);
    return y;
}

FN float3 collide_from_frame(S(collide_frame) frame, float3 q)
{
    EXACT float3 from = float3_turn(frame.pose, q);
    EXACT float3 y = float3_add(frame.center, from);
    return y;
}

/* ---- tests in the frame of a collider -------------------------------------------------------- */

FN S(collide_box) collide_frame_box(S(collide_frame) frame)
{
    EXACT S(collide_box) box;
    box.min = FLOAT3(-frame.extent.x, -frame.extent.y, -frame.extent.z);
    box.max = frame.extent;
    return box;
}

/* Returns the vector from the axis, or from a capsule's nearest centre. */
FN float3 collide_frame_across(uint kind, S(collide_frame) frame, float3 q)
{
    EXACT float low = -frame.extent.y;
    EXACT float foot = exact_clamp(q.y, low, frame.extent.y);
    EXACT float beyond = kind == COLLIDER_CAPSULE ? q.y - foot : 0.0f;
    EXACT float3 y = FLOAT3(q.x, beyond, q.z);
    return y;
}

FN bool collide_frame_inside(uint kind, S(collide_frame) frame, float3 q)
{
    if (kind == COLLIDER_PLANE)
        return q.y < frame.extent.y;
    if (kind == COLLIDER_ORIENTED_BOX) {
        EXACT S(collide_box) box = collide_frame_box(frame);
        bool within = collide_inside(box, q);
        return within;
    }
    EXACT float3 across = collide_frame_across(kind, frame, q);
    EXACT float excess = collide_round_excess(across, frame.radius);
    bool between = kind == COLLIDER_CAPSULE || (q.y < frame.extent.y && -q.y < frame.extent.y);
    return excess < 0.0f && between;
}

FN S(collide_span) collide_span_start(void)
{
    EXACT S(collide_span) span;
    span.enter = 0.0f;
    span.leave = 2.0f;
    span.face = COLLIDE_SIDE;
    span.misses = false;
    span.outside = false;
    return span;
}

FN bool collide_span_is_inside(S(collide_span) span)
{
    return !span.misses && !span.outside;
}

FN bool collide_span_meets(S(collide_span) span)
{
    return !span.misses && (!span.outside || span.enter < span.leave);
}

/* Unites the results of two shapes that are hit on the same face. Where they are left is not
 * computed. */
FN S(collide_span) collide_either(S(collide_span) one, S(collide_span) other)
{
    bool first = collide_span_meets(one);
    bool second = collide_span_meets(other);
    EXACT S(collide_span) span = one;
    if (second && (!first || other.enter < one.enter))
        span.enter = other.enter;
    span.misses = !first && !second;
    span.outside = !collide_span_is_inside(one) && !collide_span_is_inside(other);
    if (!span.outside)
        span.enter = 0.0f;
    span.leave = 2.0f;
    return span;
}

/* Intersects a segment with the ball at one of a capsule's ends. */
FN S(collide_span) collide_ball(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b,
                                float upwards)
{
    EXACT S(collide_span) span = collide_span_start();
    EXACT float3 from = FLOAT3(a.x, a.y - upwards * start.extent.y, a.z);
    EXACT float3 to = FLOAT3(b.x, b.y - upwards * end.extent.y, b.z);
    span = collide_side(span, from, to, start.radius, end.radius);
    return span;
}

FN S(collide_span) collide_barrel(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_span_start();
    EXACT float3 from = FLOAT3(a.x, 0.0f, a.z);
    EXACT float3 to = FLOAT3(b.x, 0.0f, b.z);
    EXACT float lower0 = start.extent.y + a.y;
    EXACT float lower1 = end.extent.y + b.y;
    EXACT float upper0 = start.extent.y - a.y;
    EXACT float upper1 = end.extent.y - b.y;
    span = collide_side(span, from, to, start.radius, end.radius);
    span = collide_face(span, COLLIDE_LOWER, lower0, lower1);
    span = collide_face(span, COLLIDE_UPPER, upper0, upper1);
    return span;
}

/* Intersects the segment from a, in the frame at one time, to b, in the frame at another. */
FN S(collide_span) collide_frame_segment(uint kind, S(collide_frame) start, S(collide_frame) end,
                                         float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_span_start();
    if (kind == COLLIDER_ORIENTED_BOX) {
        EXACT S(collide_box) before = collide_frame_box(start);
        EXACT S(collide_box) after = collide_frame_box(end);
        span = collide_segment(before, after, a, b);
    } else if (kind == COLLIDER_PLANE) {
        EXACT float depth0 = start.extent.y - a.y;
        EXACT float depth1 = end.extent.y - b.y;
        span = collide_face(span, COLLIDE_UPPER, depth0, depth1);
    } else {
        span = collide_barrel(start, end, a, b);
        if (kind == COLLIDER_CAPSULE) {
            EXACT S(collide_span) low = collide_ball(start, end, a, b, -1.0f);
            EXACT S(collide_span) high = collide_ball(start, end, a, b, 1.0f);
            EXACT S(collide_span) balls = collide_either(low, high);
            span = collide_either(span, balls);
            span.face = COLLIDE_SIDE;
        }
    }
    return span;
}

/* Returns the part of the surface that a point inside is nearest to. */
FN uint collide_frame_nearest(uint kind, S(collide_frame) frame, float3 q)
{
    uint face = COLLIDE_SIDE;
    if (kind == COLLIDER_PLANE) {
        face = COLLIDE_UPPER;
    } else if (kind == COLLIDER_ORIENTED_BOX) {
        EXACT S(collide_box) box = collide_frame_box(frame);
        face = collide_nearest_face(box, q);
    } else if (kind == COLLIDER_ORIENTED_CYLINDER) {
        EXACT float3 across = collide_frame_across(kind, frame, q);
        EXACT float aside = float3_length(across);
        EXACT float least = frame.radius - aside;
        EXACT float lower = frame.extent.y + q.y;
        EXACT float upper = frame.extent.y - q.y;
        face = lower < least ? COLLIDE_LOWER : face;
        least = exact_min(lower, least);
        face = upper < least ? COLLIDE_UPPER : face;
    }
    return face;
}

/* Returns the outward normal at a point near the surface. */
FN float3 collide_frame_normal(uint kind, S(collide_frame) frame, uint face, float3 q)
{
    EXACT float3 normal = FLOAT3(0.0f, 0.0f, 0.0f);
    if (face < COLLIDE_FACES) {
        EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
        normal = collide_with_component(normal, face >> 1u, out_sign);
    } else if (face == COLLIDE_SIDE) {
        EXACT float3 across = collide_frame_across(kind, frame, q);
        EXACT float3 otherwise = FLOAT3(1.0f, 0.0f, 0.0f);
        normal = float3_normalize(across, otherwise);
    } else {
        normal.y = face == COLLIDE_UPPER ? 1.0f : -1.0f;
    }
    return normal;
}

/* Returns the point of the surface nearest to q, moved outwards by `gap`. */
FN float3 collide_frame_put(uint kind, S(collide_frame) frame, uint face, float3 q, float gap)
{
    EXACT float3 y = q;
    if (face < COLLIDE_FACES) {
        uint axis = face >> 1u;
        EXACT float far = collide_component(frame.extent, axis) + gap;
        EXACT float at = (face & 1u) != 0u ? far : -far;
        y = collide_with_component(q, axis, at);
    } else if (face == COLLIDE_SIDE) {
        EXACT float3 across = collide_frame_across(kind, frame, q);
        EXACT float3 normal = collide_frame_normal(kind, frame, face, q);
        EXACT float3 foot = FLOAT3(0.0f, q.y - across.y, 0.0f);
        EXACT float far = frame.radius + gap;
        y = float3_add_scaled(foot, normal, far);
    } else {
        EXACT float far = frame.extent.y + gap;
        y.y = face == COLLIDE_UPPER ? far : -far;
    }
    return y;
}

/* ---- tests in the world: colliders are given by number, and enlarged by a radius, m ---------- */

/* Returns whether the way between two parts of the step may touch the collider. It does not if both
 * ends are outside of one face of its bounds. This spares most particles the exact test. */
FN bool collide_is_near(S(kiln_collider) c, float since, float until, float3 a, float3 b)
{
    EXACT S(collide_box) start = collide_box_at(c, since);
    EXACT S(collide_box) end = collide_box_at(c, until);
    bool near_x =
        (a.x >= start.min.x || b.x >= end.min.x) && (a.x <= start.max.x || b.x <= end.max.x);
    bool near_y =
        (a.y >= start.min.y || b.y >= end.min.y) && (a.y <= start.max.y || b.y <= end.max.y);
    bool near_z =
        (a.z >= start.min.z || b.z >= end.min.z) && (a.z <= start.max.z || b.z <= end.max.z);
    return near_x && near_y && near_z;
}

/* Intersects a segment with the collider, as collide_through does. */
FN_APART S(collide_span) collide_oriented_through(SIM_PARAM uint number, float larger, float since,
                                                  float until, float3 from, float3 end)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, larger);
    EXACT S(collide_span) span = collide_span_start();
    span.misses = true;
    if (!collide_is_near(c, since, until, from, end))
        return span;
    EXACT float left = until - since;
    EXACT float angle = exact_abs(c.spin.w) * left;
    EXACT float wanted = angle * COLLIDE_PIECES_PER_RAD + 1.0f;
    EXACT float count = exact_clamp(wanted, 1.0f, COLLIDE_MOST_PIECES);
    uint pieces = UINT(count);
    EXACT float share = pieces > 1u ? exact_rcp(FLOAT(pieces)) : 1.0f;
    EXACT float3 way = float3_sub(end, from);
    EXACT S(collide_frame) before = collide_frame_at(c, since);
    EXACT float3 a = collide_to_frame(before, from);
    for (uint i = 0u; i < pieces; i++) {
        bool last = i + 1u == pieces;
        EXACT float part = FLOAT(i + 1u) * share;
        EXACT float3 at = float3_add_scaled(from, way, part);
        EXACT float time = since + left * part;
        if (last) {
            at = end;
            time = until;
        }
        EXACT S(collide_frame) after = collide_frame_at(c, time);
        EXACT float3 b = collide_to_frame(after, at);
        span = collide_frame_segment(c.kind, before, after, a, b);
        if (collide_span_meets(span)) {
            bool within = collide_span_is_inside(span);
            if (within && i > 0u) /* a later piece starts inside only by rounding */
                span.face = collide_frame_nearest(c.kind, before, a);
            EXACT float sum = FLOAT(i) + span.enter;
            EXACT float enter = sum * share;
            span.enter = exact_min(enter, 1.0f);
            span.leave = 2.0f;
            span.outside = !within || i > 0u;
            return span;
        }
        before = after;
        a = b;
    }
    span.misses = true;
    return span;
}

FN_APART uint collide_oriented_nearest(SIM_PARAM uint number, float larger, float since, float3 p)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, larger);
    EXACT S(collide_frame) frame = collide_frame_at(c, since);
    EXACT float3 q = collide_to_frame(frame, p);
    uint face = collide_frame_nearest(c.kind, frame, q);
    return face;
}

FN_APART bool collide_oriented_inside(SIM_PARAM uint number, float larger, float until, float3 p)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, larger);
    EXACT S(collide_frame) frame = collide_frame_at(c, until);
    EXACT float3 q = collide_to_frame(frame, p);
    bool inside = collide_frame_inside(c.kind, frame, q);
    return inside;
}

/* A point of the surface, its normal, and its velocity. */
struct collide_contact {
    float3 position; /* just outside */
    float3 normal;
    float3 velocity; /* m/s */
};

/* Returns the gap, as collide_beside does, for the lengths from which a place on the surface is
 * computed. */
FN float collide_oriented_gap(S(collide_frame) frame, float3 q)
{
    EXACT float x = exact_abs(frame.center.x) + exact_abs(q.x);
    EXACT float y = exact_abs(frame.center.y) + exact_abs(q.y);
    EXACT float z = exact_abs(frame.center.z) + exact_abs(q.z);
    EXACT float reach = x + y + z + frame.radius;
    EXACT float gap = 6.103515625e-5f + reach * 9.5367431640625e-7f;
    return gap;
}

/* Returns by how much a face grows along its normal in a step. */
FN float collide_oriented_growth(S(kiln_collider) c, uint face)
{
    EXACT float growth = c.center_end.w - c.center.w;
    if (face != COLLIDE_SIDE) {
        EXACT float3 wider = FLOAT3(c.extent_end.x - c.extent.x, c.extent_end.y - c.extent.y,
                                    c.extent_end.z - c.extent.z);
        growth = collide_component(wider, face < COLLIDE_FACES ? face >> 1u : 1u);
    }
    return growth;
}

/* Returns the contact of a particle at p with a face; `spacing`: 1, or 0 for a place exactly on the
 * face. */
FN_APART S(collide_contact) collide_oriented_contact(SIM_PARAM uint number, float larger,
                                                     float since, uint face, float3 p,
                                                     float steps_per_s, float spacing)
{
    EXACT S(kiln_collider) c = collide_around(SIM number, larger);
    EXACT S(collide_contact) contact;
    EXACT S(collide_frame) frame = collide_frame_at(c, since);
    EXACT float3 q = collide_to_frame(frame, p);
    EXACT float gap = collide_oriented_gap(frame, q) * spacing;
    EXACT float3 normal = collide_frame_normal(c.kind, frame, face, q);
    EXACT float3 beside = collide_frame_put(c.kind, frame, face, q, gap);
    contact.normal = float3_turn(frame.pose, normal);
    contact.position = collide_from_frame(frame, beside);

    EXACT float growth = collide_oriented_growth(c, face);
    EXACT float3 grown = float3_scale(normal, growth);
    if (c.kind == COLLIDER_CAPSULE) { /* the ends of a growing capsule move apart */
        EXACT float longer = c.extent_end.y - c.extent.y;
        EXACT float beyond = exact_abs(beside.y) - frame.extent.y;
        EXACT float apart = beside.y < 0.0f ? -longer : longer;
        grown.y = grown.y + (beyond > 0.0f ? apart : 0.0f);
    }
    EXACT float3 motion = FLOAT3(c.center_end.x - c.center.x, c.center_end.y - c.center.y,
                                 c.center_end.z - c.center.z);
    EXACT float3 outwards = float3_turn(frame.pose, grown);
    EXACT float3 arm = float3_sub(contact.position, frame.center);
    EXACT float3 spin = FLOAT3(c.spin.x, c.spin.y, c.spin.z);
    spin = float3_scale(spin, c.spin.w);
    EXACT float3 around = float3_cross(spin, arm);
    motion = float3_add(motion, outwards);
    motion = float3_add(motion, around);
    contact.velocity = float3_scale(motion, steps_per_s);
    return contact;
}

/* Moves a point out of the collider through the nearest part of its surface, since a half space has
 * no upper end. */
FN_APART float3 collide_oriented_rise(SIM_PARAM uint number, float larger, float until, float3 p)
{
    uint face = collide_oriented_nearest(SIM number, larger, until, p);
    EXACT S(collide_contact) contact =
        collide_oriented_contact(SIM number, larger, until, face, p, 1.0f, 1.0f);
    EXACT float3 y = contact.position;
    return y;
}

/* Returns where a point that rests on the collider is carried from one part of the step to
 * another. */
FN_APART float3 collide_oriented_carry(SIM_PARAM uint number, float since, float until, float3 p)
{
    EXACT S(kiln_collider) c = AROUND(colliders[number]);
    EXACT S(collide_frame) before = collide_frame_at(c, since);
    EXACT S(collide_frame) after = collide_frame_at(c, until);
    EXACT float3 q = collide_to_frame(before, p);
    EXACT float3 y = collide_from_frame(after, q);
    return y;
}

#endif
