/* A fragment of a billboard. */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

#include "draw/sprites/billboard.glsl"

layout(binding = 2) uniform sampler2D scene_depth;

layout(location = 0) in vec2 uv;
layout(location = 1) flat in billboard quad;
#if SHAPES
layout(location = 11) in float view_depth; /* of points and lines: its reciprocal */
#endif

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

#include "draw/sprites/shade.glsl"

void main()
{
#if SHAPES
    float depth = is_plain(quad) ? 1.0 / view_depth : view_depth;
#else
    float depth = quad.depth.x;
#endif
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    shade(quad, uv, depth, scene, out_color, out_bloom);
}
