/* This header declares a stable radix sort in threads. */
#ifndef KILN_SORT_PAIRS_H
#define KILN_SORT_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"

/* Holds a key in the upper 32 bits and the number that is sorted by it in the lower 32 bits. */
typedef uint64_t kiln_sort_pair;

/* Returns the number of 32-bit words that `counts` of kiln_sort_pairs needs. */
size_t kiln_sort_count_words(const struct kiln_threads *threads);

/* Holds the least and the greatest key of some pairs. */
struct kiln_sort_span {
    uint32_t least, greatest;
};

/* Sorts `count` pairs, whose keys are within the span, by ascending key; pairs of equal keys keep
 * their order. Writes the lower words of the pairs to `list`, from its end if `reverse` is set.
 * list has room for `count` pairs: it is scratch during the sort, so that sorting takes no more
 * memory than the pairs twice. The pairs are overwritten. counts has room for kiln_sort_count_words
 * words. */
void kiln_sort_pairs(struct kiln_threads *threads, kiln_sort_pair *pairs, size_t count,
                     struct kiln_sort_span span, bool reverse, uint32_t *list, uint32_t *counts);

#endif
