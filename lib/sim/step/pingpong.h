/* Declares technique `pingpong`, which steps particles in compute from one buffer of records to
 * another. The two buffers are exchanged after each step. */
#ifndef KILN_SIM_STEP_PINGPONG_H
#define KILN_SIM_STEP_PINGPONG_H

#include "sim/step/blocks.h"

struct kiln_pingpong {
    struct kiln_sim_programs programs;
    struct kiln_buffer second; /* as large as the pool's records */
};

/* Creates the programs. kiln_pingpong_finish frees everything, also after a failure. */
bool kiln_pingpong_init(struct kiln_pingpong *pingpong, struct kiln_device *device,
                        const struct kiln_scene *scene, const struct kiln_sim_params *params,
                        struct kiln_error *error);
void kiln_pingpong_finish(struct kiln_pingpong *pingpong);

/* Runs a step, whose blocks have been uploaded. The pool must always be the same one, since slots
 * that never had a birth have to be empty in both buffers. */
bool kiln_pingpong_step(struct kiln_pingpong *pingpong, const struct kiln_sim_blocks *blocks,
                        const struct kiln_sim_params *params, struct kiln_pool *pool,
                        struct kiln_error *error);

#endif
