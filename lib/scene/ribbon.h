/* Ribbons are drawn through the particles of a system in the order of their births (look.shape:
 * ribbon). A system whose particles are born one after the other has one ribbon. One whose
 * particles are born in bursts has a ribbon for each burst, and one whose particles are children
 * has one for each parent, or for each of its events. */
#ifndef KILN_SCENE_RIBBON_H
#define KILN_SCENE_RIBBON_H

#include "scene/scene.h"

struct kiln_reader;
struct kiln_node;

/* Returns the most parts that a segment of any ribbon is drawn as; 0: there are no ribbons. */
uint32_t kiln_ribbon_most_parts(const struct kiln_scene *scene);

/* Returns how many serials a ribbon of a system takes; 0: all of them. */
uint32_t kiln_ribbon_run(const struct kiln_system *system);

/* Returns whether the youngest particle of a ribbon is joined to its living parent. */
bool kiln_ribbon_joins_parent(const struct kiln_system *system);

/* Returns whether the particles of a ribbon are born at once, so that places on it are counted, and
 * do not follow from their ages. */
bool kiln_ribbon_is_at_once(const struct kiln_system *system);

/* Returns the particles in a metre of a ribbon; 0 unless they are born by the metre. */
double kiln_ribbon_per_metre(const struct kiln_system *system);

/* Refuses ribbons that have no order, such as those of a rate and of bursts. root is the tree, for
 * the places of errors. */
bool kiln_ribbons_check(struct kiln_reader *reader, const struct kiln_node *root);

#endif
