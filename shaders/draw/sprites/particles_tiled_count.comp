/* For each bin (8 x 8 tiles of the picture), counts the sprites of the current chunk that touch it,
 * for technique `tiled`. A work group counts the bits of one bin's mask; particles_tiled_make.comp
 * has set bit i if sprite i touches the bin. From the counts the host computes where each bin's
 * list of sprites begins (lib/draw/sprites/particles_tiled.c). */
#include "shared/tiled_layout.h"

layout(local_size_x = TILED_GROUP_SIZE) in;

layout(std430, binding = TILED_BIND_BIN_MASKS) readonly buffer bin_mask_block
{
    uint bin_masks[]; /* mask_words for each bin */
};

layout(std430, binding = TILED_BIND_COUNTS) writeonly buffer count_block
{
    uint counts[];
};

/* 32-bit words in the mask of a bin */
layout(location = TILED_AT_MASK_WORDS) uniform uint mask_words;

shared uint total;

void main()
{
    uint lane = gl_LocalInvocationID.x,
         bin = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (lane == 0u)
        total = 0u;
    barrier();
    uint sum = 0u;
    for (uint word = lane; word < mask_words; word += TILED_GROUP_SIZE)
        sum += uint(bitCount(bin_masks[bin * mask_words + word]));
    atomicAdd(total, sum);
    barrier();
    if (lane == 0u)
        counts[bin] = total;
}
