/* Lists the sprites of each bin in the order of the chunk, for technique `tiled`. A work group
 * turns one bin's mask, which particles_tiled_make.comp has set, into a list. */
#include "shared/tiled_layout.h"

#define GROUP_SIZE TILED_GROUP_SIZE
#include "shared/group_sum.glsl"

layout(local_size_x = TILED_GROUP_SIZE) in;

layout(std430, binding = TILED_BIND_BIN_MASKS) readonly buffer bin_mask_block
{
    uint bin_masks[];
};

layout(std430, binding = TILED_BIND_BINS) readonly buffer bin_block
{
    tiled_bin bins[];
};

layout(std430, binding = TILED_BIND_LISTS) writeonly buffer list_block
{
    uint lists[];
};

/* 32-bit words in the mask of a bin */
layout(location = TILED_AT_MASK_WORDS) uniform uint mask_words;

void main()
{
    uint bin = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint end = bins[bin].first;
    for (uint first = 0u; first < mask_words; first += TILED_GROUP_SIZE) {
        uint word = first + gl_LocalInvocationID.x;
        uint bits = word < mask_words ? bin_masks[bin * mask_words + word] : 0u;
        uint place = end + group_sum_before(uint(bitCount(bits)));
        end += group_total();
        while (bits != 0u) {
            lists[place++] = word * 32u + uint(findLSB(bits));
            bits &= bits - 1u;
        }
        barrier(); /* the next sum overwrites what other invocations still read */
    }
}
