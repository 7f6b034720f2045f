/* Marks, for each sprite, the tiles in which it could be seen: those that it touches, unless it is
 * behind all of the scene there. Also gathers, for each bin, bounds of the light that its sprites
 * can add to a pixel. A tile is a square of TILED_EDGE pixels. A bin is a square of tiles, with a
 * list of the sprites that may touch it.
 *
 * lib/draw/sprites/particles_tiled.c runs it for raster=tiled, once for each chunk of sprites,
 * after particles_tiled_list.comp has made the lists. particles_tiled.comp then draws the marked
 * sprites, and stops in a tile when the bounds say that nothing more could be seen. A work group
 * takes a piece, TILED_PIECE sprites of one list: an invocation marks one sprite, and clears and
 * writes the marks of one tile, so TILED_PIECE and TILED_TILES must be equal.
 *
 * A mark that is not needed only costs time. Without a mark that is needed, or with a bound that is
 * too low, a part of the picture is missing. */
// variant: SHAPES=0 TILED_EDGE=16
// variant: SHAPES=1 TILED_EDGE=8
#include "shared/draw_layout.h"

#include "draw/sprites/tiled.glsl"

layout(local_size_x = TILED_PIECE) in;

layout(std430, binding = TILED_BIND_BOXES) readonly buffer box_block
{
    uvec2 boxes[]; /* pixels that each sprite may touch, as particles_tiled_make.comp writes them */
};

layout(std430, binding = TILED_BIND_SPRITES) readonly buffer sprite_block
{
    vec4 sprites[]; /* TILED_SPRITE_ROWS for each */
};

layout(std430, binding = TILED_BIND_FARTHEST) readonly buffer farthest_block
{
    uint farthest[]; /* floats: for each tile of the picture, the scene's greatest depth, m */
};

layout(std430, binding = TILED_BIND_BINS) buffer bin_block
{
    tiled_bin bins[];
};

layout(std430, binding = TILED_BIND_LISTS) readonly buffer list_block
{
    uint lists[]; /* numbers of sprites in the chunk, nearest first */
};

layout(std430, binding = TILED_BIND_MASKS) writeonly buffer mask_block
{
    uint masks[]; /* the marks, in the order that mask_word of tiled.glsl defines */
};

layout(location = TILED_AT_PIECES) uniform uint pieces; /* number of pieces of all lists */
layout(location = TILED_AT_BIN_COUNT) uniform uint bin_count;
layout(location = TILED_AT_BIN_COLUMNS) uniform uint bin_columns; /* bins in a row of the picture */
/* tiles in a row of the picture */
layout(location = TILED_AT_TILE_COLUMNS) uniform uint tile_columns;

const uint WORDS = uint(TILED_PIECE / 32);
shared uint marks[TILED_TILES * WORDS]; /* for each tile, a bit for each sprite of the piece */
/* Hold the members of a bin's struct tiled_bin, for the piece alone. */
shared uint additive_count, covering_max, additive_max;

/* Returns the bin in whose list an entry is: the last bin whose list starts at the entry or before
 * it. A bin without sprites starts where the next one does, or at the end of all lists, so it is
 * never the result. */
