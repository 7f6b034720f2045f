/* The tile of the CPU rasteriser; `plain` is what the other levels are tested against. */
#include "base/simd.h"

#define TILE_DRAW KILN_SIMD_NAME(kiln_tile_draw)
#include "draw/sprites/tile_draw.h"
