/* A stable radix sort in threads. */
#ifndef KILN_SORT_PAIRS_H
#define KILN_SORT_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"

/* A key in the upper, what it belongs to in the lower 32 bits. */
typedef uint64_t kiln_sort_pair;

/* Words of memory for the counts of so many threads. */
size_t kiln_sort_count_words(const struct kiln_threads *threads);

/* What keys lie between; both are in it. */
struct kiln_sort_span {
    uint32_t least, greatest;
};

/* Sorts `count` pairs, whose keys are within the span, by ascending key; those of equal keys keep
 * their order. What they belong to is written to `list`, or, in `reverse`, to its end first. list
 * has room for as many pairs: on the way it is scratch, so that sorting takes no more memory than
 * the pairs twice. The pairs are lost. counts has kiln_sort_count_words. */
void kiln_sort_pairs(struct kiln_threads *threads, kiln_sort_pair *pairs, size_t count,
                     struct kiln_sort_span span, bool reverse, uint32_t *list, uint32_t *counts);

#endif
