/* Declares the last stage of reading nodes. */
#ifndef KILN_SCENE_NODE_SETTLE_H
#define KILN_SCENE_NODE_SETTLE_H

#include "scene/options.h"

/* Finds the nodes that parents and attached parts name, refuses rings of parents, makes the tables
 * of paths, and gives an attached camera its place. */
bool kiln_nodes_settle(struct kiln_reader *reader, const struct kiln_node *root);

#endif
