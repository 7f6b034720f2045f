/* Sorts the bodies of a staggered grid (shared/papers/interact_staggered.h) on the host. */
#ifndef KILN_SIM_CROWD_PAPERS_STAGGERED_SORT_H
#define KILN_SIM_CROWD_PAPERS_STAGGERED_SORT_H

#include "base/thread.h"

struct kiln_interact_entry {
    uint64_t cell;
    uint32_t what; /* number of a slot or of a body */
    uint32_t unused;
};

enum {
    /* The most ranges of entries; each has counts of its own. */
    KILN_SORT_STRETCHES = 16,
    KILN_SORT_DIGITS = 2048,
};

struct kiln_interact_sorting {
    struct kiln_threads *threads;
    struct kiln_interact_entry *entries, *scratch; /* each has `count` entries */
    size_t count;
    uint32_t bits;    /* used bits of a cell's number; all others are 0 */
    uint32_t *counts; /* scratch memory: KILN_SORT_STRETCHES * KILN_SORT_DIGITS */
};

/* Sorts the entries by cells. Entries of one cell keep their order. */
void kiln_interact_sort(const struct kiln_interact_sorting *sorting);

/* Returns where range number `stretch` of `stretches` begins in [0, count). */
size_t kiln_sort_stretch(size_t count, uint32_t stretch, uint32_t stretches);

/* Returns the number of ranges that suits the threads. */
uint32_t kiln_sort_stretches(const struct kiln_threads *threads);

#endif
