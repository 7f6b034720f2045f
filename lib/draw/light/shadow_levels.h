/* This header declares the levels of shadow maps of meshes on the host: each has half the edge of
 * the one before, down to one texel, and holds means of four texels. All levels of a map lie in one
 * array of rows: the finest on the left, the others below each other on its right. An empty row or
 * column lies between any two of them and around them, so that a fetch between four texels needs
 * no test for a level's border. The array has an entry for each texel: its words, then those of the
 * texel below. So two neighbouring entries hold the four texels of a fetch. */
#ifndef KILN_DRAW_LIGHT_SHADOW_LEVELS_H
#define KILN_DRAW_LIGHT_SHADOW_LEVELS_H

#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"
#include "shared/exact.h"

/* A texel: the lower 16 bits are the part of it that meshes cover, the upper 16 bits that part
 * times their mean distance, both in units of 1 / KILN_SHADOW_ONE. The distance is 0 nearest to the
 * light and 1 farthest from it. */
enum { KILN_SHADOW_ONE = 65535 };

enum { KILN_SHADOW_PAIR = 2 /* texels of an entry */ };

/* KILN_SHADOW_PITCH gives the entries of a row of all levels, KILN_SHADOW_MAP_ENTRIES those of the
 * whole array. edge: of the finest level, texels, a power of two. The empty column on the right of
 * a row is the one on the left of the next row. */
#define KILN_SHADOW_PITCH(edge)               ((edge) + (edge) / 2 + 2)
#define KILN_SHADOW_MAP_ENTRIES(edge, levels) (KILN_SHADOW_PITCH(edge) * ((edge) + (levels) + 1))

/* These give the row and the column of the first texel of a level that is not the finest. The first
 * texel of the finest level is in row 1 and column 1. width: the edge of the level, texels. */
#define KILN_SHADOW_COARSE_ROW(edge, level, width) ((edge)-2 * (width) + (level))
#define KILN_SHADOW_COARSE_COLUMN(edge)            ((edge) + 2)

/* Returns where the first texel of a level is, in entries. */
static inline size_t kiln_shadow_level_start(size_t edge, uint32_t level)
{
    const size_t row = level ? KILN_SHADOW_COARSE_ROW(edge, level, edge >> level) : 1;
    const size_t column = level ? KILN_SHADOW_COARSE_COLUMN(edge) : 1;
    return row * KILN_SHADOW_PITCH(edge) + column;
}

/* Returns the texel of a place that a mesh covers at a distance, 0 to 1. */
static inline uint32_t kiln_shadow_texel(float distance)
{
    return exact_uint(distance * (float)KILN_SHADOW_ONE + 0.5f) << 16 | KILN_SHADOW_ONE;
}

/* Stores a texel of `words` words into its own entry and into that of the texel above. Threads may
 * store texels of different rows at once, while no thread reads their level. pitch: of the array,
 * entries. */
static inline void kiln_shadow_store(uint32_t *entry, size_t pitch, const uint32_t *texel,
                                     size_t words)
{
    uint32_t *above = entry - KILN_SHADOW_PAIR * words * pitch;
    for (size_t i = 0; i < words; i++) {
        entry[i] = texel[i];
        above[words + i] = texel[i];
    }
}

/* Makes row y of a level of texels of two words from the level before it: each half of a word is
 * the mean of four texels. */
void kiln_shadow_shrink_row(uint32_t *entries, size_t edge, uint32_t level, size_t y);

/* Describes a row of texels of a level. All texels that are not empty lie in the columns from
 * `from` to one before `to`; all that the last drawing may have changed lie in those of
 * changed_from and changed_to, so that others need not be written. No column is meant where the end
 * is not above the start. A map has one for each row of each level; zeros stand for an empty map.
 * The edge of the finest level is below 2^16. */
struct kiln_shadow_span {
    uint16_t from, to;
    uint16_t changed_from, changed_to;
};

/* Returns where the spans of a level start among the 2 * edge spans of a map. */
static inline size_t kiln_shadow_spans_start(size_t edge, uint32_t level)
{
    return 2 * edge - 2 * (edge >> level);
}

/* Brings the span of a row of the finest level up to date. nearness: of what covers each texel now,
 * 0 for nothing. The caller then stores the texels that may have changed. */
void kiln_shadow_update_span(struct kiln_shadow_span *span, const float *nearness, size_t edge);

/* Makes the rows from `begin` to one before `end` of a level, and their spans, where the level
 * before it changed; that level must be complete. Texels have one word, of which each half becomes
 * the mean of four texels. Threads may make different rows at once. spans: of all levels. */
void kiln_shadow_shrink(uint32_t *entries, struct kiln_shadow_span *spans, size_t edge,
                        uint32_t level, size_t begin, size_t end);

/* Copies the texels of a level, row by row and without those below them, to `texels`. */
void kiln_shadow_unpair(const uint32_t *entries, size_t edge, size_t words, uint32_t level,
                        uint32_t *texels);

#endif
