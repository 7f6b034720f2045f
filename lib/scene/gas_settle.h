/* Declares the step that settles the domains of gas of a scene. */
#ifndef KILN_SCENE_GAS_SETTLE_H
#define KILN_SCENE_GAS_SETTLE_H

#include "scene/options.h"

/* Checks the domains of gas when all rows and nodes are read, computes their grids, and finds the
 * systems that are sources and the domains whose wind moves particles. root: the tree, for the
 * places of errors. */
bool kiln_gas_settle(struct kiln_reader *reader, const struct kiln_node *root);

#endif
