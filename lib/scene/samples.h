/* Counts the samples of the grids that move particles or that particles collide with: wind files,
 * terrain, depth maps and distance fields (sim/world/grids.h makes them). */
#ifndef KILN_SCENE_SAMPLES_H
#define KILN_SCENE_SAMPLES_H

#include "scene/options.h"

/* Reads wind files and fills scene->samples. Refuses faulty files, meshes of which no distance
 * field can be made, and more files or samples than a scene may have. root: as of kiln_validate,
 * whose other checks are done. */
bool kiln_samples_settle(struct kiln_reader *reader, const struct kiln_node *root);

/* Returns the largest distance from a mesh, in units of its file, at which the centre of a ball can
 * be that touches it. */
float kiln_scene_field_reach(const struct kiln_scene *scene, const struct kiln_object *mesh);

#endif
