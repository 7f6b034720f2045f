/* Finds the living particles in the slots of one system, in order of serials, or with SPREAD in all
 * slots of the pool, in the order that is kept between frames. Each invocation takes a stretch of
 * SORT_ITEMS slots. alive_count.comp and alive_list.comp include it. */
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

#ifdef SPREAD /* all slots, in the order that is kept between frames */

#include "sort/spread.glsl"

layout(location = SORT_AT_USED) uniform uint used; /* slots of the pool */
layout(location = SORT_AT_CHOSEN) uniform uint chosen; /* bit i: system i takes part */
layout(location = SORT_AT_REVERSE) uniform uint reverse; /* not 0: the order is read from its end */

const uint first_block = 0u;

uint slot_of(uint i)
{
    return pairs[reverse != 0u ? used - 1u - i : i].y;
}

uint system_of(uint slot)
{
    return pool_system_of(slot);
}

#else

layout(location = SORT_AT_BASE) uniform uint base; /* the system's first slot */
layout(location = SORT_AT_CAPACITY) uniform uint capacity;
layout(location = SORT_AT_OLDEST) uniform uint oldest; /* slot of the oldest serial, from base */
layout(location = SORT_AT_USED) uniform uint used; /* slots that have held a particle */
/* index of the first block in `counts` */
layout(location = SORT_AT_FIRST_BLOCK) uniform uint first_block;
layout(location = SORT_AT_SYSTEM) uniform uint system;

/* Returns the slot of the i-th oldest serial. */
uint slot_of(uint i)
{
    uint slot = oldest + i;
    return base + (slot >= capacity ? slot - capacity : slot);
}

uint system_of(uint slot)
{
    return system;
}

#endif

bool is_listed(uint slot)
{
    bool alive = (records[slot].velocity_birth.w & KILN_PARTICLE_ALIVE) != 0u;
#ifdef SPREAD
    alive = alive && (chosen >> system_of(slot) & 1u) != 0u;
#endif
    return alive;
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
