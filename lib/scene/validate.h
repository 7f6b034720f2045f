/* Checks the options of a scene against each other, and whether it can run. */
#ifndef KILN_SCENE_VALIDATE_H
#define KILN_SCENE_VALIDATE_H

#include "scene/options.h"

/* Fills the members that follow from the options (steps, capacities, bounds) and refuses scenes
 * that cannot run. root is the tree, for the places of errors. scene->keys is set. */
bool kiln_validate(struct kiln_reader *reader, const struct kiln_node *root);

#endif
