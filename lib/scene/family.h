/* Systems whose particles are born of another system's particles. The slot of a parent stays taken
 * until all its descendants are dead. */
#ifndef KILN_SCENE_FAMILY_H
#define KILN_SCENE_FAMILY_H

#include "scene/scene.h"

struct kiln_reader;
struct kiln_node;

/* Is a system, other than by name alone, the parent of one that is enabled? */
bool kiln_family_has_children(const struct kiln_scene *scene, uint32_t system);

/* Every system, parents before their children. */
void kiln_family_order(const struct kiln_scene *scene, uint32_t order[KILN_MAX_SYSTEMS]);

/* The most children that a particle of the parent's may have: emit.parent.slots. */
uint64_t kiln_family_slots(const struct kiln_scene *scene, const struct kiln_parent *parent);

/* Steps after its birth step by whose end a particle and all that descends from it are dead; at
 * most `steps`. */
uint32_t kiln_family_lifespan(const struct kiln_scene *scene, uint32_t system, uint32_t steps);

/* Finds the parents by their names and how many slots their children take; refuses unknown ones,
 * rings, too many generations and events that can not happen. root is the tree, for the places of
 * errors. */
bool kiln_family_settle(struct kiln_reader *reader, const struct kiln_node *root);

#endif
