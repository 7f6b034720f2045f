/* This header declares how much of a light the backdrop's shapes hide from vectors of points or of
 * balls. It is code of its own for each level of vectors (shapes_hide_simd.c), since surfaces,
 * solid particles and billboards ask it, for the sun and for lamps. */
#ifndef KILN_DRAW_LIGHT_SHAPES_HIDE_H
#define KILN_DRAW_LIGHT_SHAPES_HIDE_H

#include "base/real.h"
#include "base/simd.h"
#include "draw/moment/shapes_seen.h"
#include "shared/light_cover.h"
#include "shared/shape_layout.h"

/* Points or balls that see a light, in the lanes where it is not yet hidden. */
struct light_receiver {
    struct vf3 origin;
    struct light_way way;
    const struct kiln_shape_seen *seen; /* of each shape if `way` has one direction, else NULL */
    vi active;
    vf visible; /* part of the light, so far */
    vf blur;    /* width of the narrowest filter that read a map, m; lamps only */
};

/* Hides a part of a light in the lanes of a mask. Lanes that no longer see the light drop out. An
 * object that hides nothing from a lane multiplies the lane's light by exactly 1, so that it does
 * not matter which lanes share a vector. */
SIMD void hide_light(struct light_receiver *r, vi near, vf cover)
{
    r->visible *= 1.0f - vf_where(near, cover);
    r->active &= r->visible > 0.0f;
}

void KILN_SIMD_NAME(kiln_shapes_hide)(const struct kiln_draw_shapes *shapes, uint32_t casters,
                                      struct light_receiver *receiver);

/* Hides a light by shapes. casters: a bit for each shape that may hide it. */
SIMD void hide_by_shapes(const struct kiln_draw_shapes *shapes, uint32_t casters,
                         struct light_receiver *receiver)
{
    if (casters)
        KILN_SIMD_NAME(kiln_shapes_hide)(shapes, casters, receiver);
}

#endif
