/* Enlarges colliders by the radius of a ball that meets them, and tests whether a way may meet them
 * at all. */
#ifndef KILN_SHARED_COLLIDE_AROUND_H
#define KILN_SHARED_COLLIDE_AROUND_H

#include "shared/collide_box.h"

FN float4 collide_shifted(float4 v, float by)
{
    EXACT float4 y = FLOAT4(v.x + by, v.y + by, v.z + by, v.w);
    return y;
}

/* Enlarges a collider from a grid: its bounds by the radius, and the radius itself for its
 * look-ups. The walls of terrain and depth maps are met with the ball's centre. */
FN S(kiln_collider) collide_field_around(S(kiln_collider) collider, float radius)
{
    EXACT S(kiln_collider) c = collider;
    EXACT float raised = radius * c.steepest;
    if (c.kind == COLLIDER_TERRAIN) {
        c.max.y = c.max.y + raised;
        c.max_end.y = c.max_end.y + raised;
        c.center.w = radius;
    } else if (c.kind == COLLIDER_SDF) { /* its grid covers the largest radius */
        c.center.w = radius;
    }
    return c;
}

/* Returns the factor on a radius by which bounds grow in any orientation: by the root of three for
 * a box's corners, by the root of two for a cylinder's edges. */
FN float collide_askew_growth(uint kind, float steepest)
{
    EXACT float y = 1.0f;
    if (kind == COLLIDER_ORIENTED_BOX)
        y = 1.7321f;
    else if (kind == COLLIDER_ORIENTED_CYLINDER)
        y = 1.4143f;
    else if (kind == COLLIDER_CONE)
        y = steepest;
    return y;
}

/* Returns a collider, enlarged by a ball's radius, so that the ball's centre is tested against it.
 * Edges and corners stay sharp. Shaders of scenes without interaction are compiled without this. */
FN S(kiln_collider) collide_around(SIM_PARAM uint number, float radius)
{
    EXACT S(kiln_collider) c = AROUND(colliders[number]);
#if !defined(GL_core_profile) || defined(PUSHES)
    if (radius > 0.0f && c.kind >= COLLIDER_TERRAIN) {
        c = collide_field_around(c, radius);
    } else if (radius > 0.0f) {
        EXACT float higher = radius * collide_askew_growth(c.kind, c.steepest);
        EXACT float lower = -higher;
        c.min = collide_shifted(c.min, lower);
        c.min_end = collide_shifted(c.min_end, lower);
        c.max = collide_shifted(c.max, higher);
        c.max_end = collide_shifted(c.max_end, higher);
        if (c.kind == COLLIDER_CONE) { /* whose shape depends on the ball (shape_cone.h) */
            c.extent.w = radius;
            return c;
        }
        c.center.w = c.center.w + radius;
        c.center_end.w = c.center_end.w + radius;
        if (c.kind == COLLIDER_CYLINDER) {
            c.axis.w = c.axis.w + radius;
            c.half_height_end = c.half_height_end + radius;
        }
        if (c.kind != COLLIDER_CAPSULE) { /* a capsule grows by its radius alone */
            c.extent = collide_shifted(c.extent, radius);
            c.extent_end = collide_shifted(c.extent_end, radius);
        }
    }
#endif
    return c;
}

#ifndef GL_core_profile

/* Returns whether, along one axis, a way from a to b may be between two faces. If both ends are
 * outside of the same face, the way does not meet the collider (collide_face). */
FN_CLOSE uint collide_is_between(float a, float b, float low, float low_end, float high,
                                 float high_end)
{
    uint above = (uint)(a >= low) | (uint)(b >= low_end);
    uint below = (uint)(a <= high) | (uint)(b <= high_end);
    return above & below;
}

/* Returns whether a way may be between the ends of a cylinder. A cylinder's bounds are those of
 * balls about its ends, which are much too high for a flat one. Far from its centre, heights have
 * the rounding of their places. */
FN_CLOSE uint collide_is_between_ends(const S(kiln_collider) *c, float larger, float3 a, float3 b)
{
    float3 axis = FLOAT3(c->axis.x, c->axis.y, c->axis.z);
    float3 from = float3_sub(a, FLOAT3(c->center.x, c->center.y, c->center.z));
    float3 to = float3_sub(b, FLOAT3(c->center_end.x, c->center_end.y, c->center_end.z));
    float far_from = exact_abs(from.x) + exact_abs(from.y) + exact_abs(from.z);
    float far_to = exact_abs(to.x) + exact_abs(to.y) + exact_abs(to.z);
    float height = float3_dot(from, axis), height_end = float3_dot(to, axis);
    float limit = c->axis.w + larger + 1e-5f * far_from;
    float limit_end = c->half_height_end + larger + 1e-5f * far_to;
    return collide_is_between(height, height_end, -limit, -limit_end, limit, limit_end);
}

/* Returns how far outside of its bounds a collider may be met by rounding: the bounds of a round
 * shape are computed apart from its surface, which has the rounding of its place and size. */
FN_CLOSE float collide_bounds_gap(const S(kiln_collider) *c)
{
    if (c->kind == COLLIDER_BOX)
        return 0.0f;
    float place = exact_abs(c->center.x) + exact_abs(c->center.y) + exact_abs(c->center.z);
    float size = c->max.x - c->min.x;
    return 0.01f + 1e-6f * (place + size);
}

/* Returns the factor on a radius by which a collider's bounds grow: the edges of a cylinder grow
 * with its side and its ends. */
FN_CLOSE float collide_bounds_growth(const S(kiln_collider) *c)
{
    return c->kind == COLLIDER_TERRAIN    ? c->steepest
           : c->kind == COLLIDER_CYLINDER ? 1.4143f
                                          : collide_askew_growth(c->kind, c->steepest);
}

/* Returns whether a way may be within bounds that are enlarged by r and a gap. */
FN_CLOSE uint collide_is_within(const S(kiln_collider) *c, float r, float gap, float3 a, float3 b)
{
    return collide_is_between(a.x, b.x, (c->min.x - r) - gap, (c->min_end.x - r) - gap,
                              (c->max.x + r) + gap, (c->max_end.x + r) + gap) &
           collide_is_between(a.y, b.y, (c->min.y - r) - gap, (c->min_end.y - r) - gap,
                              (c->max.y + r) + gap, (c->max_end.y + r) + gap) &
           collide_is_between(a.z, b.z, (c->min.z - r) - gap, (c->min_end.z - r) - gap,
                              (c->max.z + r) + gap, (c->max_end.z + r) + gap);
}

/* Returns whether a collider is a box or a round shape that stands still in the step, so that
 * collide_may_meet holds for a way through any part of the step. */
FN_CLOSE bool collide_stands(const S(kiln_collider) *c)
{
    return c->kind <= COLLIDER_CYLINDER && c->min.x == c->min_end.x && c->min.y == c->min_end.y &&
           c->min.z == c->min_end.z && c->max.x == c->max_end.x && c->max.y == c->max_end.y &&
           c->max.z == c->max_end.z && c->axis.w == c->half_height_end;
}

/* Returns whether a ball's way through the whole step may meet a collider of any kind but a plane.
 * It is a test before the exact one. */
FN_CLOSE bool collide_may_meet(const S(kiln_collider) *c, float radius, float3 a, float3 b)
{
    float gap = collide_bounds_gap(c);
    if (collide_is_within(c, radius * collide_bounds_growth(c), gap, a, b) == 0u)
        return false;
    return c->kind != COLLIDER_CYLINDER || collide_is_between_ends(c, radius + gap, a, b) != 0u;
}

#endif

#endif
