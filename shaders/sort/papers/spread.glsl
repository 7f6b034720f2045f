/* Declares an order of all slots that is kept from frame to frame (lib/sort/papers/spread.c), as
 * pairs of a key and a slot. While they are sorted, the slot is replaced by its rank: the place of
 * its (system, serial) among all slots. */
#ifndef KILN_SORT_PAPERS_SPREAD_GLSL
#define KILN_SORT_PAPERS_SPREAD_GLSL

#include "shared/particle.h"
#include "shared/papers/sort_layout.h"
#include "sort/network.glsl"

layout(location = SORT_AT_SYSTEM_COUNT) uniform uint pool_system_count;
/* For each system: its first slot, its capacity, and its oldest serial's slot from the first. */
layout(location = SORT_AT_SYSTEMS) uniform uvec3 pool_systems[KILN_MAX_SYSTEMS];

/* Returns the system of a slot, or of a rank. */
uint pool_system_of(uint slot)
{
    uint system = 0u;
    for (uint i = 1u; i < pool_system_count; i++)
        system = pool_systems[i].x <= slot ? i : system;
    return system;
}

#endif
