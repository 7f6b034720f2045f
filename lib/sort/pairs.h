/* This header declares a stable radix sort in threads. */
#ifndef KILN_SORT_PAIRS_H
#define KILN_SORT_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/thread.h"

/* Holds a key in the upper 32 bits and the number that is sorted by it in the lower 32 bits. */
typedef uint64_t kiln_sort_pair;

/* Returns the words of memory that the counts of the threads need. */
size_t kiln_sort_count_words(const struct kiln_threads *threads);

/* Holds the least and the greatest of the keys. */
struct kiln_sort_span {
    uint32_t least, greatest;
};

/* Sorts `count` pairs, whose keys are within the span, by ascending key; pairs of equal keys keep
 * their order. Their lower words are written to `list`, from its end if `reverse` is set. list has
 * room for as many pairs: it is scratch during the sort, so that sorting takes no more memory than
 * the pairs twice. The pairs are lost. counts has kiln_sort_count_words. */
void kiln_sort_pairs(struct kiln_threads *threads, kiln_sort_pair *pairs, size_t count,
                     struct kiln_sort_span span, bool reverse, uint32_t *list, uint32_t *counts);

#endif
