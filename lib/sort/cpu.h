/* Technique `cpu` lists and sorts the living particles in host threads. */
#ifndef KILN_SORT_CPU_H
#define KILN_SORT_CPU_H

#include "sort/sort.h"

struct kiln_sort_cpu;

/* The threads are borrowed. Returns NULL with an error when memory is short. */
struct kiln_sort_cpu *kiln_sort_cpu_create(struct kiln_threads *threads, struct kiln_error *error);
void kiln_sort_cpu_destroy(struct kiln_sort_cpu **sort);

/* Does the same as kiln_sort_run. */
bool kiln_sort_cpu_run(struct kiln_sort_cpu *sort, struct kiln_pool *pool,
                       const struct kiln_sort_params *params, struct kiln_buffer *entries,
                       uint32_t *count, struct kiln_error *error);

#endif
