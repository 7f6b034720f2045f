/* This header finds where vectors of rays hit capsules, rotated boxes and planes, as
 * shaders/draw/backdrop/turned.glsl does in GL. */
#ifndef KILN_DRAW_BACKDROP_RAY_TURNED_H
#define KILN_DRAW_BACKDROP_RAY_TURNED_H

#include "draw/backdrop/ray_shapes.h"

/* ---- capsules -------------------------------------------------------------------------------- */

/* Returns the interval of two convex shapes whose union is convex. */
SIMD struct ray_interval either_interval(struct ray_interval a, struct ray_interval b)
{
    vi has_a = a.in <= a.out, has_b = b.in <= b.out;
    vf in = vf_min(vf_select(has_a, a.in, b.in), vf_select(has_b, b.in, a.in));
    vf out = vf_max(vf_select(has_a, a.out, b.out), vf_select(has_b, b.out, a.out));
    vi any_of_them = has_a | has_b;
    return (struct ray_interval){vf_select(any_of_them, in, vf_all(1.0f)),
                                 vf_select(any_of_them, out, vf_all(-1.0f))};
}

/* Returns the ball at an end of a capsule. */
SIMD float4 capsule_end(float4 capsule, float4 axis, float way)
{
    float far = axis.w * way;
    return (float4){capsule.x + axis.x * far, capsule.y + axis.y * far, capsule.z + axis.z * far,
                    capsule.w};
}

SIMD struct ray_interval cross_capsule(float4 capsule, float4 axis, const struct ray *ray)
{
    struct ray_interval low = cross_sphere(capsule_end(capsule, axis, -1.0f), ray);
    struct ray_interval high = cross_sphere(capsule_end(capsule, axis, 1.0f), ray);
    struct ray_interval barrel = cross_cylinder(capsule, axis, ray).interval;
    return either_interval(barrel, either_interval(low, high));
}

SIMD void trace_capsules(const struct kiln_ray_frame *frame, uint32_t capsules,
                         const struct ray *ray, struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; capsules; capsules &= capsules - 1) {
        int i = __builtin_ctz(capsules);
        float4 capsule = shapes->capsules[i], axis = shapes->capsule_axis[i];
        struct ray_interval at = cross_capsule(capsule, axis, ray);
        vi nearer = (at.in <= at.out) & (at.in > 0.0f) & (at.in < nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 from = vf3_sub(ray_at(ray, at.in), vf3_all(capsule));
        vf height = vf_clamp(vf3_dot_all(from, axis), -axis.w, axis.w);
        keep_nearer(nearest, nearer, at.in, vf_all((float)(RAY_CAPSULES + i)),
                    vf3_normalize(vf3_along(from, vf3_all(axis), -height)),
                    shapes->capsule_color[i]);
    }
}

/* ---- boxes of any direction ------------------------------------------------------------------ */

/* Transform a direction from the world to the frame of a box, and back. */
SIMD struct vf3 into_box(const struct kiln_draw_turned_box *box, struct vf3 v)
{
    return (struct vf3){vf3_dot_all(v, box->rows[0]), vf3_dot_all(v, box->rows[1]),
                        vf3_dot_all(v, box->rows[2])};
}

SIMD struct vf3 out_of_box(const struct kiln_draw_turned_box *box, struct vf3 v)
{
    const float4 *rows = box->rows;
    return (struct vf3){v.x * rows[0].x + v.y * rows[1].x + v.z * rows[2].x,
                        v.x * rows[0].y + v.y * rows[1].y + v.z * rows[2].y,
                        v.x * rows[0].z + v.y * rows[1].z + v.z * rows[2].z};
}

/* Intersects the slabs of a rotated box. inverse: of the ray's direction in the box's frame. */
SIMD struct ray_slabs cross_turned(const struct kiln_draw_turned_box *box, struct vf3 origin,
                                   struct vf3 inverse)
{
    const float4 middle = {0.0f, 0.0f, 0.0f, 0.0f};
    struct vf3 from = into_box(box, vf3_sub(origin, vf3_all(box->center)));
    return cross_slabs(middle, box->half_size, from, inverse);
}

SIMD void trace_turned(const struct kiln_ray_frame *frame, uint32_t boxes, const struct ray *ray,
                       struct ray_hit *nearest)
{
    for (; boxes; boxes &= boxes - 1) {
        int i = __builtin_ctz(boxes);
        const struct kiln_draw_turned_box *box = &frame->shapes->turned[i];
        struct vf3 inverse = safe_inverse(into_box(box, ray->direction));
        struct ray_slabs s = cross_turned(box, ray->origin, inverse);
        struct ray_interval at = slabs_interval(&s);
        vi nearer = (at.in <= at.out) & (at.in > 0.0f) & (at.in < nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 normal = slabs_normal(&s, inverse);
        vf face = normal.x + 3.0f * normal.y + 9.0f * normal.z;
        keep_nearer(nearest, nearer, at.in, face + (float)(RAY_TURNED + 14 + 27 * i),
                    out_of_box(box, normal), box->color);
    }
}

/* ---- planes ---------------------------------------------------------------------------------- */

SIMD void trace_planes(const struct kiln_ray_frame *frame, uint32_t planes, const struct ray *ray,
                       struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; planes; planes &= planes - 1) {
        int i = __builtin_ctz(planes);
        const float4 plane = shapes->planes[i];
        vf height = vf3_dot_all(ray->origin, plane) - plane.w;
        vf climb = vf3_dot_all(ray->direction, plane);
        vi falls = (climb < -1e-6f) & (height > 0.0f);
        vf t = height / -vf_select(falls, climb, vf_all(-1.0f));
        vi nearer = falls & (t < nearest->t);
        if (any(nearer))
            keep_nearer(nearest, nearer, t, vf_all((float)(RAY_PLANES + i)), vf3_all(plane),
                        shapes->plane_color[i]);
    }
}

#endif
