/* Sorts the bodies of a staggered grid (shared/interact_staggered.h) on the host. */
#ifndef KILN_SIM_CROWD_INTERACT_SORT_H
#define KILN_SIM_CROWD_INTERACT_SORT_H

#include "base/thread.h"

struct kiln_interact_entry {
    uint64_t cell;
    uint32_t what; /* a slot or a body */
    uint32_t unused;
};

enum {
    /* The most stretches that loops are cut into; each has counts of its own. */
    KILN_SORT_STRETCHES = 16,
    KILN_SORT_DIGITS = 2048,
};

struct kiln_interact_sorting {
    struct kiln_threads *threads;
    struct kiln_interact_entry *entries, *scratch; /* count each */
    size_t count;
    uint32_t bits;    /* of a cell, of which the rest is 0 */
    uint32_t *counts; /* scratch: KILN_SORT_STRETCHES * KILN_SORT_DIGITS */
};

/* Sorts the entries by cells; what is in one keeps its order. */
void kiln_interact_sort(const struct kiln_interact_sorting *sorting);

/* Where stretch number `stretch` of so many begins in [0, count). */
size_t kiln_sort_stretch(size_t count, uint32_t stretch, uint32_t stretches);

/* Returns the number of stretches that suits the threads. */
uint32_t kiln_sort_stretches(const struct kiln_threads *threads);

#endif
