/* Runs the third of three kernels of an exclusive scan: scans each block, starting with the sum of
 * the blocks before it. */
#include "sort/group.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_COUNTS) buffer count_block
{
    uint counts[];
};

layout(std430, binding = SORT_BIND_SUMS) readonly buffer sum_block
{
    uint sums[];
};

layout(location = SORT_AT_COUNT) uniform uint count;

void main()
{
    uint first = group_index() * SORT_BLOCK + gl_LocalInvocationID.x * SORT_ITEMS;
    uint values[SORT_ITEMS];
    uint sum = 0u;
    for (uint i = 0u; i < SORT_ITEMS; i++) {
        values[i] = first + i < count ? counts[first + i] : 0u;
        sum += values[i];
    }
    uint before = group_sum_before(sum);
    if (first < count)
        before += sums[group_index()];
    for (uint i = 0u; i < SORT_ITEMS; i++) {
        if (first + i < count)
            counts[first + i] = before;
        before += values[i];
    }
}
