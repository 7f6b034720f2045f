/* This file compiles the CPU rasteriser's drawing of tiles (tile_draw.h) for one level of vectors.
 * Tests compare the other levels with `plain`. */
#include "base/simd.h"

#define TILE_DRAW KILN_SIMD_NAME(kiln_tile_draw)
#include "draw/sprites/tile_draw.h"
