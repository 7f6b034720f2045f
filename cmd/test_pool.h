/* The processes of `kiln test`: each test has one of its own, so that a crash, a hang or a leak of
 * one is nothing to the others. */
#ifndef KILN_CMD_TEST_POOL_H
#define KILN_CMD_TEST_POOL_H

#include "kiln_program.h"

/* What a process is given. */
struct test_task {
    const char *log;     /* the file that gets its output, both streams */
    double time_limit_s; /* of the wall clock */
};

/* What became of it. Of the first three, at most one is set. */
struct test_end {
    char problem[256]; /* why it could not be started, or "" */
    bool timed_out;    /* it was ended at its limit */
    int signal;        /* that ended it, or 0 */
    int exit_code;
    double total_s;
};

struct test_pool {
    size_t count;
    uint32_t jobs; /* processes at a time, at least 1 */
    struct test_task (*task)(void *user, size_t index);
    int (*run)(void *user, size_t index); /* in the new process; returns its exit code */
    void (*ended)(void *user, size_t index, const struct test_end *end); /* in any order */
    bool (*stop)(void *user); /* asked a few times a second; true ends all processes */
    void *user;
};

/* Runs tasks 0 to count-1 and waits for them; no process is left when it returns. The caller must
 * have no other threads or children. False with KILN_INTERRUPTED after a stop (`ended` is not told
 * of the tasks that it hit), or with KILN_DEVICE_FAILED when memory is short. */
bool test_pool_run(const struct test_pool *pool, struct kiln_error *error);

#endif
