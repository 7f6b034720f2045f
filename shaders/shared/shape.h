/* Declares what all kinds of shapes of the backdrop have in common: their frame, the interval in
 * which a ray is inside, and the sky beside them. Each kind has a file shape_KIND.h
 * (shapes.h). Every shape is convex. A ray that misses a shape leaves it before it enters.
 * `towards` is the way from a point to the shape's centre, m. */
#ifndef KILN_SHARED_SHAPE_H
#define KILN_SHARED_SHAPE_H

#include "shared/light_cover.h"
#include "shared/shape_layout.h"

/* ---- frames ---------------------------------------------------------------------------------- */

/* Turns a vector of the world into the frame of a shape. In C, boxes along the axes of the world
 * skip it. */
REAL_FN real3 shape_into(S(kiln_draw_shape) s, real3 v)
{
#ifndef GL_core_profile
    if (s.kind.y == 0u)
        return v;
#endif
    return REAL3(real3_dot_all(v, s.rows[0]), real3_dot_all(v, s.rows[1]),
                 real3_dot_all(v, s.rows[2]));
}

/* Turns a vector out of the frame of a shape. */
REAL_FN real3 shape_out_of(S(kiln_draw_shape) s, real3 v)
{
#ifndef GL_core_profile
    if (s.kind.y == 0u)
        return v;
#endif
    return REAL3(v.x * s.rows[0].x + v.y * s.rows[1].x + v.z * s.rows[2].x,
                 v.x * s.rows[0].y + v.y * s.rows[1].y + v.z * s.rows[2].y,
                 v.x * s.rows[0].z + v.y * s.rows[1].z + v.z * s.rows[2].z);
}

/* Returns the component of a vector along a shape's axis. */
REAL_FN real shape_along(S(kiln_draw_shape) s, real3 v)
{
    return real3_dot_all(v, s.rows[1]);
}

/* Returns the components of a vector across a shape's axis. along: that along it. */
REAL_FN real3 shape_across(S(kiln_draw_shape) s, real3 v, real along)
{
    return real3_add_scaled(v, real3_all(s.rows[1]), -along);
}

/* Returns how far a disc extends along a direction, m. climb: the cosine between its normal and the
 * direction. */
REAL_FN real disc_reach(float radius, real climb)
{
    return radius * real_sqrt(real_max(1.0f - climb * climb, real_all(0.0f)));
}

/* ---- rays ------------------------------------------------------------------------------------ */

/* A ray, with what is the same for all shapes that it may meet. */
struct shape_ray {
    real3 origin, direction;
    real3 inverse; /* ray_inverse3 of the direction */
};

/* The t at which a ray enters and leaves. */
struct ray_interval {
    real near, far;
};

REAL_FN S(ray_interval) ray_interval_of(real near, real far)
{
    S(ray_interval) interval;
    interval.near = near;
    interval.far = far;
    return interval;
}

REAL_FN S(ray_interval) ray_interval_or_miss(truth hits, real near, real far)
{
    return ray_interval_of(real_select(hits, near, real_all(1.0f)),
                           real_select(hits, far, real_all(-1.0f)));
}

/* Returns where an object is ahead of a ray's start and nearer to it than `t`. */
REAL_FN truth ray_meets(S(ray_interval) at, real t)
{
    return truth_and(truth_and(at.near <= at.far, at.near > 0.0f), at.near < t);
}

/* Returns 1 / x, or a large number where x is 0. */
REAL_FN real ray_inverse(real x)
{
    return real_sign_one(x) / real_max(real_abs(x), real_all(1e-8f));
}

REAL_FN real3 ray_inverse3(real3 direction)
{
    return REAL3(ray_inverse(direction.x), ray_inverse(direction.y), ray_inverse(direction.z));
}

REAL_FN S(shape_ray) shape_ray_of(real3 origin, real3 direction)
{
    S(shape_ray) ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.inverse = ray_inverse3(direction);
    return ray;
}

/* Returns the t at which a ray from above a plane meets it; a large number for other rays. height:
 * of the ray's start above the plane; climb: of its direction. */
REAL_FN real ray_cross_plane(real height, real climb)
{
    truth falls = truth_and(climb<-1e-6f, height> 0.0f);
    return real_select(falls, height / -real_select(falls, climb, real_all(-1.0f)), real_all(2e9f));
}

/* The surface that a ray enters a shape by. */
struct shape_face {
    real3 normal; /* unit, of the world */
    real number;  /* a whole number, KILN_FACE_LEAST to KILN_FACE_MOST: two faces meet at an edge */
};

/* ---- shapes around an axis ------------------------------------------------------------------- */

