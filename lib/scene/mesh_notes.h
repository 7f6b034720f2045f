/* Declares the warnings about the files of meshes. */
#ifndef KILN_SCENE_MESH_NOTES_H
#define KILN_SCENE_MESH_NOTES_H

#include "scene/options.h"

/* Logs what was changed or left out of the meshes of a scene, with the place of each in the scene.
 */
void kiln_mesh_notes_warn(struct kiln_reader *reader, const struct kiln_node *root,
                          const struct kiln_log *log);

#endif
