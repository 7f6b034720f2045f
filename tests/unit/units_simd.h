/* The listing of a sprite's units (lib/draw/sprites/tile_rows.h), in a file compiled for each level
 * of vectors. */
#ifndef KILN_TESTS_UNITS_SIMD_H
#define KILN_TESTS_UNITS_SIMD_H

#include "base/simd.h"
#include "draw/sprites/tile.h"

enum {
    UNITS_A_ROW = KILN_TILE_WIDTH / 8,
    UNITS_MOST = UNITS_A_ROW * KILN_TILE_HEIGHT + 32, /* with room that may be written */
};

/* Holds the spans of a sprite in some rows of a tile, from `top` on. */
struct units_spans {
    int top, rows;
    int32_t from[KILN_TILE_HEIGHT], units[KILN_TILE_HEIGHT]; /* first column; number of units */
    float u[KILN_TILE_HEIGHT], v[KILN_TILE_HEIGHT], q[KILN_TILE_HEIGHT]; /* at the first column */
    float steps[3]; /* changes of u, v and q a column */
    int x_from, x_to;
    bool deep;
};

struct units_listed {
    int count;
    int32_t at[UNITS_MOST];
    float u[UNITS_MOST], v[UNITS_MOST], q[UNITS_MOST];
};

typedef void units_list(const struct kiln_tile *tile, const struct units_spans *spans,
                        struct units_listed *listed);

KILN_SIMD_DECLARE(units_list, units_list);

#endif
