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

/* seen_shapes: as of the receiver; apart from it, so that the compiler makes two loops. */
SIMD void hide_by_each(const struct kiln_draw_shapes *shapes, uint32_t first, uint32_t casters,
                       const struct kiln_shape_seen *seen_shapes, struct light_receiver *receiver)
{
    struct light_receiver r = *receiver;
    for (; casters && any(r.active); casters &= casters - 1) {
        const uint32_t i = first + (uint32_t)__builtin_ctz(casters);
        const struct kiln_draw_shape *shape = &shapes->shapes[i];
        const struct vf3 towards = vf3_towards(shape->center, r.origin);
        vi near = r.active & light_meets_sphere(r.way, towards, shape->center.w);
        if (!any(near))
            continue;
        switch (shape->kind.x) {
#define HIDE(KIND, name)                                                                           \
    case SHAPE_##KIND: {                                                                           \
        struct name##_seen seen;                                                                   \
        if (seen_shapes)                                                                           \
            broadcast(&seen_shapes[i], (vf *)&seen, sizeof seen / sizeof(vf));                     \
        else                                                                                       \
            seen = name##_seen_along(*shape, r.way.direction);                                     \
        near &= name##_may_hide(*shape, seen, towards, r.way);                                     \
        if (any(near))                                                                             \
            hide_light(&r, near,                                                                   \
                       light_hidden(r.way, name##_cover(*shape, seen, towards, r.way, near)));     \
        break;                                                                                     \
    }
            KILN_SHAPES(HIDE)
#undef HIDE
        }
    }
    receiver->active = r.active;
    receiver->visible = r.visible;
}

void KILN_SIMD_NAME(kiln_shapes_hide)(const struct kiln_draw_shapes *shapes, uint32_t first,
                                      uint32_t casters, struct light_receiver *receiver)
{
    if (receiver->seen)
        hide_by_each(shapes, first, casters, receiver->seen, receiver);
    else
        hide_by_each(shapes, first, casters, NULL, receiver);
}
