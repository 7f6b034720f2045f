/* Finds the largest depth of the scene in each tile of the picture. A work group has one tile, and
 * an invocation one pixel.
 *
 * lib/draw/sprites/particles_tiled.c runs it once for a pass of particles, before any sprites are
 * made. particles_tiled_mark.comp then leaves a sprite out of the tiles in which all of the scene
 * is before it. So a result may be too large, which costs time only, but never too small. Depths
 * are compared as the bits of floats, whose order is right only for numbers that are not negative;
 * therefore the kernel clamps them at 0. */
// variant: TILED_EDGE=16
#include "shared/draw_layout.h"
#include "shared/tiled_layout.h"

layout(local_size_x = TILED_EDGE, local_size_y = TILED_EDGE) in;

layout(std430, binding = TILED_BIND_FARTHEST) writeonly buffer farthest_block
{
    uint farthest[];
};

layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;

shared uint largest_depth; /* the largest depth so far: bits of a float */

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        largest_depth = 0u;
    barrier();
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, textureSize(scene_depth, 0))))
        atomicMax(largest_depth, floatBitsToUint(max(texelFetch(scene_depth, at, 0).r, 0.0)));
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        farthest[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = largest_depth;
}
