/* This header declares the levels of shadow maps of meshes on the host: each has half the edge of
 * the one before, down to one texel, and holds means of four texels. */
#ifndef KILN_DRAW_LIGHT_SHADOW_LEVELS_H
#define KILN_DRAW_LIGHT_SHADOW_LEVELS_H

#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"

/* A texel: the lower 16 bits are the part of it that meshes cover, the upper 16 bits that part
 * times their mean distance, both in units of 1 / KILN_SHADOW_ONE. The distance is 0 nearest to the
 * light and 1 farthest from it. */
enum { KILN_SHADOW_ONE = 65535 };

/* Returns where a level starts, in texels. edge: of the first level, a power of two. */
static inline size_t kiln_shadow_level_start(size_t edge, uint32_t level)
{
    const size_t whole = 4 * edge * edge, rest = whole >> (2 * level);
    return (whole - rest) / 3;
}

/* Returns the texel of a place that a mesh covers at a distance, 0 to 1. */
static inline uint32_t kiln_shadow_texel(float distance)
{
    return (uint32_t)(distance * (float)KILN_SHADOW_ONE + 0.5f) << 16 | KILN_SHADOW_ONE;
}

/* Fills rows of a level from the level before it. */
void kiln_shadow_shrink(uint32_t *texels, size_t edge, uint32_t level, size_t begin, size_t end);

#endif
