/* This header finds where vectors of rays hit boxes, spheres and cylinders, as
 * shaders/draw/backdrop/surface.glsl and round.glsl do in GL. */
#ifndef KILN_DRAW_BACKDROP_RAY_SHAPES_H
#define KILN_DRAW_BACKDROP_RAY_SHAPES_H

#include "draw/backdrop/ray.h"
#include "draw/vector/ray_math.h"

#define RAY_FAR 1e9f

/* The sky's surface is -1, the floor's 0; a face of a box has a number of its own, below 1000. */
enum {
    RAY_SPHERES = 1000,
    RAY_CYLINDERS = 1100,
    RAY_TURNED = 1200, /* as boxes */
    RAY_CAPSULES = 2200,
    RAY_PLANES = 2250,
    RAY_MESHES = 2300, /* nothing is above these */
};

struct ray {
    struct vf3 origin, direction;
};

struct ray_hit {
    vf t;
    vf surface; /* a whole number */
    struct vf3 normal, albedo;
};

struct ray_interval {
    vf in, out;
};

SIMD vf signed_one(vf x)
{
    return (vf)(((vi)x & INT32_MIN) | 0x3f800000);
}

SIMD vf inverse_of(vf x)
{
    return signed_one(x) / vf_max(vf_abs(x), vf_all(1e-8f));
}

SIMD struct vf3 safe_inverse(struct vf3 direction)
{
    return (struct vf3){inverse_of(direction.x), inverse_of(direction.y), inverse_of(direction.z)};
}

SIMD struct vf3 ray_at(const struct ray *ray, vf t)
{
    return vf3_along(ray->origin, ray->direction, t);
}

/* Replaces the nearest hit in the lanes of a nearer one. */
SIMD void keep_nearer(struct ray_hit *nearest, vi nearer, vf t, vf surface, struct vf3 normal,
                      float4 albedo)
{
    nearest->t = vf_select(nearer, t, nearest->t);
    nearest->surface = vf_select(nearer, surface, nearest->surface);
    nearest->normal = vf3_select(nearer, normal, nearest->normal);
    nearest->albedo = vf3_select(nearer, vf3_all(albedo), nearest->albedo);
}

/* ---- boxes ----------------------------------------------------------------------------------- */

/* Where a ray enters and leaves the slabs of a box. */
struct ray_slabs {
    struct vf3 in, out;
};

SIMD struct ray_slabs cross_slabs(float4 center, float4 half, struct vf3 origin, struct vf3 inverse)
{
    struct vf3 middle = vf3_towards(center, origin);
    middle = (struct vf3){middle.x * inverse.x, middle.y * inverse.y, middle.z * inverse.z};
    struct vf3 extent = {half.x * vf_abs(inverse.x), half.y * vf_abs(inverse.y),
                         half.z * vf_abs(inverse.z)};
    return (struct ray_slabs){vf3_sub(middle, extent), vf3_add(middle, extent)};
}

SIMD struct ray_interval slabs_interval(const struct ray_slabs *s)
{
    return (struct ray_interval){vf_max(vf_max(s->in.x, s->in.y), s->in.z),
                                 vf_min(vf_min(s->out.x, s->out.y), s->out.z)};
}

/* Returns the normal of the face of the slab that is entered last. */
SIMD struct vf3 slabs_normal(const struct ray_slabs *s, struct vf3 inverse)
{
    vi x = (s->in.x >= s->in.y) & (s->in.x >= s->in.z);
    vi y = ~x & (s->in.y >= s->in.z), z = ~x & ~y;
    return (struct vf3){vf_where(x, -signed_one(inverse.x)), vf_where(y, -signed_one(inverse.y)),
                        vf_where(z, -signed_one(inverse.z))};
}

SIMD void trace_boxes(const struct kiln_ray_frame *frame, uint32_t boxes, const struct ray *ray,
                      struct ray_hit *nearest)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    struct vf3 inverse = safe_inverse(ray->direction);
    for (; boxes; boxes &= boxes - 1) {
        int i = __builtin_ctz(boxes);
        struct ray_slabs s = cross_slabs(b->box_center[i], b->box_half[i], ray->origin, inverse);
        struct ray_interval at = slabs_interval(&s);
        vi nearer = (at.in <= at.out) & (at.in > 0.0f) & (at.in < nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 normal = slabs_normal(&s, inverse);
        vf face = normal.x + 3.0f * normal.y + 9.0f * normal.z;
        keep_nearer(nearest, nearer, at.in, face + (float)(14 + 27 * i), normal, b->box_color[i]);
    }
}

