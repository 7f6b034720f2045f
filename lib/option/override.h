/* --set key=value. */
#ifndef KILN_SCENE_OVERRIDE_H
#define KILN_SCENE_OVERRIDE_H

#include "option/node.h"

/* Puts the value of "dotted.key=value" into the tree, before anything is converted; mappings that
 * are missing on the way are made, entries of lists and named entries are not. The text need not
 * outlive the call. */
bool kiln_override(struct kiln_arena *arena, struct kiln_node *root, const char *text,
                   struct kiln_error *error);

#endif
