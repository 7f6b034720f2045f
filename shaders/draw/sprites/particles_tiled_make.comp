/* The sprites of a chunk of particles, the nearest first, each marked in the bins that it may touch. */
// variant: SHAPES=0 TILED_EDGE=16
// variant: SHAPES=1 TILED_EDGE=16
// variant: SHAPES=1 SUN_SHADE=1 TILED_EDGE=16
#include "shared/draw_layout.h"

#include "draw/moment/record.glsl"
#include "draw/sprites/tiled.glsl"

layout(local_size_x = TILED_GROUP_SIZE) in;

layout(std430, binding = TILED_BIND_BOXES) writeonly buffer box_block
{
    uvec2 boxes[]; /* left, top; right, bottom: 16 bits each, px; 0 if it is not seen */
};

layout(std430, binding = TILED_BIND_SPRITES) writeonly buffer sprite_block
{
    vec4 sprites[]; /* TILED_SPRITE_ROWS each */
};

layout(std430, binding = TILED_BIND_BIN_MASKS) buffer bin_mask_block
{
    uint bin_masks[];
};

layout(location = 0) uniform uint count;
layout(location = 1) uniform uint first; /* the nearest one's place in the entries */
layout(location = 2) uniform float additive_alpha;
layout(location = 3) uniform uint bin_columns;
layout(location = 4) uniform uint words; /* of a bin's mask */

vec4 center, right, up;
billboard particle;

#include "draw/sprites/particle.glsl"

/* Where it is in the picture. */
struct place {
    vec4 u, v, q, most; /* rows of the sprite */
    uvec2 box;
};

/* Pixels from the top left, of a point before the eye. */
vec2 to_pixels(vec3 v)
{
    return view.frustum.zw * (0.5 + vec2(v.x, -v.y) / view.frustum.xy * (0.5 / -v.z));
}

/* The pixels between two places, within the picture. */
uvec2 box_of(vec2 low, vec2 high)
{
    uvec2 from = uvec2(clamp(low, vec2(0.0), view.frustum.zw));
    uvec2 to = uvec2(clamp(high + 1.0, vec2(0.0), view.frustum.zw));
    if (any(greaterThanEqual(from, to)))
        return uvec2(0u);
    return uvec2(from.x | from.y << 16, to.x | to.y << 16);
}

#if SHAPES

/* A linear function of view space, as one of the pixels about the anchor. */
vec4 plane_of(vec3 row, vec2 anchor, float w)
{
    vec2 slope = row.xy * 2.0 * view.frustum.xy / view.frustum.zw * vec2(1.0, -1.0);
    return vec4(dot(slope, anchor - 0.5 * view.frustum.zw) - row.z, slope, w);
}

/* A billboard in any plane: a point of the picture is a direction d, and with the inverse of the
 * matrix of right, up and centre, (a, b, 1) / depth = inverse * d. */
place find_place()
{
    place s;
    vec2 anchor = to_pixels(center.xyz);
    vec3 normal = cross(right.xyz, up.xyz);
    float det = dot(normal, center.xyz);
    float scale = abs(det) > 1e-12 ? 1.0 / det : 0.0;
    vec3 a = cross(up.xyz, center.xyz) * scale, b = cross(center.xyz, right.xyz) * scale;
    normal *= scale;
    s.u = plane_of(0.5 * (normal + a), anchor, anchor.x);
    s.v = plane_of(0.5 * (normal - b), anchor, anchor.y);
    s.q = plane_of(normal, anchor, 0.0);
    vec2 low = view.frustum.zw, high = vec2(0.0);
    float least = -center.z;
    for (int i = 0; i < 4; i++) {
        vec2 corner = vec2((i & 1) == 0 ? -1.0 : 1.0, (i & 2) == 0 ? -1.0 : 1.0);
        vec3 at = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
        bool before = -at.z >= 1e-3 * -center.z; /* what reaches behind the eye may be anywhere */
        vec2 pixel = to_pixels(vec3(at.xy, before ? at.z : -1.0));
        low = min(low, before ? pixel : vec2(0.0));
        high = max(high, before ? pixel : view.frustum.zw);
        least = before ? min(least, -at.z) : 0.0;
    }
    s.most = vec4(0.0, 0.0, max(least, 0.0), 0.0);
    s.box = scale == 0.0 ? uvec2(0u) : box_of(low, high);
    return s;
}

