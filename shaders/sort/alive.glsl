/* Finds the living particles in a list of slots. Each invocation takes a stretch of SORT_ITEMS
 * slots. The file that includes this one defines slot_of and is_listed. */
#ifndef KILN_SORT_ALIVE_GLSL
#define KILN_SORT_ALIVE_GLSL

#include "shared/particle.h"
#include "sort/group.glsl"

layout(std430, binding = SORT_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

layout(std430, binding = SORT_BIND_COUNTS) buffer count_block
{
    uint counts[]; /* living particles in each block of slots, then their sums over the blocks
                    * before */
};

layout(location = SORT_AT_USED) uniform uint used; /* slots in the list */

/* Returns the i-th slot of the list. */
uint slot_of(uint i);

/* Returns whether a particle of the list is chosen. */
bool is_listed(uint slot);

bool is_alive(uint slot)
{
    return (records[slot].velocity_birth.w & KILN_PARTICLE_ALIVE) != 0u;
}

uint stretch_begin()
{
    return group_index() * SORT_BLOCK + gl_LocalInvocationID.x * SORT_ITEMS;
}

/* Returns a bit for each slot of the stretch: bit k is set if slot k has a living particle of a
 * chosen system. */
uint alive_mask()
{
    uint first = stretch_begin();
    uint mask = 0u;
    for (uint k = 0u; k < SORT_ITEMS; k++) {
        if (first + k < used)
            mask |= is_listed(slot_of(first + k)) ? 1u << k : 0u;
    }
    return mask;
}

#endif
