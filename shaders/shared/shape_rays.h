/* Finds where rays enter and leave boxes, balls, capped cylinders, capsules and planes: the shapes
 * of the backdrop, for the eye's rays and for those towards the sun. A ray that misses leaves a
 * shape before it enters. Every shape is convex. */
#ifndef KILN_SHARED_SHAPE_RAYS_H
#define KILN_SHARED_SHAPE_RAYS_H

#include "shared/real.h"

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

/* Returns where a shape blocks the light of a sun without size from a ray's start. */
REAL_FN truth ray_is_blocked(S(ray_interval) at)
{
    return real_max(at.near, real_all(0.0f)) < at.far;
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

/* ---- boxes: what three slabs have in common -------------------------------------------------- */

/* The t at which a ray enters and leaves the slab of each axis. */
struct ray_slabs {
    real3 near, far;
};

/* Intersects the slabs of a box about `towards`, the way from the ray's start to the box's middle.
 * halves: of the box's size; inverse: ray_inverse3 of the ray's direction. All are along the box's
 * axes. */
REAL_FN S(ray_slabs) ray_cross_slabs(real3 towards, float4 halves, real3 inverse)
{
    real3 middle = REAL3(towards.x * inverse.x, towards.y * inverse.y, towards.z * inverse.z);
    real3 extent = REAL3(halves.x * real_abs(inverse.x), halves.y * real_abs(inverse.y),
                         halves.z * real_abs(inverse.z));
    S(ray_slabs) slabs;
    slabs.near = real3_sub(middle, extent);
    slabs.far = real3_add(middle, extent);
    return slabs;
}

REAL_FN S(ray_interval) ray_slabs_interval(S(ray_slabs) s)
{
    return ray_interval_of(real_max(real_max(s.near.x, s.near.y), s.near.z),
                           real_min(real_min(s.far.x, s.far.y), s.far.z));
}

/* Returns the normal of the face that a ray enters by: that of the slab which it enters last. */
REAL_FN real3 ray_slabs_normal(S(ray_slabs) s, real3 inverse)
{
    truth x = truth_and(s.near.x >= s.near.y, s.near.x >= s.near.z);
    truth y = truth_and(truth_not(x), s.near.y >= s.near.z);
    truth z = truth_not(truth_or(x, y));
    return REAL3(real_where(x, -real_sign_one(inverse.x)), real_where(y, -real_sign_one(inverse.y)),
                 real_where(z, -real_sign_one(inverse.z)));
}

/* Returns the number, -13 to 13, of a face from its normal in the box's frame. */
REAL_FN real ray_face_number(real3 normal)
{
    return normal.x + 3.0f * normal.y + 9.0f * normal.z;
}

/* ---- round shapes ---------------------------------------------------------------------------- */

/* Intersects a ball: its centre, w: its radius. The discriminant is taken from the vector across
 * the ray, which stays precise far away. */
REAL_FN S(ray_interval) ray_cross_ball(float4 ball, real3 origin, real3 direction)
{
    real3 towards = real3_towards(ball, origin);
    real a = 1.0f / real3_dot(direction, direction);
    real middle = real3_dot(towards, direction) * a;
    real3 across = real3_add_scaled(towards, direction, -middle);
    real inside = (ball.w * ball.w - real3_dot(across, across)) * a;
    real extent = real_sqrt(real_max(inside, real_all(0.0f)));
    return ray_interval_or_miss(inside > 0.0f, middle - extent, middle + extent);
}

struct ray_cylinder {
    S(ray_interval) interval;
    truth on_end; /* the ray enters through a flat end */
};

/* Intersects a capped cylinder: its middle, w: its radius; its axis, unit, w: half of its height.
 */
REAL_FN S(ray_cylinder) ray_cross_cylinder(float4 cylinder, float4 axis, real3 origin,
                                           real3 direction)
{
    real3 from = real3_sub(origin, real3_all(cylinder));
    real height = real3_dot_all(from, axis), climb = real3_dot_all(direction, axis);
    real3 flat_from = real3_add_scaled(from, real3_all(axis), -height);
    real3 flat_direction = real3_add_scaled(direction, real3_all(axis), -climb);

    real a = 1.0f / real_max(real3_dot(flat_direction, flat_direction), real_all(1e-12f));
    real middle = -real3_dot(flat_from, flat_direction) * a;
    real3 across = real3_add_scaled(flat_from, flat_direction, middle);
    real inside = (cylinder.w * cylinder.w - real3_dot(across, across)) * a;
    real extent = real_sqrt(real_max(inside, real_all(0.0f)));

    real inverse = ray_inverse(climb);
    real slab_middle = -height * inverse, slab_extent = axis.w * real_abs(inverse);
    real slab_near = slab_middle - slab_extent, slab_far = slab_middle + slab_extent;
    truth hits = inside > 0.0f;
    real side_near = real_select(hits, middle - extent, real_all(1.0f));
    S(ray_cylinder) found;
    found.interval =
        ray_interval_of(real_max(side_near, slab_near),
                        real_select(hits, real_min(middle + extent, slab_far), real_all(-1e9f)));
    found.on_end = slab_near > side_near;
    return found;
}

/* Returns the interval of two convex shapes whose union is convex. */
REAL_FN S(ray_interval) ray_either(S(ray_interval) a, S(ray_interval) b)
{
    truth has_a = a.near <= a.far, has_b = b.near <= b.far;
    real near = real_min(real_select(has_a, a.near, b.near), real_select(has_b, b.near, a.near));
    real far = real_max(real_select(has_a, a.far, b.far), real_select(has_b, b.far, a.far));
    return ray_interval_or_miss(truth_or(has_a, has_b), near, far);
}

/* Returns the ball at an end of a capsule. */
FN float4 ray_capsule_end(float4 capsule, float4 axis, float way)
{
    float far = axis.w * way;
    return FLOAT4(capsule.x + axis.x * far, capsule.y + axis.y * far, capsule.z + axis.z * far,
                  capsule.w);
}

/* Intersects a capsule: a cylinder without its ends, as ray_cross_cylinder takes it, and two balls.
 */
REAL_FN S(ray_interval) ray_cross_capsule(float4 capsule, float4 axis, real3 origin,
                                          real3 direction)
{
    S(ray_interval) low = ray_cross_ball(ray_capsule_end(capsule, axis, -1.0f), origin, direction);
    S(ray_interval) high = ray_cross_ball(ray_capsule_end(capsule, axis, 1.0f), origin, direction);
    S(ray_interval) barrel = ray_cross_cylinder(capsule, axis, origin, direction).interval;
    return ray_either(barrel, ray_either(low, high));
}

/* ---- planes ---------------------------------------------------------------------------------- */

/* Returns the t at which a ray from above a plane meets it; a large number for other rays. height:
 * of the ray's start above the plane; climb: of its direction. */
REAL_FN real ray_cross_plane(real height, real climb)
{
    truth falls = truth_and(climb<-1e-6f, height> 0.0f);
    return real_select(falls, height / -real_select(falls, climb, real_all(-1.0f)), real_all(2e9f));
}

#endif
