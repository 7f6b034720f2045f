/* Declares the stage that steps the domains of gas of a scene. Gas reads the particles as they were
 * before a step; particles then read the gas (Heinz 2019, 2.3.2). Both techniques give the same
 * bits. */
#ifndef KILN_SIM_GAS_GAS_H
#define KILN_SIM_GAS_GAS_H

#include "gpu/device.h"
#include "particles/pool.h"
#include "scene/scene.h"
#include "sim/world/params.h"

enum kiln_gas_technique {
    KILN_GAS_CPU, /* host threads, in vectors */
    KILN_GAS_GL,  /* compute; the gas stays in GL until it is read (kiln_gas_fetch) */
};

struct gas_domain;
struct gas_kernels;

/* Fills the sums of a domain's forces in, at the points of a grid over its window. around: has the
 * grids that forces look up. */
struct kiln_gas_forces {
    void *context;
    void (*fill)(void *context, const struct kiln_sim *around, uint32_t domain,
                 const struct kiln_grid *grid, uint32_t step, float4 *words);
};

struct kiln_gas_stage {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct gas_domain *domains;
    struct gas_kernels *kernels; /* NULL: technique `cpu` */
    uint32_t count;              /* of domains, in the order of the scene; 0: all else is unused */
    uint32_t last_step;          /* that was run; 0: none */
    char warning[200];
    bool warned[KILN_MAX_GAS], told;
};

/* Prepares for a scene's gas. device: may be NULL for `cpu`. kiln_gas_stage_finish frees
 * everything, also after a failure. KILN_USAGE or KILN_NO_DEVICE when the device cannot run the
 * technique. */
bool kiln_gas_stage_init(struct kiln_gas_stage *stage, struct kiln_device *device,
                         const struct kiln_scene *scene, enum kiln_gas_technique technique,
                         struct kiln_threads *threads, struct kiln_error *error);
void kiln_gas_stage_finish(struct kiln_gas_stage *stage);

/* Adds the memory that stepping the gas of a scene takes, beside the gas itself
 * (scene/gas_shape.h). */
void kiln_gas_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Runs a step, from 1, on the pool's gas. params: of the step. KILN_DEVICE_FAILED when memory is
 * short or a number is not finite: the message says where; the caller's error when it wants no
 * more. The pool's gas must not be used after a failure. */
bool kiln_gas_stage_step(struct kiln_gas_stage *stage, struct kiln_pool *pool,
                         const struct kiln_sim_params *params, const struct kiln_gas_forces *forces,
                         uint32_t step, struct kiln_error *error);

/* Returns a warning about the steps so far, once; NULL: none. */
const char *kiln_gas_stage_warning(struct kiln_gas_stage *stage);

/* Returns the seconds of processors that each pass has taken (enum gas_timer of solver.h), of all
 * domains, and starts to count them if it is the first call. */
void kiln_gas_stage_seconds(struct kiln_gas_stage *stage, double seconds[]);

#endif
