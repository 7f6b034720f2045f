/* Sprites: particles brought to the picture. The places of a sprite's texture are linear in those of
 * the picture; or, where it is not parallel to it, become so when they are divided by its depth.
 */
#include "shared/tiled_layout.h"

#include "draw/sprites/billboard.glsl"

#define TILED_BIN_EDGE uint(TILED_EDGE * TILED_BIN_TILES)

/* Rows of a sprite. */
#define SPRITE_U 0    /* 0..1 over the texture, of points and lines px from the middle: at the anchor, */
#define SPRITE_V 1    /* and its change per pixel right and down; w: the anchor, px from the top left */
#define SPRITE_Q 2    /* likewise, one over the depth; of SHAPES only */
#define SPRITE_MOST 3 /* half edges of a point or line with its soft rim, px, or 0; least depth, m; */
                      /* most that it adds to a channel, negative if it covers nothing */
#define SPRITE_QUAD 4 /* the billboard, ten rows */

/* The squares of the picture that a sprite may touch, as tiles or bins of an edge: the first and the
 * last. */
uvec4 squares_of(uvec2 box, uint edge)
{
    uvec2 from = uvec2(box.x & 0xffffu, box.x >> 16), to = uvec2(box.y & 0xffffu, box.y >> 16);
    return uvec4(from / edge, (to - 1u) / edge);
}

/* Of a bin's masks: bit i of the word is of sprite 32 * word + i of the list. */
uint mask_word(tiled_bin bin, uint tile, uint word)
{
    uint words = (bin.count + uint(TILED_PIECE) - 1u) / uint(TILED_PIECE) * uint(TILED_PIECE / 32);
    return bin.first * uint(TILED_TILES / 32) + tile * words + word;
}
