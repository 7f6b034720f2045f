/* Decides whether the work of a job goes on: its caller may want no more, or a limit is reached.
 * The program ends work that goes on for half a second more: after a signal by a timer
 * (cmd/signals.c), at a limit by a thread (cmd/limits.c). */
#ifndef KILN_JOB_STOP_H
#define KILN_JOB_STOP_H

#include "base/caller.h"
#include "gpu/device.h"

struct kiln_stop {
    bool (*stop)(void *user); /* asks the caller; NULL: the caller cannot cancel */
    void *user;
    /* made current again after `stop`, which may have changed it; NULL: none */
    struct kiln_device *device;
    struct kiln_budget *budget;
    const struct kiln_cancel *cancel;
};

/* Makes a caller (base/caller.h) for operations that the job starts. `stop` must outlive it. */
struct kiln_caller kiln_stop_caller(struct kiln_stop *stop);

/* Returns true when the job goes on, else false with KILN_INTERRUPTED or KILN_OVER_LIMIT. */
bool kiln_stop_ask(const struct kiln_stop *stop, struct kiln_error *error);

#endif
