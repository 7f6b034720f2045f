/* Declares the layout of sprites, and of the masks of tiles, for the kernels of technique `tiled`.
 * A sprite is a particle that is projected into the picture. Its texture coordinates are linear
 * functions of the pixel; where the particle is not parallel to the picture, the coordinates
 * divided by the depth are linear.
 *
 * particles_tiled_make.comp writes sprites, particles_tiled_mark.comp and particles_tiled.comp read
 * them, and the latter two share the masks. The host sizes the buffers by shared/tiled_layout.h. A
 * change of the number of rows must be made in TILED_SPRITE_ROWS there, and in fetch_quad and write
 * of the kernels. The rows u, v and q are those of place.glsl. */
#include "shared/tiled_layout.h"

#include "draw/sprites/billboard.glsl"

#define TILED_BIN_EDGE uint(TILED_EDGE * TILED_BIN_TILES)

/* Rows of a sprite, each a vec4. */
#define SPRITE_U 0    /* `u`, `v` and `q` of struct place */
#define SPRITE_V 1
#define SPRITE_Q 2    /* undefined without SHAPES */
#define SPRITE_BOUNDS 3 /* x, y: `edge` of struct place; z: the least depth, m; w: the most light */
                        /* that the sprite adds to a channel, negative if it covers nothing */
#define SPRITE_QUAD 4 /* the billboard, ten rows */

/* Returns the squares of the picture, which are tiles or bins with an edge of so many pixels, that
 * a sprite's box touches: column and row of the first, then of the last one. A box has left and
 * top, then right and bottom, with 16 bits each; it must not be empty. */
uvec4 squares_of(uvec2 box, uint edge)
{
    uvec2 from = uvec2(box.x & 0xffffu, box.x >> 16), to = uvec2(box.y & 0xffffu, box.y >> 16);
    return uvec4(from / edge, (to - 1u) / edge);
}

/* Returns where in all masks a word of a tile's mask is. Bit i of word k stands for sprite 32 * k +
 * i of the bin's list. The masks of a bin have whole pieces of the list, since a work group of
 * particles_tiled_mark.comp writes a piece. */
uint mask_word(tiled_bin bin, uint tile, uint word)
{
    uint words = (bin.count + uint(TILED_PIECE) - 1u) / uint(TILED_PIECE) * uint(TILED_PIECE / 32);
    return bin.first * uint(TILED_TILES / 32) + tile * words + word;
}
