/* Computes an exclusive prefix sum over a work group of GROUP_SIZE invocations in one dimension. */
#ifndef KILN_SHARED_GROUP_SUM_GLSL
#define KILN_SHARED_GROUP_SUM_GLSL

shared uint group_sums[GROUP_SIZE];

/* Returns the sum of the values of all invocations before this one, by additions over doubling
 * distances. Every invocation must call it. Afterwards group_total returns the sum of all. */
uint group_sum_before(uint value)
{
    uint lane = gl_LocalInvocationID.x;
    group_sums[lane] = value;
    barrier();
    for (uint distance = 1u; distance < GROUP_SIZE; distance *= 2u) {
        uint other = lane >= distance ? group_sums[lane - distance] : 0u;
        barrier();
        group_sums[lane] += other;
        barrier();
    }
    return group_sums[lane] - value;
}

uint group_total()
{
    return group_sums[GROUP_SIZE - 1u];
}

#endif
