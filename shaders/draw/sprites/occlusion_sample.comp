/* Counts how many particles of a sample have their middle behind the scene. On software GL,
 * lib/draw/sprites/occlusion.c runs it to decide whether the depth test is worth its cost. */
#include "shared/draw_layout.h"

#include "draw/moment/record.glsl"

layout(local_size_x = 64) in;

layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;

layout(std430, binding = OCCLUSION_BIND_HIDDEN) buffer hidden_block
{
    uint hidden;
};

layout(location = OCCLUSION_AT_COUNT) uniform uint count;
layout(location = OCCLUSION_AT_SPACING) uniform uint spacing; /* one in so many entries is sampled */

void main()
{
    uint i = gl_GlobalInvocationID.x * spacing;
    if (i >= count)
        return;
    vec3 at = world_to_view_point(particle_position(records[KILN_ENTRY_SLOT(entries[i])]));
    vec2 size = vec2(textureSize(scene_depth, 0));
    at.xy -= view.principal.zw * at.z;
    vec2 pixel = size * (0.5 + vec2(at.x, -at.y) / view.frustum.xy * (0.5 / max(-at.z, 1e-3)));
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThanEqual(pixel, size)))
        return;
    if (texelFetch(scene_depth, ivec2(pixel), 0).r < -at.z)
        atomicAdd(hidden, 1u);
}
