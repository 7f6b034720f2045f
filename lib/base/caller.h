/* Lets a long operation ask its caller whether to go on. A struct kiln_caller is the callback that
 * answers. A job makes one from the application's callback, a cancel request and limits
 * (lib/job/stop.h); the loader of a scene's files makes one from those of its own parameters.
 *
 * The frame loop asks between steps and passes, loops over pixels ask between bands of rows
 * (kiln_threads_try), the loader asks while it waits for a decoder, and an output while it finishes
 * a file. An operation asks on the thread that called it; the workers of its loops do not ask. It
 * asks often, so an answer must be quick. */
#ifndef KILN_BASE_CALLER_H
#define KILN_BASE_CALLER_H

#include "kiln.h"

struct kiln_caller {
    /* Returns false, with the reason in `error`, when the operation must stop. NULL: it may always
     * go on. */
    bool (*may_go_on)(void *user, struct kiln_error *error);
    void *user;
};

/* Returns whether the operation may go on; without a caller (NULL) it may. On false, the operation
 * must give up and keep the error. */
static inline bool kiln_may_go_on(const struct kiln_caller *caller, struct kiln_error *error)
{
    return !caller || !caller->may_go_on || caller->may_go_on(caller->user, error);
}

#endif
