/* Declares the stage of reading nodes that finds those of glTF files. */
#ifndef KILN_SCENE_NODE_RIG_H
#define KILN_SCENE_NODE_RIG_H

#include "scene/options.h"

/* Finds the objects whose joints nodes are. Refuses keys that do not go together. */
bool kiln_node_rigs_find_objects(struct kiln_reader *reader, const struct kiln_node *root);

/* Loads the nodes of files, after kiln_node_rigs_find_objects, and finds those that nodes of the
 * scene name, and their clips. Warns of a scale that is not the same along all axes. */
bool kiln_node_rigs_settle(struct kiln_reader *reader, const struct kiln_node *root);

/* Returns whether a node is one of a file with a camera, and gives the scene's camera, which is
 * attached to the node, the field of view of that one, unless has_fov. False in *ok, with an error,
 * where kiln has no such camera. */
bool kiln_node_rigs_take_camera(struct kiln_reader *reader, const struct kiln_node *root,
                                uint32_t node, bool has_fov, bool *ok);

#endif
