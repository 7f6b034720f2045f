/* Declares what a technique of the simulation in GL is: a row of the table in simulate.c. The file
 * of each technique ends with its row. */
#ifndef KILN_SIM_STEP_ROW_H
#define KILN_SIM_STEP_ROW_H

#include "sim/step/blocks.h"

struct kiln_simulate_row {
    size_t copies; /* how often the technique holds the records */
    size_t size;   /* bytes of the technique's own state */
    /* Sets up a state of zeros. Fills the error with KILN_NO_DEVICE when the device lacks what the
     * technique needs. finish frees what the state refers to, also after init has failed. */
    bool (*init)(void *technique, struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_sim_params *params, struct kiln_error *error);
    void (*finish)(void *technique);
    /* Runs step number `step`, whose blocks have been uploaded. The pool must always be the same
     * one. */
    bool (*step)(void *technique, const struct kiln_sim_blocks *blocks,
                 const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t step,
                 struct kiln_error *error);
};

extern const struct kiln_simulate_row kiln_simulate_inplace_row; /* inplace.c */

#endif