/* A line, or a point as a line of no length: see draw/sprites/corner.glsl. */
place find_plain_place()
{
    place s;
    vec3 head = center.xyz, tail = head + up.xyz;
    float near = max(view.eye.w, 1e-3);
    if (-tail.z < near)
        tail = mix(head, tail, (-head.z - near) / (tail.z - head.z));
    vec2 from = to_pixels(tail), to = to_pixels(head), way = to - from;
    float way_px = length(way);
    vec2 along = way_px > 1e-3 ? way / way_px : vec2(1.0, 0.0);
    vec2 extent = vec2(0.5 * way_px, 0.0) + right.w, middle = 0.5 * (from + to);
    vec2 edge = extent + 0.5;
    s.u = vec4(0.0, along, middle.x);
    s.v = vec4(0.0, -along.y, along.x, middle.y);
    /* From end to end, rims and all, the reciprocal of the depth changes evenly. */
    float first = 1.0 / -tail.z, last = 1.0 / -head.z;
    s.q = vec4(0.5 * (first + last), along * (0.5 * (last - first) / edge.x), 0.0);
    s.most = vec4(edge, 1.0 / max(first, last), 0.0);
    particle.cells.xy = extent;
    vec2 reach = abs(along) * edge.x + abs(along.yx) * edge.y;
    s.box = box_of(middle - reach, middle + reach);
    return s;
}

#else

/* A billboard parallel to the picture. */
place find_place()
{
    place s;
    float depth = -center.z;
    vec2 middle = to_pixels(center.xyz);
    vec2 scale = 0.5 * view.frustum.zw / (view.frustum.xy * depth) * vec2(1.0, -1.0);
    vec2 r = right.xy * scale, u = up.xy * scale; /* half edges, px */
    float det = r.x * u.y - u.x * r.y;
    float half_edge = abs(det) > 1e-12 ? 0.5 / det : 0.0;
    s.u = vec4(0.5, vec2(u.y, -u.x) * half_edge, middle.x);
    s.v = vec4(0.5, vec2(r.y, -r.x) * half_edge, middle.y);
    s.q = vec4(0.0);
    s.most = vec4(0.0, 0.0, depth, 0.0);
    vec2 reach = abs(r) + abs(u);
    s.box = half_edge == 0.0 ? uvec2(0u) : box_of(middle - reach, middle + reach);
    return s;
}

#endif

/* The most that the particle can add to a channel of either target. */
float most_added()
{
    vec3 light = particle.light_0.rgb + abs(particle.light_x.rgb) + abs(particle.light_y.rgb) +
                 abs(particle.light_z.rgb);
    vec3 rgb = max(particle.hot.rgb, particle.cool.rgb) + particle.color.rgb * max(light, 0.0);
    rgb *= max(particle.bloom.rgb, vec3(1.0));
    float most = max(max(rgb.r, rgb.g), rgb.b);
    return particle.hot.a > 0.0 && additive_alpha == 0.0 ? -most : max(most, 1.0);
}

void write(uint row, place s)
{
    sprites[row + uint(SPRITE_U)] = s.u;
    sprites[row + uint(SPRITE_V)] = s.v;
    sprites[row + uint(SPRITE_Q)] = s.q;
    sprites[row + uint(SPRITE_MOST)] = s.most;
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
            atomicOr(bin_masks[(y * bin_columns + x) * words + i / 32u], 1u << (i % 32u));
    }
}

void main()
{
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * TILED_GROUP_SIZE +
             gl_LocalInvocationID.x;
    if (i >= count)
        return;
    make_particle(entries[first + i]);
    uvec2 box = uvec2(0u);
    if (-center.z > view.eye.w && particle.color.a > 0.0) {
#if SHAPES
        place s = center.w > 0.0 ? find_plain_place() : find_place();
#else
        place s = find_place();
#endif
        s.most.w = most_added();
        box = s.box;
        write(i * uint(TILED_SPRITE_ROWS), s);
    }
    boxes[i] = box;
    mark_bins(i, box);
}
