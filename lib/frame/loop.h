/* A job frame by frame, for who has several at once; kiln_render is the loop over one. */
#ifndef KILN_FRAME_LOOP_H
#define KILN_FRAME_LOOP_H

#include "kiln.h"

struct kiln_loop;

/* Chooses techniques, opens outputs and sets all stages up. Everything is borrowed until the job is
 * destroyed; errors are those of kiln_render. */
struct kiln_loop *kiln_loop_create(struct kiln_device *device, const struct kiln_scene *scene,
                                   const struct kiln_render_params *params,
                                   struct kiln_error *error);

/* What is not finished is given up: no output stays half-written. */
void kiln_loop_destroy(struct kiln_loop **loop);

/* Steps to where a frame starts, if it is not there yet, and draws nothing. */
bool kiln_loop_advance(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error);

/* Takes over the particles of another job of the same scene, whatever techniques either has. */
bool kiln_loop_adopt(struct kiln_loop *loop, struct kiln_loop *from, struct kiln_error *error);

/* Draws a frame, no earlier one than before, and hands it to the output. */
bool kiln_loop_draw(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error);

/* Of the frame drawn last. */
const struct kiln_progress *kiln_loop_progress(const struct kiln_loop *loop);

/* Waits until the outputs are whole, and sums up. */
bool kiln_loop_finish(struct kiln_loop *loop, struct kiln_render_stats *stats,
                      struct kiln_error *error);

#endif
