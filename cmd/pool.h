/* Runs processes in parallel: the tests of `kiln test`, the jobs of `kiln render --batch`. A crash,
 * a hang or a leak of one process does not affect the others. */
#ifndef KILN_CMD_POOL_H
#define KILN_CMD_POOL_H

#include <signal.h>
#include <sys/types.h>

#include "kiln_program.h"

/* How a task ended. At most one of the first three members is set. */
struct pool_end {
    char problem[256]; /* why it could not be started, or "" */
    bool timed_out;    /* it was ended at its time limit */
    int signal;        /* the signal that ended it, or 0 */
    int exit_code;
    double total_s;
};

struct pool_start {
    const sigset_t *mask; /* the signal mask that the new process must set */
    double time_limit_s;  /* `start` may set it: limit of real time */
    const char *problem;  /* `start` sets it if the task can never be started */
};

struct pool {
    size_t count;
    uint32_t jobs; /* processes at a time, at least 1 */
    /* Starts a task in a process group of its own. Returns its id, or below 0 with errno. */
    pid_t (*start)(void *user, size_t index, struct pool_start *start);
    void (*ended)(void *user, size_t index, const struct pool_end *end); /* called in any order */
    bool (*stop)(void *user);    /* asked a few times a second; true ends all processes */
    bool (*no_more)(void *user); /* true: no more tasks are started; NULL: all are */
    void *user;
};

/* Returns the number of processors that this process may use, at least 1. */
uint32_t pool_cores(void);

/* Runs tasks 0 to count-1 and waits for them; no process is left when it returns. The caller must
 * have no other threads or children. Returns false with KILN_INTERRUPTED after a stop (`ended` is
 * not called for the tasks that were stopped), or with KILN_DEVICE_FAILED when memory is short. */
bool pool_run(const struct pool *pool, struct kiln_error *error);

#endif
