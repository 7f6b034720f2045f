/* The tile of the CPU rasteriser for x86-64 with AVX2. */
#ifdef __x86_64__
#define KILN_SIMD_LEVEL 2
#define TILE_DRAW       kiln_tile_draw_avx2
#include "draw/tile_draw.h"
#endif
