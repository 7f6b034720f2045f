/* Runs the passes of the odd-even merge sort whose merges stay within a block, in shared memory. */
// variant:
// variant: NETWORK_GROUP_SIZE=512
#include "sort/papers/oddeven.glsl"

layout(local_size_x = NETWORK_GROUP_SIZE) in;

layout(location = SORT_AT_COUNT) uniform uint count; /* a power of two */
/* number of a pass, as in oddeven.glsl */
layout(location = SORT_AT_FIRST_PASS) uniform uint first_pass;
layout(location = SORT_AT_END_PASS) uniform uint end_pass;

shared uvec2 block[NETWORK_BLOCK];

void compare(uint stage, uint distance)
{
    for (uint k = 0u; k < NETWORK_BLOCK / 2u; k += NETWORK_GROUP_SIZE) {
        uint low;
        if (comparison(k + gl_LocalInvocationID.x, stage, distance, low))
            order(block[low], block[low + distance], false);
    }
    barrier();
}

void main()
{
    uint first = group_index() * NETWORK_BLOCK;
    for (uint i = gl_LocalInvocationID.x; i < NETWORK_BLOCK; i += NETWORK_GROUP_SIZE)
        block[i] = first + i < count ? pairs[first + i] : uvec2(0xffffffffu);
    barrier();
    uint pass = 0u;
    for (uint stage = 0u; 2u << stage <= NETWORK_BLOCK; stage++)
        for (uint distance = 1u << stage; distance > 0u; distance >>= 1u) {
            if (pass >= first_pass && pass < end_pass)
                compare(stage, distance);
            pass++;
        }
    for (uint i = gl_LocalInvocationID.x; i < NETWORK_BLOCK; i += NETWORK_GROUP_SIZE) {
        if (first + i < count)
            pairs[first + i] = block[i];
    }
}
