/* This header declares how much of a light the backdrop's shapes hide from vectors of points or of
 * balls. It is code of its own for each level of vectors (shapes_hide_simd.c), since surfaces,
 * solid particles and billboards ask it, for the sun and for lamps. */
#ifndef KILN_DRAW_LIGHT_SHAPES_HIDE_H
#define KILN_DRAW_LIGHT_SHAPES_HIDE_H

#include "base/real.h"
#include "base/simd.h"
#include "draw/moment/shape_set.h"
#include "draw/moment/shapes_seen.h"
#include "shared/light_cover.h"
#include "shared/shape_layout.h"

/* Points or balls that see a light, in the lanes where it is not yet hidden. */
struct light_receiver {
    struct vf3 origin;
    struct light_way way;
    const struct kiln_shape_seen *seen; /* of each shape if `way` has one direction, else NULL */
    bool blocked; /* the light has no size, and points are lit: rays to it are blocked or not */
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

/* Hides a light by those of 32 shapes from `first` on whose bits are set in `casters`. */
void KILN_SIMD_NAME(kiln_shapes_hide)(const struct kiln_draw_shapes *shapes, uint32_t first,
                                      uint32_t casters, struct light_receiver *receiver);

/* Hides a light by shapes. casters: those that may hide it. */
SIMD void hide_by_shapes(const struct kiln_draw_shapes *shapes,
                         const struct kiln_shape_set *casters, struct light_receiver *receiver)
{
    for (uint32_t i = 0; i < casters->count; i++) {
        if (casters->words[i])
            KILN_SIMD_NAME(kiln_shapes_hide)(shapes, 32 * i, casters->words[i], receiver);
    }
}

#endif
