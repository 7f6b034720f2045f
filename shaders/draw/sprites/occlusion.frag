/* Writes the scene's depth into the depth buffer that rejects hidden particles
 * (lib/draw/sprites/occlusion.h). It writes a depth that is greater by a part in 700, so that
 * rounding rejects no visible particle. */
#include "shared/draw_layout.h"

#include "draw/sprites/occlusion.glsl"

layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;

const float SLACK = 0.002 / 64.0; /* slack for rounding, 0.002 octaves of depth */

void main()
{
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    gl_FragDepth = 0.5 + 0.5 * (occlusion_z(scene) + SLACK);
}
