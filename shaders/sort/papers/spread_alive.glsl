/* Lists all slots of the pool in the order that is kept between frames, for spread_count.comp and
 * spread_list.comp. */
#ifndef KILN_SORT_PAPERS_SPREAD_ALIVE_GLSL
#define KILN_SORT_PAPERS_SPREAD_ALIVE_GLSL

#include "sort/alive.glsl"
#include "sort/papers/spread.glsl"

layout(location = SORT_AT_CHOSEN) uniform uint chosen; /* bit i: system i takes part */
layout(location = SORT_AT_REVERSE) uniform uint reverse; /* not 0: the order is read from its end */

uint slot_of(uint i)
{
    return pairs[reverse != 0u ? used - 1u - i : i].y;
}

bool is_listed(uint slot)
{
    return is_alive(slot) && (chosen >> pool_system_of(slot) & 1u) != 0u;
}

#endif
