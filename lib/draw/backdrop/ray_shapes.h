/* This header finds the nearest shape that vectors of rays hit. */
#ifndef KILN_DRAW_BACKDROP_RAY_SHAPES_H
#define KILN_DRAW_BACKDROP_RAY_SHAPES_H

#include "base/real.h"
#include "draw/backdrop/ray.h"
#include "shared/shapes.h"

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

/* shapes: those that the rays may hit. */
SIMD void trace_shapes(const struct kiln_ray_frame *frame, const struct kiln_shape_set *shapes,
                       const struct ray *ray, struct ray_hit *nearest)
{
    const struct shape_ray all = shape_ray_of(ray->origin, ray->direction);
    struct kiln_shape_walk walk = kiln_shape_walk_begin(shapes);
    while (kiln_shape_walk_next(&walk)) {
        const int i = (int)walk.shape;
        const struct kiln_draw_shape *shape = &frame->shapes->shapes[i];
        switch (shape->kind.x) {
#define TRACE(KIND, name)                                                                          \
    case SHAPE_##KIND: {                                                                           \
        const struct ray_interval at = name##_cross(*shape, all);                                  \
        const vi nearer = ray_meets(at, nearest->t);                                               \
        if (!any(nearer))                                                                          \
            break;                                                                                 \
        const struct shape_face face = name##_face(*shape, all, at.near);                          \
        keep_nearer(nearest, nearer, at.near, face.number + (float)KILN_SURFACE_SHAPE(i),          \
                    face.normal, shape->color);                                                    \
        break;                                                                                     \
    }
            KILN_SHAPES(TRACE)
#undef TRACE
        }
    }
}

#endif
