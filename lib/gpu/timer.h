/* A kiln_timer measures how long each pass takes. On software GL it calls glFinish and reads a wall
 * clock, since timer queries are wrong there. On a GPU it reads timestamp queries back when the
 * frame is done, so that timing does not stall. */
#ifndef KILN_GPU_TIMER_H
#define KILN_GPU_TIMER_H

#include "base/thread.h"
#include "gpu/device.h"

struct kiln_timer; /* times the passes of one renderer */

/* If device is NULL, the timer uses only the wall clock. Returns NULL when memory is short. */
struct kiln_timer *kiln_timer_create(struct kiln_device *device);
void kiln_timer_destroy(struct kiln_timer **timer);

/* Mark the beginning and the end of a pass, which is also a debug group. Passes do not nest. If a
 * pass runs several times a frame, its times add up. */
void kiln_timer_begin(struct kiln_timer *timer, enum kiln_pass pass);
void kiln_timer_end(struct kiln_timer *timer);

/* Ends the frame. Writes the milliseconds of each pass since the last kiln_timer_collect; waits for
 * the GPU if necessary. */
void kiln_timer_collect(struct kiln_timer *timer, double pass_ms[KILN_PASS_COUNT]);

/* Starts to measure the serial time of passes, as kiln_threads_serial_seconds has it. The threads
 * are borrowed. */
void kiln_timer_measure_serial(struct kiln_timer *timer, struct kiln_threads *threads);

/* Writes the serial milliseconds of each pass since the last call. */
void kiln_timer_collect_serial(struct kiln_timer *timer, double serial_ms[KILN_PASS_COUNT]);

#endif
