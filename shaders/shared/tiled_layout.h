/* Declares what host and kernels of the technique `tiled` share. The host also defines TILED_EDGE,
 * the edge of a tile in pixels. */
#ifndef KILN_SHARED_TILED_LAYOUT_H
#define KILN_SHARED_TILED_LAYOUT_H

#include "shared/platform.h"

/* Storage blocks, besides KILN_BIND_RECORDS and KILN_BIND_ENTRIES. Blocks of one number belong to
 * different kernels. */
#define TILED_BIND_BOXES     2
#define TILED_BIND_SPRITES   3
#define TILED_BIND_BIN_MASKS 4 /* for each bin, a bit for each sprite of a chunk */
#define TILED_BIND_FARTHEST  4 /* depth of the scene in each tile, m: bits of a float */
#define TILED_BIND_CARRY     4 /* pixels between two chunks of sprites */
#define TILED_BIND_COUNTS    5 /* number of sprites in each bin */
#define TILED_BIND_BINS      5
#define TILED_BIND_LISTS     6 /* lists of sprites: bins start at multiples of TILED_PIECE */
#define TILED_BIND_MASKS     7 /* for each bin, by tile, a bit for each sprite of its list */

/* Images; texture units of the sprites and of the glow of an earlier pass. */
#define TILED_IMAGE_COLOR  0
#define TILED_IMAGE_BLOOM  1
#define TILED_UNIT_SPRITES 11
#define TILED_UNIT_BEFORE  12

/* Locations of uniforms. A kernel has some of them. */
#define TILED_AT_COUNT          0
#define TILED_AT_FIRST          1
#define TILED_AT_ADDITIVE_ALPHA 2
#define TILED_AT_BIN_COLUMNS    3
#define TILED_AT_MASK_WORDS     4
#define TILED_AT_PIECES         5
#define TILED_AT_BIN_COUNT      6
#define TILED_AT_TILE_COLUMNS   7
#define TILED_AT_FIRST_LAST_RUN 8
#define TILED_AT_KEEP_GLOW      9
#define TILED_AT_OCCLUDES       10
#define TILED_AT_MIN_LIGHT      11
#define TILED_AT_SPAN           12

/* Invocations of a work group, unless another size is given. */
#ifndef TILED_GROUP_SIZE
#define TILED_GROUP_SIZE 256
#endif

/* Tiles along the edge of a bin, and in a bin. */
#define TILED_BIN_TILES 8
#define TILED_TILES     (TILED_BIN_TILES * TILED_BIN_TILES)

/* Sprites of a list that one work group marks in the tiles; two bins never share a piece. */
#define TILED_PIECE 64

/* Words of a tile's mask, of 32 sprites each, that a work group processes at once. */
#define TILED_ROUND_WORDS 32

/* A bin, a square of 8 x 8 tiles: its list, and bounds of what a sprite of it can add to a
 * pixel. */
struct tiled_bin {
    uint first, count;   /* range of the list in all lists */
    uint additive_count; /* number of its sprites that cover nothing */
    /* most light that a covering sprite adds, and one that does not cover; bits of floats */
    uint covering_max, additive_max;
};

/* Rows of float4 of a sprite (shaders/draw/sprites/tiled.glsl). */
#define TILED_SPRITE_ROWS 14

/* Bytes of a pixel between two chunks. */
#define TILED_CARRY_BYTES 32

#endif
