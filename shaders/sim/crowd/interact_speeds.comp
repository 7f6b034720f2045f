/* Finds the bounds of the velocities of a system's particles, before collisions. From them the host
 * computes how far ahead collisions are searched (lib/sim/crowd/interact.c). Maxima of integers are
 * the same in any order. */
#include "sim/crowd/interact.glsl"

#include "shared/interact_speeds.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

shared uint group_bounds[SPEEDS_BOUNDS];

void main()
{
    uint slot = invocation();
    if (gl_LocalInvocationIndex < SPEEDS_BOUNDS)
        group_bounds[gl_LocalInvocationIndex] = 0u;
    barrier();
    bool counts = slot < interact_params.used;
    kiln_particle p = records[interact_params.base + (counts ? slot : 0u)];
    if (counts && particle_is_alive(p)) {
        for (uint bound = 0u; bound < SPEEDS_BOUNDS; bound++)
            atomicMax(group_bounds[bound], speeds_bound(particle_velocity(p), bound));
    }
    barrier();
    if (gl_LocalInvocationIndex < SPEEDS_BOUNDS)
        atomicMax(cell_ends[gl_LocalInvocationIndex], group_bounds[gl_LocalInvocationIndex]);
}
