/* Meshes of the backdrop that move: what follows from their files. */
#ifndef KILN_SCENE_MESH_ANIMATION_H
#define KILN_SCENE_MESH_ANIMATION_H

#include "scene/validate.h"

/* Finds the clip of a mesh that moves, for what scene.h says to follow. Refuses files without it.
 * root: as of kiln_validate; i: the object's number. */
bool kiln_mesh_animation_settle(struct kiln_reader *reader, const struct kiln_node *root,
                                uint32_t i);

#endif
