/* Draws a tile of the picture with the sprites that touch it. A work group has one tile. It draws
 * from front to back with its pixels in registers, stops when nothing behind could be seen, and
 * writes each pixel once. An invocation has one pixel or, on software GL, several below each other,
 * because fetching a sprite costs as much there as drawing a pixel of it.
 *
 * It is the last kernel of technique `tiled`. lib/draw/sprites/particles_tiled.c runs it for each
 * chunk of particles, after particles_tiled_make, _count, _list and _mark, and more than once where
 * the driver limits loops. Between two runs the pixels are kept in `carry`.
 *
 * Every invocation of a group must reach each barrier, so all must take the same way through the
 * loop in main. Sprites must be drawn in the order of the list. A change of a loop must be made in
 * round_iterations of particles_tiled.c, too, which counts iterations for drivers that limit
 * them. */
// variant: SHAPES=0 TILED_EDGE=16 TILED_ROWS=16
// variant: SHAPES=1 TILED_EDGE=8 TILED_ROWS=2
// variant: SHAPES=0 HAZE=1 TILED_EDGE=16 TILED_ROWS=16
// variant: SHAPES=0 GAS=1 GAS_BETWEEN=1 TILED_EDGE=8 TILED_ROWS=2
#include "shared/draw_layout.h"

#include "draw/sprites/tiled.glsl"

const uint PIXELS = uint(TILED_EDGE / TILED_ROWS); /* of an invocation */
const uint ROWS = uint(TILED_ROWS), GROUP_SIZE = uint(TILED_EDGE * TILED_ROWS);

layout(local_size_x = TILED_EDGE, local_size_y = TILED_ROWS) in;

layout(std430, binding = TILED_BIND_BINS) readonly buffer bin_block
{
    tiled_bin bins[];
};

layout(std430, binding = TILED_BIND_LISTS) readonly buffer list_block
{
    uint lists[];
};

layout(std430, binding = TILED_BIND_MASKS) readonly buffer mask_block
{
    uint masks[];
};

layout(std430, binding = TILED_BIND_CARRY) buffer carry_block
{
    vec4 carry[]; /* two for each pixel: colour and alpha; glow and transmittance */
};

layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;
layout(binding = TILED_UNIT_SPRITES) uniform samplerBuffer sprites;
layout(binding = TILED_UNIT_BEFORE) uniform sampler2D bloom_before;
layout(binding = TILED_IMAGE_COLOR) writeonly uniform image2D color_image;
layout(binding = TILED_IMAGE_BLOOM) writeonly uniform image2D bloom_image;

layout(location = TILED_AT_BIN_COLUMNS) uniform uint bin_columns;
/* this is the picture's first run; its last */
layout(location = TILED_AT_FIRST_LAST_RUN) uniform bvec2 first_last_run;
/* the glow of an earlier pass is kept */
layout(location = TILED_AT_KEEP_GLOW) uniform bool keep_glow;
/* 1: sprites hide others behind; 0: they are summed */
layout(location = TILED_AT_OCCLUDES) uniform float occludes;
/* of a chunk: less light may be left out */
layout(location = TILED_AT_MIN_LIGHT) uniform float min_light;
/* first and end of the words of masks that this run draws; the first is a multiple of
 * TILED_ROUND_WORDS */
layout(location = TILED_AT_SPAN) uniform uvec2 span;

#include "draw/sprites/place.glsl"
#include "draw/sprites/shade.glsl"
#include "draw/sprites/gas_before.glsl"
#ifdef RIBBONS
#include "draw/sprites/ribbon_pixel.glsl"
#endif

const uint WORDS = uint(TILED_ROUND_WORDS);
shared uint touching[WORDS]; /* the words of the tile's mask in this round */
shared uint hits[WORDS * 32u]; /* the sprites that touch the tile, in order */
shared uint hit_count, left_bits; /* left_bits: most_left's maximum over the group, bits of a float */

/* Puts the sprites of one round of the tile's mask, from word `first` on, into `hits`, in order.
 * Returns how many there are. */
