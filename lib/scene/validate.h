/* Checks what no single option can: options that must agree, and what a run would need. */
#ifndef KILN_SCENE_VALIDATE_H
#define KILN_SCENE_VALIDATE_H

#include "scene/options.h"

/* Fills what follows from the options (steps, capacities, bounds) and refuses what cannot run. root
 * is the tree, for the places of errors. scene->keys is set. */
bool kiln_validate(struct kiln_reader *reader, const struct kiln_node *root);

#endif
