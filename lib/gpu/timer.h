/* A kiln_timer measures how long each pass takes. On software GL it reads a wall clock around
 * glFinish, since the timer queries there are wrong. On a GPU it reads timestamp queries back when
 * the frame is done, so that timing does not stall. */
#ifndef KILN_GPU_TIMER_H
#define KILN_GPU_TIMER_H

#include "gpu/device.h"

struct kiln_timer; /* the passes of one renderer */

/* device NULL: wall clock only. */
struct kiln_timer *kiln_timer_create(struct kiln_device *device);
void kiln_timer_destroy(struct kiln_timer **timer);

/* Mark the beginning and the end of a pass; passes do not nest. A pass may run several times a
 * frame: its times add up. The pass is a debug group as well. */
void kiln_timer_begin(struct kiln_timer *timer, enum kiln_pass pass);
void kiln_timer_end(struct kiln_timer *timer);

/* Ends the frame. Writes the milliseconds of each pass since the last collect and waits for the GPU
 * if needed. */
void kiln_timer_collect(struct kiln_timer *timer, double pass_ms[KILN_PASS_COUNT]);

#endif
