/* Samples of the grids that particles are moved by and collide with: files of wind, terrain, depth
 * maps and distance fields (sim/world/grids.h makes them). */
#ifndef KILN_SCENE_SAMPLES_H
#define KILN_SCENE_SAMPLES_H

#include "scene/options.h"

/* Reads files of wind, and refuses what is wrong with them, meshes of which no field can be made,
 * and more files or samples than a scene may have. Fills scene->samples. root: as of kiln_validate,
 * of which all else has been done. */
bool kiln_samples_settle(struct kiln_reader *reader, const struct kiln_node *root);

/* How far from a mesh there may be the centre of a ball that touches it, in units of the file. */
float kiln_scene_field_reach(const struct kiln_scene *scene, const struct kiln_object *mesh);

#endif
