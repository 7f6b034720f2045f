/* Fills in the colliders of a step, in the layout of the shaders. */
#ifndef KILN_SIM_WORLD_COLLIDERS_H
#define KILN_SIM_WORLD_COLLIDERS_H

#include <stddef.h>

#include "sim/world/grids.h"

/* Bytes of struct kiln_surroundings in a uniform block, which has the first of all tables. */
#define KILN_SURROUNDINGS_BLOCK                                                                    \
    (offsetof(struct kiln_surroundings, colliders) +                                               \
     KILN_BLOCK_COLLIDERS * sizeof(struct kiln_collider) +                                         \
     KILN_BLOCK_GRIDS * sizeof(struct kiln_grid) + KILN_BLOCK_MESHES * sizeof(struct kiln_pose))

/* Returns the kind of collider, COLLIDER_*, that an object is whenever it collides. */
uint kiln_sim_collider_kind(const struct kiln_object *object);

/* Returns whether a scene has too many colliders, or meshes among them, for a uniform block. */
bool kiln_sim_stores_surroundings(const struct kiln_scene *scene);

/* Fills in the colliders and poses of a step between two clip times; rate: steps a second. Members
 * that do not change during a run are kept. */
void kiln_sim_colliders_fill(struct kiln_surroundings *around, const struct kiln_scene *scene,
                             const struct kiln_sim_grids *grids, float start_s, float end_s);

#endif
