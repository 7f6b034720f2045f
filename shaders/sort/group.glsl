/* The sum of all earlier invocations of the work group. */
#ifndef KILN_SORT_GROUP_GLSL
#define KILN_SORT_GROUP_GLSL

#include "shared/sort_layout.h"
#include "sort/index.glsl"

shared uint group_sums[SORT_GROUP_SIZE];

/* Doubling distances; every invocation must come here. group_total is right thereafter. */
uint group_sum_before(uint value)
{
    uint me = gl_LocalInvocationID.x;
    group_sums[me] = value;
    barrier();
    for (uint distance = 1u; distance < SORT_GROUP_SIZE; distance *= 2u) {
        uint other = me >= distance ? group_sums[me - distance] : 0u;
        barrier();
        group_sums[me] += other;
        barrier();
    }
    return group_sums[me] - value;
}

uint group_total()
{
    return group_sums[SORT_GROUP_SIZE - 1u];
}

#endif
