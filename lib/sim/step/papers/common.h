/* Declares what several techniques of this folder need. */
#ifndef KILN_SIM_STEP_PAPERS_COMMON_H
#define KILN_SIM_STEP_PAPERS_COMMON_H

#include "gpu/probe.h"
#include "sim/step/blocks.h"

/* Checks that particles can be moved in this stage, which is not compute. KILN_NO_DEVICE when the
 * device is not exact there, or has too few storage blocks there for scenes with children or
 * grids. */
bool kiln_sim_check_stage(struct kiln_device *device, const struct kiln_sim_params *params,
                          enum kiln_probe_stage stage, struct kiln_error *error);

#define KILN_SIM_SECOND "particles, second" /* label of a second buffer */

/* Returns the GL buffer of a technique's second buffer, as large as the pool's, or 0 with an error.
 * It starts as zeros, and its contents stay as long as the pool exists. */
GLuint kiln_sim_second(struct kiln_buffer *second, const struct kiln_pool *pool,
                       struct kiln_error *error);

#endif
