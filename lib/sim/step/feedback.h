/* Technique `feedback`: the step in geometry shaders, whose vertices are captured in a second
 * buffer by transform feedback: the stream of the living, without holes. Then the stream goes back
 * into the pool's slots, where the other stages look. */
#ifndef KILN_SIM_STEP_FEEDBACK_H
#define KILN_SIM_STEP_FEEDBACK_H

#include "gpu/capture.h"
#include "sim/step/blocks.h"

struct kiln_feedback {
    struct kiln_capture capture;
    struct kiln_sim_programs move, emit;
    GLuint place_program;
    GLuint moved, born; /* transform feedback objects: they know how many there are of each */
    struct kiln_buffer stream; /* as large as the pool's records */
};

/* KILN_NO_DEVICE when the device is not exact in the geometry stage, or, in scenes with children,
 * has no storage blocks there. After a failure, too, kiln_feedback_finish frees what there is. */
bool kiln_feedback_init(struct kiln_feedback *feedback, struct kiln_device *device,
                        const struct kiln_scene *scene, const struct kiln_sim_params *params,
                        struct kiln_error *error);
void kiln_feedback_finish(struct kiln_feedback *feedback);

/* The step's blocks have been uploaded. */
bool kiln_feedback_step(struct kiln_feedback *feedback, const struct kiln_sim_blocks *blocks,
                        const struct kiln_sim_params *params, struct kiln_pool *pool,
                        struct kiln_error *error);

#endif
