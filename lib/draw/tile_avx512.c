/* The tile of the CPU rasteriser for x86-64 with AVX-512 F, BW, DQ and VL. */
#ifdef __x86_64__
#define KILN_SIMD_LEVEL 3
#define TILE_DRAW       kiln_tile_draw_avx512
#include "draw/tile_draw.h"
#endif
