/* Holds what a step is told: the scene at one time, in the layout of the shaders. Births are
 * counted here, on the host, so that they have the same order in all techniques. */
#ifndef KILN_SIM_WORLD_PARAMS_H
#define KILN_SIM_WORLD_PARAMS_H

#include "particles/pool.h"
#include "scene/family.h"
#include "sim/world/grids.h"

struct kiln_sim_params {
    uint32_t system_count;
    struct kiln_step_params systems[KILN_MAX_SYSTEMS];
    struct kiln_surroundings surroundings;
    struct kiln_sim_grids *grids;     /* of the scene */
    uint32_t order[KILN_MAX_SYSTEMS]; /* of the systems in a step: parents before their children */
    uint32_t trace_count;             /* of the systems with children or paint: one a slot */
    uint32_t push_count;              /* of the systems that interact: one a slot */
    uint32_t spin_count;              /* of those that spin: one a slot */
    bool spins[KILN_MAX_SYSTEMS];     /* which do: see kiln_pool_add_spins */
};

/* Does the system need the kernel for families (shared/step_family.h)? */
bool kiln_sim_is_family(const struct kiln_step_params *params);

/* Does any system need the kernels that know all forces and integrators (shared/force.h)? */
bool kiln_sim_needs_all_forces(const struct kiln_scene *scene);

/* Fills in all that does not change during a run. The grids must outlive the parameters. */
void kiln_sim_params_init(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_sim_grids *grids);

/* Counts the births of the step into the pool and fills in the rest: values over time become
 * constants, all but the emitter's, which each birth takes at its own time. False with
 * KILN_INVALID_INPUT when serials or the slots of a system run out. */
bool kiln_sim_params_step(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_pool *pool, uint32_t step, struct kiln_error *error);

#endif
