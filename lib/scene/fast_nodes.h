/* Declares the warning about nodes that turn fast, with emitters on their arms. */
#ifndef KILN_SCENE_FAST_NODES_H
#define KILN_SCENE_FAST_NODES_H

#include "scene/options.h"

/* Warns of systems whose emitters go round by more than a quarter turn in a step, so that births
 * between two steps lie beside the circle. */
void kiln_fast_nodes_warn(struct kiln_reader *reader, const struct kiln_node *root);

#endif