uint bin_of(uint entry)
{
    uint low = 0u, high = bin_count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (bins[middle].first <= entry)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Returns the least and the greatest value of a linear function over the middles of a tile's
 * pixels. plane: its value at the anchor, and its change per pixel right and down; from_anchor: the
 * tile's middle, px. */
vec2 range_of(vec3 plane, vec2 from_anchor)
{
    float middle = plane.x + dot(plane.yz, from_anchor);
    float reach = dot(abs(plane.yz), vec2(0.5 * float(TILED_EDGE - 1)));
    return vec2(middle - reach, middle + reach);
}

/* Returns whether a tile may touch a sprite: false only if all of the tile lies outside of one of
 * the sprite's four edges. u, v, q, bounds: the rows SPRITE_* of the sprite (tiled.glsl); corner:
 * the upper left corner of the tile, px. inner holds how far inside of each edge the tile
 * reaches. */
bool touches(vec4 u, vec4 v, vec4 q, vec4 bounds, vec2 corner)
{
    vec2 from_anchor = corner + 0.5 * float(TILED_EDGE) - vec2(u.w, v.w);
    vec2 us = range_of(u.xyz, from_anchor), vs = range_of(v.xyz, from_anchor);
    vec4 inner = vec4(us.y, vs.y, 1.0 - us.x, 1.0 - vs.x);
    vec2 slack = 1e-4 + max(-bounds.xy, 0.0); /* for rounding, and for the rim */
#if SHAPES
    inner.z = range_of(q.xyz - u.xyz, from_anchor).y;
    inner.w = range_of(q.xyz - v.xyz, from_anchor).y;
    slack *= range_of(abs(q.xyz), abs(from_anchor)).y;
    if (bounds.x > 0.0) { /* a point or a line, whose u and v are in pixels */
        inner = vec4(bounds.xy + vec2(us.y, vs.y), bounds.xy - vec2(us.x, vs.x));
        slack = vec2(1e-2);
    }
#endif
    return all(greaterThanEqual(inner, -slack.xyxy));
}

/* Marks sprite i of the chunk in the tiles of a bin, and adds to the piece's bounds. atomicMax
 * compares floats by their bits, which have the same order for floats that are not negative. */
void mark_tiles(uint i, uvec2 bin_corner)
{
    uint row = i * uint(TILED_SPRITE_ROWS);
    vec4 u = sprites[row + uint(SPRITE_U)], v = sprites[row + uint(SPRITE_V)];
    vec4 q = sprites[row + uint(SPRITE_Q)], bounds = sprites[row + uint(SPRITE_BOUNDS)];
    uvec2 from = bin_corner * uint(TILED_BIN_TILES);
    uvec4 touched = squares_of(boxes[i], uint(TILED_EDGE));
    touched.xy = max(touched.xy, from);
    touched.zw = min(touched.zw, from + uint(TILED_BIN_TILES - 1));
    uint word = gl_LocalInvocationID.x / 32u, bit = 1u << (gl_LocalInvocationID.x % 32u);
    for (uint y = touched.y; y <= touched.w; y++) {
        for (uint x = touched.x; x <= touched.z; x++) {
            float scene = uintBitsToFloat(farthest[y * tile_columns + x]);
            uint tile = (y - from.y) * uint(TILED_BIN_TILES) + x - from.x;
            if (bounds.z <= scene && touches(u, v, q, bounds, vec2(x, y) * float(TILED_EDGE)))
                atomicOr(marks[tile * WORDS + word], bit);
        }
    }
    if (bounds.w < 0.0) {
        atomicAdd(additive_count, 1u);
        atomicMax(additive_max, floatBitsToUint(-bounds.w));
    } else {
        atomicMax(covering_max, floatBitsToUint(bounds.w));
    }
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint piece = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (piece >= pieces)
        return;
    uint number = bin_of(piece * uint(TILED_PIECE));
    tiled_bin bin = bins[number];
    uint at = piece * uint(TILED_PIECE) - bin.first; /* in the bin's list */
    for (uint k = 0u; k < WORDS; k++)
        marks[lane * WORDS + k] = 0u;
    if (lane == 0u)
        additive_count = covering_max = additive_max = 0u;
    barrier();
    if (at + lane < bin.count)
        mark_tiles(lists[bin.first + at + lane], uvec2(number % bin_columns, number / bin_columns));
    barrier();
    for (uint k = 0u; k < WORDS; k++)
        masks[mask_word(bin, lane, at / 32u + k)] = marks[lane * WORDS + k];
    if (lane == 0u) {
        atomicAdd(bins[number].additive_count, additive_count);
        atomicMax(bins[number].covering_max, covering_max);
        atomicMax(bins[number].additive_max, additive_max);
    }
}
