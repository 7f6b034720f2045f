/* Declares the frame of a collider that may move and turn, and what its kinds have in common. Each
 * kind has its collision in shape_KIND.h, in this frame; collide_oriented.h lists them. */
#ifndef KILN_SHARED_COLLIDE_FRAME_H
#define KILN_SHARED_COLLIDE_FRAME_H

#include "shared/collide_around.h"
#include "shared/collide_round.h"

/* A collider at a time of the step. It lies around its centre and along the y axis. */
struct collide_frame {
    float3 center;
    float4 pose;
    float3 extent;
    float radius;
    float swell; /* radius of the ball that meets a cone, m; other kinds are enlarged by it */
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
    frame.center = collide_moving3(c.center, c.center_end, since);
    frame.radius = collide_moving(c.center.w, c.center_end.w, since);
    frame.extent = collide_moving3(c.extent, c.extent_end, since);
    frame.swell = c.extent.w;
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

/* ---- spans ----------------------------------------------------------------------------------- */

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

/* ---- round sides ----------------------------------------------------------------------------- */

/* Returns the vector from the axis. */
FN float3 collide_from_axis(float3 q)
{
    EXACT float3 y = FLOAT3(q.x, 0.0f, q.z);
    return y;
}

/* Intersects a segment with a cylinder: a round side between two ends. */
FN S(collide_span) collide_barrel(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_span_start();
    EXACT float3 from = collide_from_axis(a);
    EXACT float3 to = collide_from_axis(b);
    EXACT float lower0 = start.extent.y + a.y;
    EXACT float lower1 = end.extent.y + b.y;
    EXACT float upper0 = start.extent.y - a.y;
    EXACT float upper1 = end.extent.y - b.y;
    span = collide_side(span, from, to, start.radius, end.radius);
    span = collide_face(span, COLLIDE_LOWER, lower0, lower1);
    span = collide_face(span, COLLIDE_UPPER, upper0, upper1);
    return span;
}

/* Returns the part of the surface that a point inside is nearest to, of a side and two ends. side:
 * its distance from the side, m; end: of the ends from the centre, m. */
FN uint collide_nearest_of(float side, float end, float3 q)
{
    uint face = COLLIDE_SIDE;
    EXACT float lower = end + q.y;
    EXACT float upper = end - q.y;
    face = lower < side ? COLLIDE_LOWER : face;
    EXACT float least = exact_min(lower, side);
    face = upper < least ? COLLIDE_UPPER : face;
    return face;
}

/* ---- faces that several kinds have ----------------------------------------------------------- */

/* Returns the outward normal of one of the two ends across the axis. */
FN float3 collide_end_normal(uint face)
{
    EXACT float3 normal = FLOAT3(0.0f, 0.0f, 0.0f);
    normal.y = face == COLLIDE_UPPER ? 1.0f : -1.0f;
    return normal;
}

/* Returns the point of one of these ends that is nearest to q, moved outwards by `gap`. */
FN float3 collide_end_put(S(collide_frame) frame, uint face, float3 q, float gap)
{
    EXACT float3 y = q;
    EXACT float far = frame.extent.y + gap;
    y.y = face == COLLIDE_UPPER ? far : -far;
    return y;
}

/* Returns the outward normal of a round side. across: the vector from its axis or centre. */
FN float3 collide_side_normal(float3 across)
{
    EXACT float3 otherwise = FLOAT3(1.0f, 0.0f, 0.0f);
    EXACT float3 normal = float3_normalize(across, otherwise);
    return normal;
}

/* Returns the point of a round side that is nearest to q, moved outwards by `gap`. */
FN float3 collide_side_put(S(collide_frame) frame, float3 across, float3 q, float gap)
{
    EXACT float3 normal = collide_side_normal(across);
    EXACT float3 foot = FLOAT3(0.0f, q.y - across.y, 0.0f);
    EXACT float far = frame.radius + gap;
    EXACT float3 y = float3_add_scaled(foot, normal, far);
    return y;
}

/* Returns by how much a collider's extent along its axis grows in a step. */
FN float collide_axis_growth(S(kiln_collider) c)
{
    EXACT float growth = c.extent_end.y - c.extent.y;
    return growth;
}

/* Returns by how much its radius grows. */
FN float collide_radius_growth(S(kiln_collider) c)
{
    EXACT float growth = c.center_end.w - c.center.w;
    return growth;
}

#endif
