/* Makes the sprites of a chunk of particles, the nearest first, and marks each in the bins that it
 * may touch. It is the first kernel of technique `tiled` that lib/draw/sprites/particles_tiled.c
 * runs for a chunk; tiled.glsl says what a sprite is. */
// variant: SHAPES=0 TILED_EDGE=16
// variant: SHAPES=0 NO_SMOKE=1 NO_LAMPS=1 TILED_EDGE=16
// variant: SHAPES=1 TILED_EDGE=16
// variant: SHAPES=1 SUN_SHADE=1 LAMP_SHADE=1 TILED_EDGE=16
// variant: SHAPES=1 LOOK_VALUES=1 TILED_EDGE=16
// variant: SHAPES=1 LOOK_VALUES=1 LOOK_SOURCES=1 TILED_EDGE=16
// variant: SHAPES=1 LOOK_VALUES=1 LOOK_PARENTS=1 TILED_EDGE=16
// variant: SHAPES=1 HAZE=1 TILED_EDGE=16
// variant: SHAPES=1 RIBBONS=4 TILED_EDGE=16
// variant: SHAPES=1 HAZE=1 LOOK_VALUES=1 RIBBONS=4 TILED_EDGE=16
#include "shared/draw_layout.h"

#include "draw/moment/record.glsl"
#include "draw/sprites/tiled.glsl"

layout(local_size_x = TILED_GROUP_SIZE) in;

layout(std430, binding = TILED_BIND_BOXES) writeonly buffer box_block
{
    uvec2 boxes[]; /* left, top, right, bottom of a sprite, 16 bits each, px; 0: it is not seen */
};

layout(std430, binding = TILED_BIND_SPRITES) writeonly buffer sprite_block
{
    vec4 sprites[]; /* TILED_SPRITE_ROWS for each */
};

layout(std430, binding = TILED_BIND_BIN_MASKS) buffer bin_mask_block
{
    uint bin_masks[];
};

layout(location = TILED_AT_COUNT) uniform uint count;
/* index in `entries` of the nearest particle */
layout(location = TILED_AT_FIRST) uniform uint first;
layout(location = TILED_AT_ADDITIVE_ALPHA) uniform float additive_alpha;
layout(location = TILED_AT_BIN_COLUMNS) uniform uint bin_columns;
/* 32-bit words in the mask of a bin */
layout(location = TILED_AT_MASK_WORDS) uniform uint mask_words;

vec4 center, right, up;
billboard particle;

#define NEAREST_FIRST
#include "draw/sprites/particle.glsl"

#include "draw/sprites/outline.glsl"

/* Returns the pixels between two places, within the picture, as an element of `boxes`. */
uvec2 box_of(vec2 low, vec2 high)
{
    uvec2 from = uvec2(clamp(low, vec2(0.0), view.frustum.zw));
    uvec2 to = uvec2(clamp(high + 1.0, vec2(0.0), view.frustum.zw));
    if (any(greaterThanEqual(from, to)))
        return uvec2(0u);
    return uvec2(from.x | from.y << 16, to.x | to.y << 16);
}

/* Returns the box around an outline: all of the picture if a part of the outline is behind the
 * eye. */
uvec2 box_around(outline s)
{
    if (!s.has_area)
        return uvec2(0u);
    if (!s.in_front)
        return box_of(vec2(0.0), view.frustum.zw);
    return box_of(min(min(s.corners[0], s.corners[1]), min(s.corners[2], s.corners[3])),
                  max(max(s.corners[0], s.corners[1]), max(s.corners[2], s.corners[3])));
}

/* Returns the most light that the particle can add to a channel of either target, as in
 * SPRITE_BOUNDS: negative if the particle covers nothing. */
float most_added()
{
    vec3 light = particle.light_0.rgb + abs(particle.light_x.rgb) + abs(particle.light_y.rgb) +
                 abs(particle.light_z.rgb);
    vec3 rgb = max(particle.hot.rgb, particle.cool.rgb) + particle.color.rgb * max(light, 0.0);
#ifdef HAZE
    if (uint(particle.depth.y) == KILN_CELL_COLOR)
        rgb += particle.cool.rgb;
#endif
#ifdef RIBBONS
    if (particle.color.r < 0.0) /* where it begins and where it ends */
        rgb = max(max(particle.hot.rgb, particle.cool.rgb), max(particle.light_y.rgb, particle.light_z.rgb)) +
              particle.cool.rgb + particle.light_z.rgb;
#endif
    rgb *= max(particle.bloom.rgb, vec3(1.0));
    float most = max(max(rgb.r, rgb.g), rgb.b);
    return particle.hot.a > 0.0 && additive_alpha == 0.0 ? -most : max(most, 1.0);
}

void write(uint row, outline s)
{
    float nearest_depth = s.in_front ? s.nearest_depth : 0.0;
    sprites[row + uint(SPRITE_U)] = s.rows.u;
    sprites[row + uint(SPRITE_V)] = s.rows.v;
    sprites[row + uint(SPRITE_Q)] = s.rows.q;
    sprites[row + uint(SPRITE_BOUNDS)] = vec4(s.rows.edge, nearest_depth, most_added());
    row += uint(SPRITE_QUAD);
    sprites[row] = particle.color;
    sprites[row + 1u] = particle.hot;
    sprites[row + 2u] = particle.cool;
    sprites[row + 3u] = particle.cells;
    sprites[row + 4u] = particle.depth;
    sprites[row + 5u] = particle.bloom;
    sprites[row + 6u] = particle.light_0;
    sprites[row + 7u] = particle.light_x;
    sprites[row + 8u] = particle.light_y;
    sprites[row + 9u] = particle.light_z;
}

void mark_bins(uint i, uvec2 box)
{
    if (box.y == 0u)
        return;
    uvec4 touched = squares_of(box, TILED_BIN_EDGE);
    for (uint y = touched.y; y <= touched.w; y++) {
        for (uint x = touched.x; x <= touched.z; x++)
            atomicOr(bin_masks[(y * bin_columns + x) * mask_words + i / 32u], 1u << (i % 32u));
    }
}

void main()
{
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * TILED_GROUP_SIZE +
             gl_LocalInvocationID.x;
    if (i >= count)
        return;
    make_item(first + i);
    uvec2 box = uvec2(0u);
    if (-center.z > view.eye.w && particle.color.a > 0.0) {
        outline s = find_particle_outline();
        box = box_around(s);
        write(i * uint(TILED_SPRITE_ROWS), s);
    }
    boxes[i] = box;
    mark_bins(i, box);
}
