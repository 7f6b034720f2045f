/* Loads the meshes that particles look like and fills in what follows from their files. */
#ifndef KILN_SCENE_PARTICLE_MESH_H
#define KILN_SCENE_PARTICLE_MESH_H

#include "scene/validate.h"

/* Reads the mesh of a system that shows one and fills what scene.h says to follow from it. Refuses
 * a shape without a file, and meshes that are too large. root: as of kiln_validate. */
bool kiln_particle_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root,
                               struct kiln_system *system);

/* Refuses more meshes than memory and time allow; the capacities of all systems are known. */
bool kiln_particle_mesh_count(struct kiln_reader *reader, const struct kiln_node *root);

#endif
