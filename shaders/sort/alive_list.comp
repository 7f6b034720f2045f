/* Writes the draw entries of the living particles of a system in order, behind those of the blocks
 * before. PAIRED writes pairs of a key by depth and the entry instead. NUMBERED writes the entries,
 * and pairs of the key and the entry's place in the list. */
// variant:
// variant: PAIRED=1
// variant: NUMBERED=1
#include "shared/keys.h"
#include "sort/alive_system.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

#ifndef PAIRED
layout(std430, binding = SORT_BIND_ENTRIES) writeonly buffer entry_block
{
    uint entries[];
};
#endif

#if defined(PAIRED) || defined(NUMBERED)
layout(std430, binding = SORT_BIND_PAIRS) writeonly buffer pair_block
{
    uvec2 pairs[];
};

layout(location = SORT_AT_EYE) uniform vec3 eye; /* m */
layout(location = SORT_AT_FORWARD) uniform vec3 forward; /* unit length */
#endif

void write(uint place, uint slot)
{
    uint entry = KILN_ENTRY(system, slot);
#ifndef PAIRED
    entries[place] = entry;
#endif
#ifdef PAIRED
    pairs[place] = uvec2(key_of_particle(records[slot], eye, forward), entry);
#elif defined(NUMBERED)
    pairs[place] = uvec2(key_of_particle(records[slot], eye, forward), place);
#endif
}

void main()
{
    uint alive = alive_mask();
    uint place = group_sum_before(uint(bitCount(alive)));
    if (stretch_begin() < used)
        place += counts[first_block + group_index()];
    for (uint k = 0u; k < SORT_ITEMS; k++) {
        if ((alive >> k & 1u) != 0u)
            write(place++, slot_of(stretch_begin() + k));
    }
}
