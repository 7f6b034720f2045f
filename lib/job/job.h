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

/* Destroys a job, finished or not. An unfinished output is removed. */
void kiln_job_destroy(struct kiln_job **job);

/* Returns the job's frame loop; the job keeps ownership. */
struct kiln_loop *kiln_job_loop(struct kiln_job *job);

/* Draws the next frame that is wanted and not there, and hands it to the output. *drawn becomes
 * false when no frame is left. */
bool kiln_job_next(struct kiln_job *job, bool *drawn, struct kiln_error *error);

/* Draws a frame and hands it to the output. Its number may not be below that of the frame
 * before. */
bool kiln_job_draw(struct kiln_job *job, uint32_t frame, struct kiln_error *error);

/* Hands over the picture of the last drawn frame, for a job with `keep_frames`. Nothing writes to
 * its pixels afterwards. NULL when the picture was taken before, or no frame was drawn. */
struct kiln_picture *kiln_job_take_picture(struct kiln_job *job);

/* Returns the progress after the last drawn frame. */
const struct kiln_progress *kiln_job_progress(const struct kiln_job *job);

/* Waits until the output files are whole, and fills the statistics. */
bool kiln_job_finish(struct kiln_job *job, struct kiln_render_stats *stats,
                     struct kiln_error *error);

/* Ends a job that failed: writes to its manifest and its journal which frames are there, and the
 * error. */
void kiln_job_fail(struct kiln_job *job, const struct kiln_error *failure);

#endif
