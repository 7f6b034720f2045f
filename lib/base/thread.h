/* Runs loops over ranges on worker threads. The passes that run on the host, and the loaders of
 * assets, share their work among threads by these functions. */
#ifndef KILN_BASE_THREAD_H
#define KILN_BASE_THREAD_H

#include "base/caller.h"

struct kiln_threads;

/* Returns the number of processors that this process may run on, at most 256. */
uint32_t kiln_threads_available(void);

/* Returns a pool of `count` workers, of which the thread that runs a loop is one. 0 stands for one
 * for each processor that this process may run on, and more than 256 for 256. NULL when the system
 * refuses. */
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

/* Starts to count the time of loops for kiln_threads_serial_seconds. It is not counted from the
 * start, since each loop would then read a clock twice. */
void kiln_threads_measure(struct kiln_threads *threads);

/* Returns how many seconds a processor has worked for the calling thread outside of loops that
 * several workers could share. A loop of one piece is not such a loop. Only differences between two
 * calls, both on the thread that runs the loops, mean anything. */
double kiln_threads_serial_seconds(const struct kiln_threads *threads);

/* Sets the caller of the operation (base/caller.h), whom kiln_threads_try asks whether to go on, on
 * the thread that calls kiln_threads_try. A new pool asks nobody. */
void kiln_threads_set_caller(struct kiln_threads *threads, const struct kiln_caller *caller);

/* Runs a loop as kiln_threads_for does, but gives it up when the caller wants no more. Then it
 * returns false with the caller's error, pieces are missing, and every later kiln_threads_try of
 * these threads does nothing. It is for loops whose results only end up in pixels. */
bool kiln_threads_try(struct kiln_threads *threads, size_t count, size_t grain,
                      void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                      void *context, struct kiln_error *error);

/* Copies bytes by kiln_threads_try. */
bool kiln_threads_copy(struct kiln_threads *threads, void *to, const void *from, size_t bytes,
                       struct kiln_error *error);

#endif
