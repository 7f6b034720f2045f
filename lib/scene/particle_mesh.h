/* Loads the meshes that particles are drawn as, and fills the members of their looks that follow
 * from the files. */
#ifndef KILN_SCENE_PARTICLE_MESH_H
#define KILN_SCENE_PARTICLE_MESH_H

#include "scene/validate.h"

/* Reads the mesh of a system whose shape is a mesh, and fills the members that scene.h marks with
 * "follows". Refuses a shape without a file, and meshes that are too large. root: as of
 * kiln_validate. */
bool kiln_particle_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root,
                               struct kiln_system *system);

/* Refuses meshes that together exceed the limits of memory and time. The capacities of all systems
 * must be known. */
bool kiln_particle_mesh_count(struct kiln_reader *reader, const struct kiln_node *root);

#endif
