/* Asks the caller of a long operation whether it still wants the result; if not, the error says
 * why. The frame loop asks between steps and passes, loops over pixels between bands of rows
 * (kiln_threads_try), and an output while it ends a clip. */
#ifndef KILN_BASE_CALLER_H
#define KILN_BASE_CALLER_H

#include "kiln.h"

struct kiln_caller {
    bool (*may_go_on)(void *user, struct kiln_error *error); /* may be NULL: always true */
    void *user;
};

/* True without a caller. */
static inline bool kiln_may_go_on(const struct kiln_caller *caller, struct kiln_error *error)
{
    return !caller || !caller->may_go_on || caller->may_go_on(caller->user, error);
}

#endif