uint list_hits(tiled_bin bin, uint tile, uint first)
{
    for (uint i = gl_LocalInvocationIndex; i < WORDS; i += GROUP_SIZE) {
        uint word = first + i;
        touching[i] = word * 32u < bin.count ? masks[mask_word(bin, tile, word)] : 0u;
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < WORDS; i += GROUP_SIZE) {
        uint place = 0u, bits = touching[i];
        for (uint k = 0u; k < i; k++)
            place += uint(bitCount(touching[k]));
        while (bits != 0u) {
            hits[place++] = lists[bin.first + (first + i) * 32u + uint(findLSB(bits))];
            bits &= bits - 1u;
        }
        if (i == WORDS - 1u)
            hit_count = place;
    }
    barrier();
    return hit_count;
}

/* A pixel while it is drawn from front to back. */
struct pixel {
    float scene; /* depth of the scene there, m */
    vec4 color, glow; /* glow.a: transmittance */
};

pixel pixels[PIXELS];

#ifdef GAS
/* The most light that the gas of the invocation's pixels adds to a channel. */
float light_of_gas = 0.0;

void measure_gas(vec2 place)
{
    gas_before all = find_gas(place, 1e9);
    vec3 light = max(all.light, gas.covered.z * all.glow);
    light_of_gas = max(light_of_gas, max(max(light.r, light.g), light.b));
}
#endif

/* Starts the invocation's pixels, empty or from `carry`. A pixel outside the picture gets
 * transmittance 0, so that nothing is drawn for it. Returns the largest channel of the glow of an
 * earlier pass. */
float open_pixels(uvec2 first, uvec2 size)
{
    vec4 before = vec4(0.0);
    for (uint k = 0u; k < PIXELS; k++) {
        uvec2 at = first + uvec2(0u, k * ROWS);
        bool inside = all(lessThan(at, size));
        pixels[k] = pixel(0.0, vec4(0.0), vec4(0.0, 0.0, 0.0, inside ? 1.0 : 0.0));
        if (!inside)
            continue;
        pixels[k].scene = texelFetch(scene_depth, ivec2(at), 0).r;
#ifdef GAS
        measure_gas(vec2(at) + 0.5);
#endif
        if (keep_glow)
            before = max(before, texelFetch(bloom_before, ivec2(at), 0));
        if (!first_last_run.x) {
            uint word = (at.y * size.x + at.x) * 2u;
            pixels[k].color = carry[word];
            pixels[k].glow = carry[word + 1u];
        }
    }
    return max(max(before.r, before.g), before.b);
}

/* Fetches the billboard of a sprite, in the order in which particles_tiled_make.comp writes it. */
billboard fetch_quad(int row)
{
    return billboard(texelFetch(sprites, row), texelFetch(sprites, row + 1),
                     texelFetch(sprites, row + 2), texelFetch(sprites, row + 3),
                     texelFetch(sprites, row + 4), texelFetch(sprites, row + 5),
                     texelFetch(sprites, row + 6), texelFetch(sprites, row + 7),
                     texelFetch(sprites, row + 8), texelFetch(sprites, row + 9));
}

/* Draws sprite i into the invocation's pixels. first: the middle of the first of these pixels,
 * px. */
