/* Averages places and velocities of all bodies of a flock in one work group. It sums integers, so
 * that the order does not matter, and stores the means as floats. The paper takes them from the
 * last level of mip-maps (Drone 2007, 7.4.4.2). */
#include "sim/crowd/interact.glsl"

#include "shared/interact_flock.h"

layout(local_size_x = INTERACT_SCAN_GROUP) in;

shared flock_all group_sums[INTERACT_SCAN_GROUP];

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint count = body_count();
    flock_all sum = flock_nobody();
    for (uint i = lane; i < count; i += uint(INTERACT_SCAN_GROUP))
        sum = flock_all_add(sum, flock_all_of(bodies[i]));
    group_sums[lane] = sum;
    barrier();
    for (uint half_way = uint(INTERACT_SCAN_GROUP) / 2u; half_way > 0u; half_way /= 2u) {
        if (lane < half_way)
            group_sums[lane] = flock_all_add(group_sums[lane], group_sums[lane + half_way]);
        barrier();
    }
    if (lane != 0u || count == 0u)
        return;
    EXACT flock_means means = flock_means_of(group_sums[0], count);
    entries[0] = uvec4(FLOAT_BITS(means.position.x), FLOAT_BITS(means.position.y),
                       FLOAT_BITS(means.position.z), 0u);
    entries[1] = uvec4(FLOAT_BITS(means.velocity.x), FLOAT_BITS(means.velocity.y),
                       FLOAT_BITS(means.velocity.z), 0u);
}
