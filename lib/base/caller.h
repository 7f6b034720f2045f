/* Lets a long operation ask whoever started it whether it still wants the result; if not, the error
 * says why. A job makes such a caller from its program's callback, a cancel request and limits
 * (lib/job/stop.h), and so does the loader of a scene's files.
 *
 * The frame loop asks between steps and passes, loops over pixels ask between bands of rows
 * (kiln_threads_try), the loader while it waits for a decoder, and an output while it ends a clip.
 * An operation asks on the thread that runs it, and often, so an answer must be quick; one that is
 * told false must give up with that error. */
#ifndef KILN_BASE_CALLER_H
#define KILN_BASE_CALLER_H

#include "kiln.h"

struct kiln_caller {
    bool (*may_go_on)(void *user, struct kiln_error *error); /* NULL: it always may */
    void *user;
};

/* Returns whether the operation may go on; without a caller (NULL) it may. */
static inline bool kiln_may_go_on(const struct kiln_caller *caller, struct kiln_error *error)
{
    return !caller || !caller->may_go_on || caller->may_go_on(caller->user, error);
}

#endif
