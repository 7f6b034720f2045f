/* Systems whose particles are born of another system's particles. The slot of a parent stays taken
 * until all its descendants are dead. */
#ifndef KILN_SCENE_FAMILY_H
#define KILN_SCENE_FAMILY_H

#include "scene/scene.h"

struct kiln_reader;
struct kiln_node;

/* Returns whether a system is the parent of a system that is enabled. */
bool kiln_family_has_children(const struct kiln_scene *scene, uint32_t system);

/* Returns how many impacts the particles of a system count: up to the last that has children, at
 * least 1. */
uint32_t kiln_family_counted_hits(const struct kiln_scene *scene, uint32_t system);

/* Returns whether a system's particles have ways: children by the metre, or of more impacts than a
 * birth word counts. */
bool kiln_family_travels(const struct kiln_scene *scene, uint32_t system);

/* Returns whether particles of a system inherit something of their parent's look, and whether those
 * of a system have children that do. */
bool kiln_family_inherits(const struct kiln_system *system);
bool kiln_family_is_inherited(const struct kiln_scene *scene, uint32_t system);

/* Returns whether particles of a system may rest from their birth: they are drawn on surfaces, and
 * are born of impacts. */
bool kiln_family_lies_from_birth(const struct kiln_system *system);

/* Fills order[] with all systems, parents before their children. */
void kiln_family_order(const struct kiln_scene *scene, uint32_t order[KILN_MAX_SYSTEMS]);

/* Returns the most children that one particle of the parent may have: emit.parent.slots. */
uint64_t kiln_family_slots(const struct kiln_scene *scene, const struct kiln_parent *parent);

/* Returns the number of steps after its birth step at whose end a particle and all its descendants
 * are dead; at most `steps`. */
uint32_t kiln_family_lifespan(const struct kiln_scene *scene, uint32_t system, uint32_t steps);

/* Finds the system that the option at a path names; false with an error that names similar ones. */
bool kiln_family_find_system(struct kiln_reader *reader, const struct kiln_node *root,
                             const char *path, const char *name, uint32_t *system);

/* Finds the parents by their names and computes the slots of their children. Refuses unknown names,
 * cycles, too many generations and events that cannot happen. root is the tree, for the places of
 * errors. */
bool kiln_family_settle(struct kiln_reader *reader, const struct kiln_node *root);

#endif
