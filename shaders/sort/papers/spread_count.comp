/* Counts the living particles of the chosen systems in each block of the kept order. */
#include "sort/papers/spread_alive.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

void main()
{
    group_sum_before(uint(bitCount(alive_mask())));
    if (gl_LocalInvocationID.x == 0u && group_index() * SORT_BLOCK < used)
        counts[group_index()] = group_total();
}
