/* Declares how the triangles of meshes with an animation, on which particles are born, move during
 * a step. */
#ifndef KILN_SIM_WORLD_POSED_BIRTHS_H
#define KILN_SIM_WORLD_POSED_BIRTHS_H

#include "scene/scene.h"
#include "sim/world/grids.h"

/* Makes room for the poses of such meshes. kiln_sim_posed_finish frees it. */
bool kiln_sim_posed_init(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                         struct kiln_error *error);
void kiln_sim_posed_finish(struct kiln_sim_grids *grids);

/* Adds the memory of the poses. */
void kiln_sim_posed_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Writes the triangles of a step, from 1, into the words of the grids. */
bool kiln_sim_pose_births(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                          uint32_t step, struct kiln_error *error);

#endif
