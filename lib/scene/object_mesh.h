/* Loads the meshes of the backdrop and fills the members of their objects that follow from the
 * files. */
#ifndef KILN_SCENE_OBJECT_MESH_H
#define KILN_SCENE_OBJECT_MESH_H

#include "scene/validate.h"

/* Loads the mesh of an object, if it has one, and finds the clip of an animated mesh. Fills the
 * members that scene.h marks with "follows". Refuses files that cannot be loaded, or have no such
 * clip. root: as of kiln_validate; i: the object's number. */
bool kiln_object_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root, uint32_t i);

#endif
