/* Declares the check of the regions in which forces act. */
#ifndef KILN_SCENE_REGIONS_H
#define KILN_SCENE_REGIONS_H

#include "scene/options.h"

/* Checks that each region of the forces of an owner, a system or a domain of gas, has one shape
 * (kiln_owner_force). */
bool kiln_regions_check(struct kiln_reader *reader, const struct kiln_node *root, uint32_t owner);

#endif
