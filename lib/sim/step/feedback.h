/* Declares technique `feedback`, which steps particles in geometry shaders. Transform feedback
 * captures the living particles in a second buffer, without gaps. Then they are copied back into
 * the pool's slots, which the other stages read. */
#ifndef KILN_SIM_STEP_FEEDBACK_H
#define KILN_SIM_STEP_FEEDBACK_H

#include "gpu/capture.h"
#include "sim/step/blocks.h"

struct kiln_feedback {
    struct kiln_capture capture;
    struct kiln_sim_programs move, emit;
    GLuint place_program;
    /* transform feedback objects, which also have the number of captured particles */
    GLuint moved, born;
    struct kiln_buffer stream; /* as large as the pool's records */
};

/* Creates the technique. KILN_NO_DEVICE when the device is not exact in the geometry stage, or, in
 * scenes with children, has no storage blocks there. kiln_feedback_finish frees everything, also
 * after a failure. */
bool kiln_feedback_init(struct kiln_feedback *feedback, struct kiln_device *device,
                        const struct kiln_scene *scene, const struct kiln_sim_params *params,
                        struct kiln_error *error);
void kiln_feedback_finish(struct kiln_feedback *feedback);

/* Runs a step, whose blocks have been uploaded. */
bool kiln_feedback_step(struct kiln_feedback *feedback, const struct kiln_sim_blocks *blocks,
                        const struct kiln_sim_params *params, struct kiln_pool *pool,
                        struct kiln_error *error);

#endif
