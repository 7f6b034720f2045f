/* Lists the slots of one system that have held a particle, in order of serials, for
 * alive_count.comp and alive_list.comp. */
#ifndef KILN_SORT_ALIVE_SYSTEM_GLSL
#define KILN_SORT_ALIVE_SYSTEM_GLSL

#include "sort/alive.glsl"

layout(location = SORT_AT_BASE) uniform uint base; /* the system's first slot */
layout(location = SORT_AT_CAPACITY) uniform uint capacity;
layout(location = SORT_AT_OLDEST) uniform uint oldest; /* slot of the oldest serial, from base */
/* index of the first block in `counts` */
layout(location = SORT_AT_FIRST_BLOCK) uniform uint first_block;
layout(location = SORT_AT_SYSTEM) uniform uint system;

/* Returns the slot of the i-th oldest serial. */
uint slot_of(uint i)
{
    uint slot = oldest + i;
    return base + (slot >= capacity ? slot - capacity : slot);
}

bool is_listed(uint slot)
{
    return is_alive(slot);
}

#endif