/* ---- round ones ------------------------------------------------------------------------------ */

/* Intersects a sphere. It uses the vector across the ray, which stays precise far away; out < in
 * for a miss. */
SIMD struct ray_interval cross_sphere(float4 sphere, const struct ray *ray)
{
    struct vf3 towards = vf3_towards(sphere, ray->origin);
    vf a = 1.0f / vf3_dot(ray->direction, ray->direction);
    vf middle = vf3_dot(towards, ray->direction) * a;
    struct vf3 across = vf3_along(towards, ray->direction, -middle);
    vf inside = (sphere.w * sphere.w - vf3_dot(across, across)) * a;
    vf extent = vf_sqrt(vf_max(inside, vf_all(0.0f)));
    vi hits = inside > 0.0f;
    return (struct ray_interval){vf_select(hits, middle - extent, vf_all(1.0f)),
                                 vf_select(hits, middle + extent, vf_all(-1.0f))};
}

SIMD void trace_spheres(const struct kiln_ray_frame *frame, uint32_t spheres, const struct ray *ray,
                        struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; spheres; spheres &= spheres - 1) {
        int i = __builtin_ctz(spheres);
        float4 sphere = shapes->spheres[i];
        struct ray_interval at = cross_sphere(sphere, ray);
        vi nearer = (at.in <= at.out) & (at.in > 0.0f) & (at.in < nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 out = vf3_sub(ray_at(ray, at.in), vf3_all(sphere));
        keep_nearer(nearest, nearer, at.in, vf_all((float)(RAY_SPHERES + i)), vf3_normalize(out),
                    shapes->sphere_color[i]);
    }
}

struct ray_cylinder {
    struct ray_interval interval;
    vi on_end; /* enters through a flat end */
};

SIMD struct ray_cylinder cross_cylinder(float4 cylinder, float4 axis, const struct ray *ray)
{
    struct vf3 from = vf3_sub(ray->origin, vf3_all(cylinder));
    vf height = vf3_dot_all(from, axis), climb = vf3_dot_all(ray->direction, axis);
    struct vf3 flat_from = vf3_along(from, vf3_all(axis), -height);
    struct vf3 flat_direction = vf3_along(ray->direction, vf3_all(axis), -climb);

    vf a = 1.0f / vf_max(vf3_dot(flat_direction, flat_direction), vf_all(1e-12f));
    vf middle = -vf3_dot(flat_from, flat_direction) * a;
    struct vf3 across = vf3_along(flat_from, flat_direction, middle);
    vf inside = (cylinder.w * cylinder.w - vf3_dot(across, across)) * a;
    vf extent = vf_sqrt(vf_max(inside, vf_all(0.0f)));

    vf inverse = inverse_of(climb);
    vf slab_middle = -height * inverse, slab_extent = axis.w * vf_abs(inverse);
    vf slab_in = slab_middle - slab_extent, slab_out = slab_middle + slab_extent;
    vi hits = inside > 0.0f;
    vf side_in = vf_select(hits, middle - extent, vf_all(1.0f));
    struct ray_interval both = {vf_max(side_in, slab_in),
                                vf_select(hits, vf_min(middle + extent, slab_out), vf_all(-1e9f))};
    return (struct ray_cylinder){both, slab_in > side_in};
}

SIMD void trace_cylinders(const struct kiln_ray_frame *frame, uint32_t cylinders,
                          const struct ray *ray, struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; cylinders; cylinders &= cylinders - 1) {
        int i = __builtin_ctz(cylinders);
        float4 cylinder = shapes->cylinders[i], axis = shapes->cylinder_axis[i];
        struct ray_cylinder c = cross_cylinder(cylinder, axis, ray);
        struct ray_interval at = c.interval;
        vi nearer = (at.in <= at.out) & (at.in > 0.0f) & (at.in < nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 from = vf3_sub(ray_at(ray, at.in), vf3_all(cylinder));
        vf height = vf3_dot_all(from, axis);
        struct vf3 side = vf3_normalize(vf3_along(from, vf3_all(axis), -height));
        struct vf3 end = vf3_scale(vf3_all(axis), signed_one(height));
        vf part = vf_where(c.on_end, vf_select(height > 0.0f, vf_all(1.0f), vf_all(2.0f)));
        keep_nearer(nearest, nearer, at.in, part + (float)(RAY_CYLINDERS + 3 * i),
                    vf3_select(c.on_end, end, side), shapes->cylinder_color[i]);
    }
}

#endif
