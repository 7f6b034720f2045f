/* The tile of the CPU rasteriser for x86-64 with SSE4.1. */
#ifdef __x86_64__
#define KILN_SIMD_LEVEL 1
#define TILE_DRAW       kiln_tile_draw_sse41
#include "draw/tile_draw.h"
#endif
