/* Starts the processes of `kiln test`: each test has one of its own. */
#ifndef KILN_CMD_TEST_POOL_H
#define KILN_CMD_TEST_POOL_H

#include "pool.h"

/* Starts run(user, index) in a new process, whose exit code it returns. The file `log` gets
 * standard output and standard error of the process. Returns what pool.start returns. */
pid_t test_pool_start(struct pool_start *start, const char *log,
                      int (*run)(void *user, size_t index), void *user, size_t index);

#endif
