/* This header declares the levels of shadow maps of meshes on the host: each has half the edge of
 * the one before, down to one texel, and holds means of four texels. All levels of a map lie in one
 * array of rows: the finest on the left, the others below each other on its right. An empty row or
 * column lies between any two of them and around them, so that a fetch between four texels needs
 * no test for a level's border. */
#ifndef KILN_DRAW_LIGHT_SHADOW_LEVELS_H
#define KILN_DRAW_LIGHT_SHADOW_LEVELS_H

#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"

/* A texel: the lower 16 bits are the part of it that meshes cover, the upper 16 bits that part
 * times their mean distance, both in units of 1 / KILN_SHADOW_ONE. The distance is 0 nearest to the
 * light and 1 farthest from it. */
enum { KILN_SHADOW_ONE = 65535 };

/* KILN_SHADOW_PITCH gives the texels of a row of all levels, KILN_SHADOW_MAP_TEXELS those of the
 * whole array. edge: of the finest level, texels, a power of two. The empty column on the right of
 * a row is the one on the left of the next row. */
#define KILN_SHADOW_PITCH(edge)              ((edge) + (edge) / 2 + 2)
#define KILN_SHADOW_MAP_TEXELS(edge, levels) (KILN_SHADOW_PITCH(edge) * ((edge) + (levels) + 1))

/* These give the row and the column of the first texel of a level that is not the finest. The first
 * texel of the finest level is in row 1 and column 1. width: the edge of the level, texels. */
#define KILN_SHADOW_COARSE_ROW(edge, level, width) ((edge)-2 * (width) + (level))
#define KILN_SHADOW_COARSE_COLUMN(edge)            ((edge) + 2)

/* Returns where the first texel of a level is, in texels. */
static inline size_t kiln_shadow_level_start(size_t edge, uint32_t level)
{
    const size_t row = level ? KILN_SHADOW_COARSE_ROW(edge, level, edge >> level) : 1;
    const size_t column = level ? KILN_SHADOW_COARSE_COLUMN(edge) : 1;
    return row * KILN_SHADOW_PITCH(edge) + column;
}

/* Returns the texel of a place that a mesh covers at a distance, 0 to 1. */
static inline uint32_t kiln_shadow_texel(float distance)
{
    return (uint32_t)(distance * (float)KILN_SHADOW_ONE + 0.5f) << 16 | KILN_SHADOW_ONE;
}

/* Fills rows of a level from the level before it. */
void kiln_shadow_shrink(uint32_t *texels, size_t edge, uint32_t level, size_t begin, size_t end);

#endif
