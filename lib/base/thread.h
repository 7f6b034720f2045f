/* Worker threads for loops over ranges. */
#ifndef KILN_BASE_THREAD_H
#define KILN_BASE_THREAD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct kiln_threads;

/* Processors that this process may run on, at most 256. */
uint32_t kiln_threads_available(void);

/* A pool of count workers, the caller counted as one; 0 takes one for each processor that this
 * process may run on, more than 256 is taken as 256. NULL when the system refuses. */
struct kiln_threads *kiln_threads_create(uint32_t count);
void kiln_threads_destroy(struct kiln_threads **threads);
uint32_t kiln_threads_count(const struct kiln_threads *threads);

/* Calls body(context, begin, end, worker) until [0, count) is covered in pieces of at most `grain`,
 * and returns when all have ended. Which worker gets which piece is up to chance: a body must write
 * only what its piece or its worker index (0 .. threads - 1) owns, and results must not depend on
 * it. One loop at a time a pool. */
void kiln_threads_for(struct kiln_threads *threads, size_t count, size_t grain,
                      void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                      void *context);

#endif
