/* This file compiles the tile drawing of the CPU rasteriser for one level of vectors. The other
 * levels are tested against `plain`. */
#include "base/simd.h"

#define TILE_DRAW KILN_SIMD_NAME(kiln_tile_draw)
#include "draw/sprites/tile_draw.h"
