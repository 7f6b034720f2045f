/* What host and kernels of the technique `tiled` share. The host also defines TILED_EDGE, the edge
 * of a tile in pixels. */
#ifndef KILN_SHARED_TILED_LAYOUT_H
#define KILN_SHARED_TILED_LAYOUT_H

#include "shared/platform.h"

/* Storage blocks, besides KILN_BIND_RECORDS and KILN_BIND_ENTRIES. Those of one number are of
 * kernels that do not meet. */
#define TILED_BIND_BOXES     2
#define TILED_BIND_SPRITES   3
#define TILED_BIND_BIN_MASKS 4 /* by bin, a bit for each sprite of a chunk */
#define TILED_BIND_FARTHEST  4 /* depth of the scene in each tile, m: bits of a float */
#define TILED_BIND_CARRY     4 /* pixels between two chunks */
#define TILED_BIND_COUNTS    5 /* of sprites in each bin */
#define TILED_BIND_BINS      5
#define TILED_BIND_LISTS     6 /* of sprites: bins start at multiples of TILED_PIECE */
#define TILED_BIND_MASKS     7 /* for each bin, by tile, a bit for each sprite of its list */

/* Images; texture units of the sprites and of the glow of an earlier pass. */
#define TILED_IMAGE_COLOR  0
#define TILED_IMAGE_BLOOM  1
#define TILED_UNIT_SPRITES 11
#define TILED_UNIT_BEFORE  12

/* Invocations of a work group, where nothing else is said. */
#ifndef TILED_GROUP_SIZE
#define TILED_GROUP_SIZE 256
#endif

/* Tiles along the edge of a bin, and in it. */
#define TILED_BIN_TILES 8
#define TILED_TILES     (TILED_BIN_TILES * TILED_BIN_TILES)

/* Sprites of a list that one work group marks in the tiles; no bin shares a piece with another. */
#define TILED_PIECE 64

/* Words of a tile's mask, of 32 sprites each, that its work group takes at a time. */
#define TILED_ROUND_WORDS 32

/* A square of 8 x 8 tiles: its list, and what that could add to a pixel. */
struct tiled_bin {
    uint first, count; /* in the lists */
    uint adding;       /* sprites of it that cover nothing */
    uint cover, add;   /* most that one that covers adds, or one that does not; bits of floats */
};

/* A sprite is so many float4 (shaders/draw/sprites/tiled.glsl). */
#define TILED_SPRITE_ROWS 14

/* A pixel between two chunks. */
#define TILED_CARRY_BYTES 32

#endif
