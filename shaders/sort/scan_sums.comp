/* Runs the first of three kernels of an exclusive scan: sums each block. The scan takes three
 * kernels, since a work group must not wait for another: GL does not promise that the other makes
 * progress meanwhile. */
#include "sort/group.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_COUNTS) readonly buffer count_block
{
    uint counts[];
};

layout(std430, binding = SORT_BIND_SUMS) writeonly buffer sum_block
{
    uint sums[];
};

layout(location = SORT_AT_COUNT) uniform uint count;

void main()
{
    uint first = group_index() * SORT_BLOCK + gl_LocalInvocationID.x;
    uint sum = 0u;
    for (uint i = 0u; i < SORT_ITEMS; i++) {
        uint at = first + i * SORT_GROUP_SIZE;
        if (at < count)
            sum += counts[at];
    }
    group_sum_before(sum);
    if (gl_LocalInvocationID.x == 0u && group_index() * SORT_BLOCK < count)
        sums[group_index()] = group_total();
}
