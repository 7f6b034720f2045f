/* Computes how long tasks take on several machines. */
#ifndef KILN_BENCH_SCHEDULE_H
#define KILN_BENCH_SCHEDULE_H

#include <stddef.h>
#include <stdint.h>

enum { KILN_MAX_WORKERS = 1000 };

/* Returns the seconds until all tasks have ended. The tasks begin in their order, each on the
 * worker that is free first, as schedulers run the tasks of an array. There are 1 to
 * KILN_MAX_WORKERS workers. */
double kiln_schedule_s(const double *tasks_s, size_t count, uint32_t workers);

#endif
