/* This header finds the nearest sphere, cylinder or axis-aligned box that vectors of rays hit. */
#ifndef KILN_DRAW_BACKDROP_RAY_SHAPES_H
#define KILN_DRAW_BACKDROP_RAY_SHAPES_H

#include "base/real.h"
#include "draw/backdrop/ray.h"
#include "shared/shape_rays.h"

#define RAY_FAR 1e9f

struct ray {
    struct vf3 origin, direction;
};

struct ray_hit {
    vf t;
    vf surface; /* KILN_SURFACE_* number of the hit surface, a whole number */
    struct vf3 normal, albedo;
};

SIMD struct vf3 ray_at(const struct ray *ray, vf t)
{
    return vf3_add_scaled(ray->origin, ray->direction, t);
}

/* Replaces the nearest hit in the lanes where another hit is nearer. */
SIMD void keep_nearer(struct ray_hit *nearest, vi nearer, vf t, vf surface, struct vf3 normal,
                      float4 albedo)
{
    nearest->t = vf_select(nearer, t, nearest->t);
    nearest->surface = vf_select(nearer, surface, nearest->surface);
    nearest->normal = vf3_select(nearer, normal, nearest->normal);
    nearest->albedo = vf3_select(nearer, vf3_all(albedo), nearest->albedo);
}

/* ---- boxes ----------------------------------------------------------------------------------- */

SIMD void trace_boxes(const struct kiln_ray_frame *frame, uint32_t boxes, const struct ray *ray,
                      struct ray_hit *nearest)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    struct vf3 inverse = ray_inverse3(ray->direction);
    for (; boxes; boxes &= boxes - 1) {
        int i = __builtin_ctz(boxes);
        struct ray_slabs s =
            ray_cross_slabs(vf3_towards(b->box_center[i], ray->origin), b->box_half[i], inverse);
        struct ray_interval at = ray_slabs_interval(s);
        vi nearer = ray_meets(at, nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 normal = ray_slabs_normal(s, inverse);
        keep_nearer(nearest, nearer, at.near,
                    ray_face_number(normal) + (float)KILN_SURFACE_BOX(KILN_SURFACE_BOXES, i),
                    normal, b->box_color[i]);
    }
}

/* ---- spheres and cylinders ------------------------------------------------------------------- */

SIMD void trace_spheres(const struct kiln_ray_frame *frame, uint32_t spheres, const struct ray *ray,
                        struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; spheres; spheres &= spheres - 1) {
        int i = __builtin_ctz(spheres);
        float4 sphere = shapes->spheres[i];
        struct ray_interval at = ray_cross_ball(sphere, ray->origin, ray->direction);
        vi nearer = ray_meets(at, nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 out = vf3_sub(ray_at(ray, at.near), vf3_all(sphere));
        keep_nearer(nearest, nearer, at.near, vf_all((float)(KILN_SURFACE_SPHERES + i)),
                    vf3_normalize(out), shapes->sphere_color[i]);
    }
}

SIMD void trace_cylinders(const struct kiln_ray_frame *frame, uint32_t cylinders,
                          const struct ray *ray, struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; cylinders; cylinders &= cylinders - 1) {
        int i = __builtin_ctz(cylinders);
        float4 cylinder = shapes->cylinders[i], axis = shapes->cylinder_axis[i];
        struct ray_cylinder c = ray_cross_cylinder(cylinder, axis, ray->origin, ray->direction);
        struct ray_interval at = c.interval;
        vi nearer = ray_meets(at, nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 from = vf3_sub(ray_at(ray, at.near), vf3_all(cylinder));
        vf height = vf3_dot_all(from, axis);
        struct vf3 side = vf3_normalize(vf3_add_scaled(from, vf3_all(axis), -height));
        struct vf3 end = vf3_scale(vf3_all(axis), vf_sign_one(height));
        vf part = vf_where(c.on_end, vf_select(height > 0.0f, vf_all(1.0f), vf_all(2.0f)));
        keep_nearer(nearest, nearer, at.near, part + (float)(KILN_SURFACE_CYLINDERS + 3 * i),
                    vf3_select(c.on_end, end, side), shapes->cylinder_color[i]);
    }
}

#endif
