/* Counts the bodies of each cell, and empties the pushes of the system. It is the first kernel of
 * collisions and flocks. With FLOCK, it keeps pushes that other interactions have made. A sum of
 * integers is the same in any order. */
// variant:
// variant: KEYS_STORED=1
// variant: FLOCK=1
#include "sim/crowd/interact.glsl"

#include "shared/interact_body.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint slot = invocation();
    if (slot >= interact_params.used)
        return;
#ifdef FLOCK
    if (interact_params.adds == 0u)
#endif
        empty_push(slot);
    kiln_particle p = records[interact_params.base + slot];
    if (!particle_is_alive(p))
        return;
    EXACT float3 position = particle_position(p);
    atomicAdd(cell_ends[cell_of(position)], 1u);
}
