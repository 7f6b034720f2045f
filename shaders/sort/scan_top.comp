/* Runs the second of three kernels of an exclusive scan: scans the sums of all blocks in one work
 * group, and writes their total. A list that is no longer than a block needs this kernel alone. */
#include "sort/group.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_SUMS) buffer sum_block
{
    uint sums[];
};

layout(std430, binding = SORT_BIND_TOTAL) writeonly buffer total_block
{
    uint total;
};

layout(location = SORT_AT_COUNT) uniform uint count;

void main()
{
    uint stretch = (count + SORT_GROUP_SIZE - 1u) / SORT_GROUP_SIZE;
    uint first = gl_LocalInvocationID.x * stretch;
    uint last = min(first + stretch, count);
    uint sum = 0u;
    for (uint i = first; i < last; i++)
        sum += sums[i];
    uint before = group_sum_before(sum);
    for (uint i = first; i < last; i++) {
        uint value = sums[i];
        sums[i] = before;
        before += value;
    }
    if (gl_LocalInvocationID.x == 0u)
        total = group_total();
}
