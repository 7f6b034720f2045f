/* A fragment of a billboard. */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

#include "draw/sprites/fragment.glsl"

void main()
{
    vec2 at;
    float depth;
    if (!is_covered(at, depth))
        discard;
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    shade(quad, at, depth, scene, out_color, out_bloom);
}
