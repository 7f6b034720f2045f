/* Runs processes in parallel: the tests of `kiln test`, the jobs of `kiln render --batch`. A crash,
 * a hang or a leak of one does not affect the others. */
#ifndef KILN_CMD_POOL_H
#define KILN_CMD_POOL_H

#include <signal.h>
#include <sys/types.h>

#include "kiln_program.h"

/* The end of a task. Of the first three members, at most one is set. */
struct pool_end {
    char problem[256]; /* why it could not be started, or "" */
    bool timed_out;    /* it was ended at its limit */
    int signal;        /* that ended it, or 0 */
    int exit_code;
    double total_s;
};

struct pool_start {
    const sigset_t *mask; /* the signals that a process shall have blocked */
    double time_limit_s;  /* to be set: of the wall clock */
    const char *problem;  /* to be set where a task cannot be started, whenever that is tried */
};

struct pool {
    size_t count;
    uint32_t jobs; /* processes at a time, at least 1 */
    /* Starts a task in a process group of its own. Its id, or below 0 with errno. */
    pid_t (*start)(void *user, size_t index, struct pool_start *start);
    void (*ended)(void *user, size_t index, const struct pool_end *end); /* in any order */
    bool (*stop)(void *user);   /* asked a few times a second; true ends all processes */
    bool (*enough)(void *user); /* true: none is started any more; NULL: all are */
    void *user;
};

/* The processors that this process may use; at least 1. */
uint32_t pool_cores(void);

/* Runs tasks 0 to count-1 and waits for them; no process is left when it returns. The caller must
 * have no other threads or children. False with KILN_INTERRUPTED after a stop (`ended` is not told
 * of the tasks that it hit), or with KILN_DEVICE_FAILED when memory is short. */
bool pool_run(const struct pool *pool, struct kiln_error *error);

#endif
