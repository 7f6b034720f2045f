/* Counts the bodies of the system, writes their entries for the first grid, and empties the pushes
 * of the system. The number of entries is a power of two; those without a body sort last. */
#include "sim/crowd/papers/staggered.glsl"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint slot = invocation();
    if (slot < uint(entries.length()))
        entries[slot] = uvec4(INTERACT_NOBODY);
    if (slot >= interact_params.used)
        return;
    empty_push(slot);
    kiln_particle p = records[interact_params.base + slot];
    if (!particle_is_alive(p))
        return;
    EXACT float3 position = particle_position(p);
    stagger_key key = stagger_key_of(position, 0.0f);
    entries[slot] = uvec4(key.high, key.low, slot, 0u);
    atomicAdd(cell_ends[interact_params.cell_mask], 1u);
}
