/* This header finds the nearest capsule, oriented box or plane that vectors of rays hit. */
#ifndef KILN_DRAW_BACKDROP_RAY_ORIENTED_H
#define KILN_DRAW_BACKDROP_RAY_ORIENTED_H

#include "draw/backdrop/ray_shapes.h"
#include "draw/light/ray_lamp.h"

/* ---- capsules -------------------------------------------------------------------------------- */

SIMD void trace_capsules(const struct kiln_ray_frame *frame, uint32_t capsules,
                         const struct ray *ray, struct ray_hit *nearest)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    for (; capsules; capsules &= capsules - 1) {
        int i = __builtin_ctz(capsules);
        float4 capsule = shapes->capsules[i], axis = shapes->capsule_axis[i];
        struct ray_interval at = ray_cross_capsule(capsule, axis, ray->origin, ray->direction);
        vi nearer = ray_meets(at, nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 from = vf3_sub(ray_at(ray, at.near), vf3_all(capsule));
        vf height = vf_clamp(vf3_dot_all(from, axis), -axis.w, axis.w);
        keep_nearer(nearest, nearer, at.near, vf_all((float)(KILN_SURFACE_CAPSULES + i)),
                    vf3_normalize(vf3_add_scaled(from, vf3_all(axis), -height)),
                    shapes->capsule_color[i]);
    }
}

/* ---- oriented boxes ------------------------------------------------------------------------- */

/* Rotates a direction from the frame of a box to the world, against into_box. */
SIMD struct vf3 out_of_box(const struct kiln_draw_oriented_box *box, struct vf3 v)
{
    const float4 *rows = box->rows;
    return (struct vf3){v.x * rows[0].x + v.y * rows[1].x + v.z * rows[2].x,
                        v.x * rows[0].y + v.y * rows[1].y + v.z * rows[2].y,
                        v.x * rows[0].z + v.y * rows[1].z + v.z * rows[2].z};
}

/* Intersects the slabs of a oriented box. inverse: ray_inverse3 of the ray's direction in the box's
 * frame. */
SIMD struct ray_slabs cross_oriented_box(const struct kiln_draw_oriented_box *box,
                                         struct vf3 origin, struct vf3 inverse)
{
    return ray_cross_slabs(into_box(box, vf3_towards(box->center, origin)), box->half_size,
                           inverse);
}

SIMD void trace_oriented_boxes(const struct kiln_ray_frame *frame, uint32_t boxes,
                               const struct ray *ray, struct ray_hit *nearest)
{
    for (; boxes; boxes &= boxes - 1) {
        int i = __builtin_ctz(boxes);
        const struct kiln_draw_oriented_box *box = &frame->shapes->oriented_boxes[i];
        struct vf3 inverse = ray_inverse3(into_box(box, ray->direction));
        struct ray_slabs s = cross_oriented_box(box, ray->origin, inverse);
        struct ray_interval at = ray_slabs_interval(s);
        vi nearer = ray_meets(at, nearest->t);
        if (!any(nearer))
            continue;
        struct vf3 normal = ray_slabs_normal(s, inverse);
        vf face = ray_face_number(normal) + (float)KILN_SURFACE_BOX(KILN_SURFACE_ORIENTED, i);
        keep_nearer(nearest, nearer, at.near, face, out_of_box(box, normal), box->color);
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
        vf t = ray_cross_plane(height, vf3_dot_all(ray->direction, plane));
        vi nearer = t < nearest->t;
        if (any(nearer))
            keep_nearer(nearest, nearer, t, vf_all((float)(KILN_SURFACE_PLANES + i)),
                        vf3_all(plane), shapes->plane_color[i]);
    }
}

#endif
