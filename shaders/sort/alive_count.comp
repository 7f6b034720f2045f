/* Counts the living particles in each block of a system's slots. */
#include "sort/alive_system.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

void main()
{
    group_sum_before(uint(bitCount(alive_mask())));
    if (gl_LocalInvocationID.x == 0u && group_index() * SORT_BLOCK < used)
        counts[first_block + group_index()] = group_total();
}
