/* Adds the state hash of one system and the number of its living particles to three sums; with
 * SPINS, it adds the hash of the system's spins alone. Sums of integers are the same in any order,
 * so atomics do no harm. */
// variant:
// variant: SPINS=1
#include "shared/limits.h"
#include "shared/state_hash.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(std430, binding = SIM_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

layout(std430, binding = SIM_BIND_SUMS) buffer sum_block
{
    uint sum_a, sum_b, alive;
};

layout(location = SIM_AT_SYSTEM) uniform uint system;
layout(location = SIM_AT_BASE) uniform uint base; /* the system's first slot */
layout(location = SIM_AT_USED) uniform uint used; /* the system's slots that have held a particle */
#ifdef SPINS
/* index in `spins` of the system's first slot */
layout(location = SIM_AT_FIRST_SPIN) uniform uint first_spin;

layout(std430, binding = SIM_BIND_SPINS) readonly buffer spin_block
{
    kiln_spin spins[];
};
#endif

shared uint group_sums[3];

void main()
{
    if (gl_LocalInvocationID.x < 3u)
        group_sums[gl_LocalInvocationID.x] = 0u;
    barrier();
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint first = group * SIM_GROUP_SIZE * SIM_HASH_SLOTS + gl_LocalInvocationID.x;
    uint a = 0u;
    uint b = 0u;
    uint alive_count = 0u;
    for (uint i = 0u; i < SIM_HASH_SLOTS; i++) {
        uint slot = first + i * SIM_GROUP_SIZE;
        if (slot < used) {
            kiln_particle p = records[base + slot];
#ifdef SPINS /* the program without SPINS counts the particles */
            state_hash_lanes lanes = state_hash_spin(system, p, spins[first_spin + slot]);
#else
            state_hash_lanes lanes = state_hash_particle(system, p);
            alive_count += particle_is_alive(p) ? 1u : 0u;
#endif
            a += lanes.a;
            b += lanes.b;
        }
    }
    atomicAdd(group_sums[0], a);
    atomicAdd(group_sums[1], b);
    atomicAdd(group_sums[2], alive_count);
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        atomicAdd(sum_a, group_sums[0]);
        atomicAdd(sum_b, group_sums[1]);
        atomicAdd(alive, group_sums[2]);
    }
}
