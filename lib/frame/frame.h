/* A job frame by frame, for who has several at once; kiln_render is the loop over one. */
#ifndef KILN_FRAME_H
#define KILN_FRAME_H

#include "kiln.h"

struct kiln_job;

/* Chooses techniques, opens outputs and sets all stages up. Everything is borrowed until the job is
 * destroyed; errors are those of kiln_render. */
struct kiln_job *kiln_job_create(struct kiln_device *device, const struct kiln_scene *scene,
                                 const struct kiln_render_params *params, struct kiln_error *error);

/* What is not finished is given up: no output stays half-written. */
void kiln_job_destroy(struct kiln_job **job);

/* Steps to where a frame starts, if it is not there yet, and draws nothing. */
bool kiln_job_advance(struct kiln_job *job, uint32_t frame, struct kiln_error *error);

/* Takes over the particles of another job of the same scene, whatever techniques either has. */
bool kiln_job_adopt(struct kiln_job *job, struct kiln_job *from, struct kiln_error *error);

/* Draws a frame, no earlier one than before, and hands it to the output. */
bool kiln_job_draw(struct kiln_job *job, uint32_t frame, struct kiln_error *error);

/* Of the frame drawn last. */
const struct kiln_progress *kiln_job_progress(const struct kiln_job *job);

/* Waits until the outputs are whole, and sums up. */
bool kiln_job_finish(struct kiln_job *job, struct kiln_render_stats *stats,
                     struct kiln_error *error);

#endif
