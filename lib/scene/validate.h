/* What no single option can check: options that must agree, and what a run would need. */
#ifndef KILN_SCENE_VALIDATE_H
#define KILN_SCENE_VALIDATE_H

#include "scene/reader.h"

/* Fills what follows from the options (steps, capacities, bounds) and refuses what cannot run. root
 * is the tree, for the places of errors. scene->keys is set. */
bool kiln_validate(struct kiln_reader *reader, const struct kiln_node *root);

/* An upper bound of the slots that a system needs, at least 1, and of its births in a whole run:
 * Serial s lives in slot s mod capacity, so every window as long as the longest life must fit. */
struct kiln_demand {
    uint64_t slots, births;
};
struct kiln_demand kiln_demand(const struct kiln_scene *scene, const struct kiln_system *system);

#endif
