/* The tile of the CPU rasteriser for any machine: what the others are tested against. */
#define KILN_SIMD_LEVEL 0
#define TILE_DRAW       kiln_tile_draw_plain
#include "draw/tile_draw.h"
