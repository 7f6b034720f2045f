/* Counts the sprites of a chunk that each bin has, for technique `tiled`. A work group counts the
 * bits of one bin's mask, which particles_tiled_make.comp has set; the host then gives each bin's
 * list a place (lib/draw/sprites/particles_tiled.c). */
#include "shared/tiled_layout.h"

layout(local_size_x = TILED_GROUP_SIZE) in;

layout(std430, binding = TILED_BIND_BIN_MASKS) readonly buffer bin_mask_block
{
    uint bin_masks[];
};

layout(std430, binding = TILED_BIND_COUNTS) writeonly buffer count_block
{
    uint counts[];
};

layout(location = 0) uniform uint mask_words; /* of a bin's mask */

shared uint total;

void main()
{
    uint me = gl_LocalInvocationID.x, bin = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (me == 0u)
        total = 0u;
    barrier();
    uint sum = 0u;
    for (uint word = me; word < mask_words; word += TILED_GROUP_SIZE)
        sum += uint(bitCount(bin_masks[bin * mask_words + word]));
    atomicAdd(total, sum);
    barrier();
    if (me == 0u)
        counts[bin] = total;
}
