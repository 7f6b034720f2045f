/* Declares a job: it draws frames of a scene and hands on their pictures. kiln_render runs a whole
 * job; a caller that has several at once takes them frame by frame. */
#ifndef KILN_JOB_JOB_H
#define KILN_JOB_JOB_H

#include "frame/loop.h"

struct kiln_job;

/* Checks the frames, opens the outputs and sets all stages up. Everything is borrowed until the job
 * is destroyed; errors are those of kiln_render. */
struct kiln_job *kiln_job_create(struct kiln_device *device, const struct kiln_scene *scene,
                                 const struct kiln_render_params *params, struct kiln_error *error);

/* Gives up a job that is not finished: no output stays half-written. */
void kiln_job_destroy(struct kiln_job **job);

/* Its frame loop, which belongs to it. */
struct kiln_loop *kiln_job_loop(struct kiln_job *job);

/* Draws the next frame that is wanted and not there, and hands it to the output; none is left where
 * *drawn is false. */
bool kiln_job_next(struct kiln_job *job, bool *drawn, struct kiln_error *error);

/* Draws a frame, no earlier one than before, and hands it to the output. */
bool kiln_job_draw(struct kiln_job *job, uint32_t frame, struct kiln_error *error);

/* Hands over the picture of the frame that was drawn last, of a job with `keep_frames`, which
 * nobody writes to; NULL when none was drawn since. */
struct kiln_picture *kiln_job_take_picture(struct kiln_job *job);

/* The progress after the frame that was drawn last. */
const struct kiln_progress *kiln_job_progress(const struct kiln_job *job);

/* Waits until the outputs are whole, and sums up. */
bool kiln_job_finish(struct kiln_job *job, struct kiln_render_stats *stats,
                     struct kiln_error *error);

/* Ends a job that failed: its manifest and its journal tell how far it came and why. */
void kiln_job_fail(struct kiln_job *job, const struct kiln_error *failure);

#endif
