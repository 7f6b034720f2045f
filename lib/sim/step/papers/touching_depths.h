/* Finds which particles of a block may touch the depth maps of a mesh on their way, for
 * slots_touching.h. */
#ifndef KILN_SIM_STEP_PAPERS_TOUCHING_DEPTHS_H
#define KILN_SIM_STEP_PAPERS_TOUCHING_DEPTHS_H

#include "sim/step/slots_block.h"

/* Unmarks lanes that stay on one side of the mesh's depth maps. */
static inline void find_touching_depths(const struct kiln_sim *sim, struct kiln_block *b,
                                        const struct kiln_collider *c)
{
    const struct kiln_grid grid = sim->surroundings->grids[c->grid];
    const struct kiln_pose pose = sim->surroundings->poses[c->mesh];
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        float3 from = sdf_local(pose, 0.0f, particle_position(record_at(b, i)));
        float3 to = sdf_local(pose, 1.0f, kiln_get3(&b->position, i));
        b->touching[i] &= 1u ^ (uint32_t)depth_is_clear(grid, from, to);
    }
}

#endif
