/* Declares technique `inplace`, which steps each system in one compute dispatch, with the records
 * in one GL buffer. */
#ifndef KILN_SIM_STEP_INPLACE_H
#define KILN_SIM_STEP_INPLACE_H

#include "sim/step/blocks.h"

/* Creates the programs. kiln_sim_programs_finish frees everything, also after a failure. */
bool kiln_inplace_init(struct kiln_sim_programs *programs, struct kiln_device *device,
                       const struct kiln_scene *scene, const struct kiln_sim_params *params,
                       struct kiln_error *error);

/* Runs a step, whose blocks have been uploaded. */
bool kiln_inplace_step(const struct kiln_sim_programs *programs,
                       const struct kiln_sim_blocks *blocks, const struct kiln_sim_params *params,
                       struct kiln_pool *pool, struct kiln_error *error);

#endif
