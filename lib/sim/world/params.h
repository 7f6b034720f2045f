/* Declares the parameters of a step: the scene at one time, in the layout of the shaders. Births
 * are counted on the host when the parameters are made, so that they have the same order in all
 * techniques. */
#ifndef KILN_SIM_WORLD_PARAMS_H
#define KILN_SIM_WORLD_PARAMS_H

#include "particles/pool.h"
#include "scene/family.h"
#include "sim/world/grids.h"

struct kiln_sim_params {
    uint32_t system_count;
    struct kiln_step_params systems[KILN_MAX_SYSTEMS];
    struct kiln_surroundings surroundings;
    struct kiln_sim_grids *grids; /* grids of the scene */
    /* the systems in the order of stepping: parents before their children */
    uint32_t order[KILN_MAX_SYSTEMS];
    /* slots of the systems with children or paint, which have traces */
    uint32_t trace_count;
    uint32_t push_count; /* slots of the systems that interact */
    uint32_t spin_count; /* slots of the systems whose particles spin */
};

/* Returns whether a system needs the kernel for families (shared/step_family.h). */
bool kiln_sim_is_family(const struct kiln_step_params *params);

/* Returns whether any system needs the kernels that have all forces and integrators
 * (shared/force.h). */
bool kiln_sim_needs_all_forces(const struct kiln_scene *scene);

/* Returns whether the kernel that writes baked winds needs them. */
bool kiln_sim_bakes_need_all_forces(const struct kiln_scene *scene,
                                    const struct kiln_sim_grids *grids);

/* Returns whether the particles of a system leave traces, for the births of children or for
 * paint. */
bool kiln_sim_is_traced(const struct kiln_scene *scene, uint32_t system);

/* Fills in what of an emitter does not change during a run, but where its words begin. */
void kiln_sim_emitter_fill(struct kiln_emit_params *params, const struct kiln_emitter *emit);

/* Fills in all that does not change during a run. The grids must outlive the parameters. */
void kiln_sim_params_init(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_sim_grids *grids);

/* Counts the births of the step into the pool, and fills in what births depend on. False with
 * KILN_INVALID_INPUT when serials or the slots of a system run out. */
bool kiln_sim_params_births(struct kiln_sim_params *params, const struct kiln_scene *scene,
                            struct kiln_pool *pool, uint32_t step, struct kiln_error *error);

/* Counts the births of the step into the pool, and fills in the rest. Values over time become
 * constants, except the emitter's, which each birth evaluates at its own time. False with
 * KILN_INVALID_INPUT when serials or the slots of a system run out. */
bool kiln_sim_params_step(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_pool *pool, uint32_t step, struct kiln_error *error);

#endif
