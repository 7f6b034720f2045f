/* Counts the bodies of each cell, and empties the pushes of the system. It is the first kernel of
 * collisions and flocks. With STAGGERED, it counts the bodies of the system instead and writes
 * their entries for the first grid. With FLOCK, it keeps pushes that other interactions have made.
 * A sum of integers is the same in any order. */
// variant:
// variant: STAGGERED=1
// variant: KEYS_STORED=1
// variant: FLOCK=1
#include "sim/crowd/interact.glsl"

#include "shared/interact_staggered.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint slot = invocation();
#ifdef STAGGERED /* the number of entries is a power of two; those without a body sort last */
    if (slot < uint(entries.length()))
        entries[slot] = uvec4(INTERACT_NOBODY);
#endif
    if (slot >= interact_params.used)
        return;
    uint at = (interact_params.first_push + slot) * 2u;
#ifdef FLOCK
    if (interact_params.adds == 0u)
#endif
    {
        push_words[at] = float4(0.0f);
        push_words[at + 1u] = float4(0.0f);
    }
    kiln_particle p = records[interact_params.base + slot];
    if (!particle_is_alive(p))
        return;
    EXACT float3 position = particle_position(p);
#ifdef STAGGERED
    stagger_key key = stagger_key_of(position, 0.0f);
    entries[slot] = uvec4(key.high, key.low, slot, 0u);
    atomicAdd(cell_ends[interact_params.cell_mask], 1u);
#else
    atomicAdd(cell_ends[cell_of(position)], 1u);
#endif
}
