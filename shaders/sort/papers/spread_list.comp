/* Writes the draw entries of the living particles of the chosen systems in the kept order, behind
 * those of the blocks before. */
#include "sort/papers/spread_alive.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_ENTRIES) writeonly buffer entry_block
{
    uint entries[];
};

void main()
{
    uint alive = alive_mask();
    uint place = group_sum_before(uint(bitCount(alive)));
    if (stretch_begin() < used)
        place += counts[group_index()];
    for (uint k = 0u; k < SORT_ITEMS; k++) {
        if ((alive >> k & 1u) == 0u)
            continue;
        uint slot = slot_of(stretch_begin() + k);
        entries[place++] = KILN_ENTRY(pool_system_of(slot), slot);
    }
}
