/* The depth of the scene, as far as it hides particles for certain: a part in 700 behind it. */
#include "draw/sprites/occlusion.glsl"

layout(binding = 2) uniform sampler2D scene_depth;

const float SLACK = 0.002 / 64.0; /* for rounding; octaves */

void main()
{
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    gl_FragDepth = 0.5 + 0.5 * (occlusion_place(scene) + SLACK);
}
