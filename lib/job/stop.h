/* Decides whether the work of a job goes on: its caller may want no more, or a limit is reached.
 * What has not ended half a second later, the program ends: after a signal by a timer
 * (cmd/signals.c), at a limit by a thread (cmd/limits.c). */
#ifndef KILN_JOB_STOP_H
#define KILN_JOB_STOP_H

#include "base/caller.h"
#include "gpu/device.h"

struct kiln_stop {
    bool (*stop)(void *user); /* NULL: nobody asks */
    void *user;
    struct kiln_device *device; /* becomes current again, whatever `stop` did; NULL: none */
    struct kiln_budget *budget;
    const struct kiln_cancel *cancel;
};

/* A caller for what a job asks to be done. The stop must outlive it. */
struct kiln_caller kiln_stop_caller(struct kiln_stop *stop);

/* False with KILN_INTERRUPTED or KILN_OVER_LIMIT. */
bool kiln_stop_ask(const struct kiln_stop *stop, struct kiln_error *error);

#endif
