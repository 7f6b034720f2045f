/* This file computes what shapes hide of a light. Most shapes are far from most ways to a light,
 * and are found to be so by their bounding sphere; others are by a closer test of their kind. */
#include "draw/light/shapes_hide.h"
#include "shared/shapes.h"

/* Makes vectors of numbers that all lanes share. */
SIMD void broadcast(const struct kiln_shape_seen *seen, vf *to, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] = vf_all(seen->numbers[i]);
}

/* Hides a light by a shape of one kind, in the lanes of a mask. from_all: the shape as seen from
 * all lanes, or NULL if they see the light in directions of their own. */
#define HIDE_BY(KIND, name)                                                                        \
    SIMD void hide_by_##name(const struct kiln_draw_shape *shape,                                  \
                             const struct kiln_shape_seen *from_all, struct vf3 towards, vi near,  \
                             struct light_receiver *r)                                             \
    {                                                                                              \
        struct name##_seen seen;                                                                   \
        if (from_all)                                                                              \
            broadcast(from_all, (vf *)&seen, sizeof seen / sizeof(vf));                            \
        else                                                                                       \
            seen = name##_seen_along(*shape, r->way.direction);                                    \
        near &= name##_may_hide(*shape, seen, towards, r->way);                                    \
        if (any(near))                                                                             \
            hide_light(r, near,                                                                    \
                       light_hidden(r->way, name##_cover(*shape, seen, towards, r->way, near)));   \
    }
KILN_SHAPES(HIDE_BY)
#undef HIDE_BY

/* from_all: as `seen` of the receiver; apart from it, so that the compiler makes two loops. */
SIMD void hide_by_each(const struct kiln_draw_shapes *shapes, uint32_t first, uint32_t casters,
                       const struct kiln_shape_seen *from_all, struct light_receiver *receiver)
{
    struct light_receiver r = *receiver;
    for (; casters && any(r.active); casters &= casters - 1) {
        const uint32_t i = first + (uint32_t)__builtin_ctz(casters);
        const struct kiln_draw_shape *shape = &shapes->shapes[i];
        const struct vf3 towards = vf3_towards(shape->center, r.origin);
        const vi near = r.active & light_meets_sphere(r.way, towards, shape->center.w);
        if (!any(near))
            continue;
        switch (shape->kind.x) {
#define HIDE(KIND, name)                                                                           \
    case SHAPE_##KIND:                                                                             \
        hide_by_##name(shape, from_all ? &from_all[i] : NULL, towards, near, &r);                  \
        break;
            KILN_SHAPES(HIDE)
#undef HIDE
        }
    }
    receiver->active = r.active;
    receiver->visible = r.visible;
}

/* Returns the lanes where a shape blocks rays to a light without size. */
SIMD vi blocks(const struct kiln_draw_shape *shape, const struct shape_ray *ray)
{
    struct ray_interval at = ray_interval_of(vf_all(1.0f), vf_all(-1.0f));
    switch (shape->kind.x) {
#define CROSS(KIND, name)                                                                          \
    case SHAPE_##KIND:                                                                             \
        at = name##_cross(*shape, *ray);                                                           \
        break;
        KILN_SHAPES(CROSS)
#undef CROSS
    }
    return vf_max(at.near, vf_all(0.0f)) < at.far;
}

/* Hides a light without size, to which rays are blocked or not. */
SIMD void block_by_each(const struct kiln_draw_shapes *shapes, uint32_t first, uint32_t casters,
                        struct light_receiver *receiver)
{
    struct light_receiver r = *receiver;
    const struct shape_ray ray = shape_ray_of(r.origin, r.way.direction);
    for (; casters && any(r.active); casters &= casters - 1) {
        const struct kiln_draw_shape *shape =
            &shapes->shapes[first + (uint32_t)__builtin_ctz(casters)];
        const struct vf3 towards = vf3_towards(shape->center, r.origin);
        const vi near = r.active & light_meets_sphere(r.way, towards, shape->center.w);
        if (any(near))
            hide_light(&r, near & blocks(shape, &ray), vf_all(1.0f));
    }
    receiver->active = r.active;
    receiver->visible = r.visible;
}

void KILN_SIMD_NAME(kiln_shapes_hide)(const struct kiln_draw_shapes *shapes, uint32_t first,
                                      uint32_t casters, struct light_receiver *receiver)
{
    if (receiver->blocked)
        block_by_each(shapes, first, casters, receiver);
    else if (receiver->seen)
        hide_by_each(shapes, first, casters, receiver->seen, receiver);
    else
        hide_by_each(shapes, first, casters, NULL, receiver);
}
