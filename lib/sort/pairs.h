/* A stable radix sort in threads. */
#ifndef KILN_SORT_PAIRS_H
#define KILN_SORT_PAIRS_H

#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"

/* A key in the upper, what it belongs to in the lower 32 bits. */
typedef uint64_t kiln_sort_pair;

/* Words of memory for the counts of so many threads. */
size_t kiln_sort_count_words(const struct kiln_threads *threads);

/* Sorts by ascending key; pairs with equal keys keep their order. The result is in `pairs` or in
 * `scratch`, which has the same size: the one that is returned. counts has kiln_sort_count_words.
 */
kiln_sort_pair *kiln_sort_pairs(struct kiln_threads *threads, kiln_sort_pair *pairs,
                                kiln_sort_pair *scratch, size_t count, uint32_t *counts);

#endif
