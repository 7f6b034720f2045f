/* Declares what the systems of a program use of a step's code (shaders/shared/uses.h). */
#ifndef KILN_SIM_STEP_USES_H
#define KILN_SIM_STEP_USES_H

#include "sim/world/params.h"

struct kiln_text;

/* Returns the mask of the kinds of colliders, COLLIDER_*, that a scene has. */
uint kiln_sim_colliders_used(const struct kiln_scene *scene);

/* Adds the "#define" lines of the masks, for the systems of one of the two programs of a kernel:
 * those of families, or the others. Needs parameters that kiln_sim_params_init has filled. */
void kiln_sim_add_uses(struct kiln_text *defines, const struct kiln_scene *scene,
                       const struct kiln_sim_params *params, bool families);

/* Does the same for the kernel that writes baked winds. */
void kiln_sim_add_bake_uses(struct kiln_text *defines, const struct kiln_scene *scene,
                            const struct kiln_sim_grids *grids);

#endif
