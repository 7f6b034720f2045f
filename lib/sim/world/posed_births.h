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

/* Writes the triangles of a mesh with an animation, as they move between two clip times, into the
 * words of a source. poses: room for twice the vertices of the object. */
void kiln_sim_pose_words(float4 *words, const struct kiln_source *source,
                         const struct kiln_object *object, float (*poses)[6], float start_s,
                         float end_s);

/* Writes the triangles of a step, from 1, into the words of the grids. */
bool kiln_sim_pose_births(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                          uint32_t step, struct kiln_error *error);

#endif
