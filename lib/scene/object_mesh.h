/* Loads the meshes of the backdrop and fills in what follows from their files. */
#ifndef KILN_SCENE_OBJECT_MESH_H
#define KILN_SCENE_OBJECT_MESH_H

#include "scene/validate.h"

/* Imports what is wanted of the mesh of an object, if it has one, and finds the clip of one that
 * moves: fills what scene.h says to follow. Refuses files that can not be imported so, or have no
 * such clip. root: as of kiln_validate; i: the object's number. */
bool kiln_object_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root, uint32_t i);

#endif