void draw(uint i, vec2 first)
{
    int row = int(i) * TILED_SPRITE_ROWS;
    vec4 u = texelFetch(sprites, row + SPRITE_U), v = texelFetch(sprites, row + SPRITE_V);
    billboard whole = fetch_quad(row + SPRITE_QUAD), quad = whole;
    place rows = place(u, v, vec4(0.0), -rim_reach(quad));
#if SHAPES
    rows.q = texelFetch(sprites, row + SPRITE_Q);
    rows.edge = texelFetch(sprites, row + SPRITE_BOUNDS).xy;
#endif
    for (uint k = 0u; k < PIXELS; k++) {
        vec2 at;
        vec2 pixel = first + vec2(0.0, float(k * ROWS));
        float depth = whole.depth.x;
        bool covers;
#ifdef RIBBONS
        quad = whole;
        if (is_ribbon(whole))
            covers = ribbon_covers(u, v, pixel, quad, depth, at);
        else
#endif
            covers = place_covers(rows, pixel, depth, at);
        if (covers) {
            vec4 color, glow;
            shade(quad, at, depth, pixels[k].scene, color, glow);
#ifdef GAS
            blend_with_gas(pixel, depth, color, glow);
#endif
            float passed = pixels[k].glow.a;
            pixels[k].color += color * passed;
            pixels[k].glow += vec4(glow.rgb, -occludes * color.a) * passed;
        }
    }
}

/* Returns the most light that any pixel of the tile could still get from the last sprites_left
 * sprites of the bin and from the glow of an earlier pass. */
float most_left(tiled_bin bin, float before, uint sprites_left)
{
    if (gl_LocalInvocationIndex == 0u)
        left_bits = 0u;
    barrier();
    float adding = float(min(bin.additive_count, sprites_left)) * uintBitsToFloat(bin.additive_max);
    float transmittance = 0.0;
    for (uint k = 0u; k < PIXELS; k++)
        transmittance = max(transmittance, pixels[k].glow.a);
    float covering = uintBitsToFloat(bin.covering_max);
#ifdef GAS
    covering += light_of_gas;
    before += light_of_gas;
#endif
    float left = transmittance * (max(covering, before) + adding);
    atomicMax(left_bits, floatBitsToUint(left));
    barrier();
    return uintBitsToFloat(left_bits);
}

/* Returns the first pixel of this invocation. */
uvec2 first_pixel()
{
    uvec2 lane = gl_LocalInvocationID.xy;
#if TILED_ROWS == TILED_EDGE
    /* 32 neighbouring invocations have a block of 8 x 4 pixels, which often take the same
     * branches. */
    uint i = gl_LocalInvocationIndex, block = i / 32u, blocks_a_row = uint(TILED_EDGE / 8);
    lane = uvec2(i % 8u + 8u * (block % blocks_a_row), i / 8u % 4u + 4u * (block / blocks_a_row));
#endif
    return gl_WorkGroupID.xy * uint(TILED_EDGE) + lane;
}

/* Writes the pixels: into the images after the last run, into `carry` otherwise. */
void close_pixels(uvec2 first, uvec2 size)
{
    for (uint k = 0u; k < PIXELS; k++) {
        uvec2 at = first + uvec2(0u, k * ROWS);
        if (any(greaterThanEqual(at, size)))
            continue;
        vec4 color = pixels[k].color, glow = pixels[k].glow;
        if (first_last_run.y) {
            vec4 before = keep_glow ? texelFetch(bloom_before, ivec2(at), 0) : vec4(0.0);
            imageStore(color_image, ivec2(at), color);
            imageStore(bloom_image, ivec2(at), vec4(glow.rgb, color.a) + before * glow.a);
        } else {
            uint word = (at.y * size.x + at.x) * 2u;
            carry[word] = color;
            carry[word + 1u] = glow;
        }
    }
}

void main()
{
    uvec2 first = first_pixel(), size = uvec2(textureSize(scene_depth, 0));
    float before = open_pixels(first, size);
    uvec2 home = gl_WorkGroupID.xy / uint(TILED_BIN_TILES);
    uvec2 tile = gl_WorkGroupID.xy % uint(TILED_BIN_TILES);
    tiled_bin bin = bins[home.y * bin_columns + home.x];
    for (uint word = span.x; word < span.y && word * 32u < bin.count; word += WORDS) {
        if (most_left(bin, before, bin.count - word * 32u) < min_light)
            break;
        uint count = list_hits(bin, tile.y * uint(TILED_BIN_TILES) + tile.x, word);
        for (uint i = 0u; i < count; i++)
            draw(hits[i], vec2(first) + 0.5);
    }
    close_pixels(first, size);
}