/* Returns the t at which a ray enters and leaves the round side of a cylinder without ends. */
REAL_FN S(ray_interval) tube_cross(S(kiln_draw_shape) s, real3 towards, real3 direction)
{
    real height = shape_along(s, towards), climb = shape_along(s, direction);
    real3 flat_towards = shape_across(s, towards, height);
    real3 flat_direction = shape_across(s, direction, climb);
    real a = 1.0f / real_max(real3_dot(flat_direction, flat_direction), real_all(1e-12f));
    real middle = real3_dot(flat_towards, flat_direction) * a;
    real3 across = real3_add_scaled(flat_towards, flat_direction, -middle);
    real inside = (s.extent.w * s.extent.w - real3_dot(across, across)) * a;
    real extent = real_sqrt(real_max(inside, real_all(0.0f)));
    return ray_interval_or_miss(inside > 0.0f, middle - extent, middle + extent);
}

/* Returns the t at which a ray crosses the planes of a cylinder's ends. */
REAL_FN S(ray_interval) ends_cross(S(kiln_draw_shape) s, real3 towards, real3 direction)
{
    real inverse = ray_inverse(shape_along(s, direction));
    real middle = shape_along(s, towards) * inverse, extent = s.extent.y * real_abs(inverse);
    return ray_interval_of(middle - extent, middle + extent);
}

/* An axis as seen in a direction. */
struct axis_seen {
    real3 right, up; /* unit, across the direction; the axis lies along `up` */
    /* Sine and cosine of the angle between the axis and the plane across the direction. */
    real climb, slant;
    real side; /* 1 if the axis points along `up`, -1 if against it */
};

/* Returns a shape's axis as seen in a direction. If that is along the axis, `right` is any vector
 * across it. */
REAL_FN S(axis_seen) axis_seen_along(S(kiln_draw_shape) s, real3 direction)
{
    S(axis_seen) seen;
    seen.climb = shape_along(s, direction);
    seen.slant = real_sqrt(real_max(1.0f - seen.climb * seen.climb, real_all(1e-6f)));
    real3 level = real3_scale(real3_cross(real3_all(s.rows[1]), direction), 1.0f / seen.slant);
    seen.right = real3_select(seen.slant > 1e-3f, level, real3_all(s.rows[0]));
    seen.up = real3_cross(direction, seen.right);
    seen.side = real_sign_one(shape_along(s, seen.up));
    return seen;
}

/* Returns where a cone of light may meet a shape around an axis, however long: where the distance
 * between the axis and the middle of the cone is no more than their radii. A cone that shrinks
 * towards the light is wider behind its start, where the ball that is lit begins. climb: the
 * cosine between the axis and the light; across: across both, as long as the axis is without its
 * part along the light; square: of that length. */
REAL_FN truth axis_may_hide(S(kiln_draw_shape) s, real3 towards, S(light_way) way, real climb,
                            real3 across, real square)
{
    float radius = s.extent.w;
    real far = real3_dot(towards, way.direction) + real_abs(climb) * s.extent.y + radius;
    real shrink = real_max(-way.spread, real_all(0.0f)) * way.lit;
    real wide = light_widest(way, far) + shrink + (radius + 1e-3f);
    real apart = real3_dot(towards, across);
    /* Rounding alone decides `across` where the axis is along the light. */
    real noise = 1e-12f * real3_dot(towards, towards);
    return apart * apart <= wide * wide * square + noise;
}

/* ---- the sky beside shapes ------------------------------------------------------------------- */

/* Returns how much a surface is turned towards an object, 0 to 1; a little of an object behind the
 * surface counts as well. along_normal: of the way to the object's middle. */
REAL_FN real sky_facing(real along_normal, real distance2)
{
    return real_clamp01(along_normal * real_rsqrt(real_max(distance2, real_all(1e-9f))) + 0.4f);
}

/* Returns the part of the sky that an object does not hide. fall: the part of the view that it
 * fills, 0 to 1. The darkening does not follow the exact solid angle; it makes objects look as if
 * they stood on the floor. */
REAL_FN real sky_left(real facing, real fall)
{
    return 1.0f - 0.7f * facing * fall;
}

/* Returns the part of the sky that a shape does not hide from a surface, which hides none where it
 * is wholly behind the surface. distance: from the surface's point to the shape, m; size: of the
 * shape, m; reach: how far it extends from its centre along the normal, m. */
REAL_FN real sky_beside(real3 towards, real3 normal, real distance, float size, real reach)
{
    real along = real3_dot(towards, normal);
    truth hides = along > 1e-3f - reach;
    if (!real_some(hides))
        return real_all(1.0f);
    real fall = size / (size + 2.0f * distance);
    real left = sky_left(sky_facing(along, real3_dot(towards, towards)), fall * fall);
    return real_select(hides, left, real_all(1.0f));
}

#endif
