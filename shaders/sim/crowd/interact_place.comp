/* Copies living particles into bodies in order of their cells, after interact_scan.comp. Afterwards
 * the number of each cell is where its bodies end. The order of the bodies in one cell depends on
 * scheduling, but no result depends on that order. */
// variant:
// variant: SPINS=1
#include "sim/crowd/interact.glsl"

#include "shared/interact_body.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint slot = invocation();
    if (slot >= interact_params.used)
        return;
    kiln_particle p = records[interact_params.base + slot];
    if (!particle_is_alive(p))
        return;
    EXACT float3 position = particle_position(p);
    uint place = atomicAdd(cell_ends[cell_of(position)], 1u);
    bodies[place] = body_of(p, slot);
#ifdef SPINS
    copy_spin(place, slot);
#endif
}
