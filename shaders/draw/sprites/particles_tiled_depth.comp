/* The farthest that the scene is in each tile. */
// variant: TILED_EDGE=16
#include "shared/tiled_layout.h"

layout(local_size_x = TILED_EDGE, local_size_y = TILED_EDGE) in;

layout(std430, binding = TILED_BIND_FARTHEST) writeonly buffer farthest_block
{
    uint farthest[];
};

layout(binding = 2) uniform sampler2D scene_depth;

shared uint most;

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        most = 0u;
    barrier();
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, textureSize(scene_depth, 0))))
        atomicMax(most, floatBitsToUint(max(texelFetch(scene_depth, at, 0).r, 0.0)));
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        farthest[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = most;
}
