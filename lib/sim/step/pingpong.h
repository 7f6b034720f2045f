/* Technique `pingpong`: the step in compute, from one buffer of records to another; the two change
 * places after each step. */
#ifndef KILN_SIM_STEP_PINGPONG_H
#define KILN_SIM_STEP_PINGPONG_H

#include "sim/step/blocks.h"

struct kiln_pingpong {
    struct kiln_sim_programs programs;
    struct kiln_buffer second; /* as the pool's records */
};

/* After a failure, too, kiln_pingpong_finish frees what there is. */
bool kiln_pingpong_init(struct kiln_pingpong *pingpong, struct kiln_device *device,
                        const struct kiln_scene *scene, const struct kiln_sim_params *params,
                        struct kiln_error *error);
void kiln_pingpong_finish(struct kiln_pingpong *pingpong);

/* The step's blocks have been uploaded. Always with the same pool: slots that were never born into
 * are empty in both buffers. */
bool kiln_pingpong_step(struct kiln_pingpong *pingpong, const struct kiln_sim_blocks *blocks,
                        const struct kiln_sim_params *params, struct kiln_pool *pool,
                        struct kiln_error *error);

#endif
