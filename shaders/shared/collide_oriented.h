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

#include "shared/collide_frame.h"
#include "shared/shape_kinds.h"
#include "shared/uses.h"

#define COLLIDE_PIECES_PER_RAD 32.0f
#define COLLIDE_MOST_PIECES    32.0f

/* A new kind is the last part of a file shape_KIND.h, with these functions in the frame of the
 * collider, and a row of shape_kinds.h:
 *   KIND_holds    whether a point is inside
 *   KIND_segment  where a segment is inside; a and b: its ends, in the frames at their times
 *   KIND_nearest  the part of the surface that a point inside is nearest to
 *   KIND_normal   the outward normal at a point near that part
 *   KIND_put      the point of that part that is nearest to q, moved outwards by `gap`
 *   KIND_grown    how far the surface moves along its normal in a step, at the point q of it */

/* ---- tests in the frame of a collider -------------------------------------------------------- */

FN bool collide_frame_inside(uint kind, S(collide_frame) frame, float3 q)
{
    bool inside = false;
#define HOLDS(KIND, name)                                                                          \
    if (USES(USES_COLLIDERS, COLLIDER_##KIND) && kind == COLLIDER_##KIND)                          \
        inside = name##_holds(frame, q);
    SHAPE_KINDS_OF_COLLISION(HOLDS)
#undef HOLDS
    return inside;
}

FN S(collide_span) collide_frame_segment(uint kind, S(collide_frame) start, S(collide_frame) end,
                                         float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_span_start();
#define SEGMENT(KIND, name)                                                                        \
    if (USES(USES_COLLIDERS, COLLIDER_##KIND) && kind == COLLIDER_##KIND)                          \
        span = name##_segment(start, end, a, b);
    SHAPE_KINDS_OF_COLLISION(SEGMENT)
#undef SEGMENT
    return span;
}

FN uint collide_frame_nearest(uint kind, S(collide_frame) frame, float3 q)
{
    uint face = COLLIDE_SIDE;
#define NEAREST(KIND, name)                                                                        \
    if (USES(USES_COLLIDERS, COLLIDER_##KIND) && kind == COLLIDER_##KIND)                          \
        face = name##_nearest(frame, q);
    SHAPE_KINDS_OF_COLLISION(NEAREST)
#undef NEAREST
    return face;
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
    EXACT float size = frame.radius + frame.extent.x;
    size = size + frame.extent.y;
    size = size + frame.extent.z;
    size = size > 0.0f ? size : 1.0f; /* a plane */
    EXACT float least = collide_least_gap(size);
    EXACT float gap = least + reach * 9.5367431640625e-7f;
    return gap;
}

/* The surface of a collider near a point, in its frame. */
struct collide_surface {
    float3 normal;
    float3 beside; /* the point of it, moved outwards */
    float3 grown;  /* how far it moves by growth in a step */
};

FN S(collide_surface) collide_surface_at(S(kiln_collider) c, S(collide_frame) frame, uint face,
                                         float3 q, float gap)
{
    EXACT S(collide_surface) surface;
    surface.normal = FLOAT3(0.0f, 0.0f, 0.0f);
    surface.beside = q;
    surface.grown = surface.normal;
#define SURFACE(KIND, name)                                                                        \
    if (USES(USES_COLLIDERS, COLLIDER_##KIND) && c.kind == COLLIDER_##KIND) {                      \
        surface.normal = name##_normal(frame, face, q);                                            \
        surface.beside = name##_put(frame, face, q, gap);                                          \
        surface.grown = name##_grown(c, frame, face, surface.normal, surface.beside);              \
    }
    SHAPE_KINDS_OF_COLLISION(SURFACE)
#undef SURFACE
    return surface;
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
    EXACT S(collide_surface) surface = collide_surface_at(c, frame, face, q, gap);
    contact.normal = float3_turn(frame.pose, surface.normal);
    contact.position = collide_from_frame(frame, surface.beside);

    EXACT float3 motion = FLOAT3(c.center_end.x - c.center.x, c.center_end.y - c.center.y,
                                 c.center_end.z - c.center.z);
    EXACT float3 outwards = float3_turn(frame.pose, surface.grown);
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
