/* Technique `radix` lists the living particles and sorts them in compute by a stable radix sort. */
#ifndef KILN_SORT_RADIX_H
#define KILN_SORT_RADIX_H

#include "sort/row.h"

extern const struct kiln_sort_row kiln_sort_radix_row;

struct kiln_radix;

/* Returns NULL with an error on failure. */
struct kiln_radix *kiln_radix_create(struct kiln_device *device, struct kiln_error *error);
void kiln_radix_destroy(struct kiln_radix **radix);

/* Sorts the first `count` pairs (key, any word) of a buffer by ascending key; pairs of equal keys
 * keep their order. The list of the pairs' second words, reversed if `reverse` is set, overwrites
 * the pairs. */
bool kiln_radix_pairs(struct kiln_radix *radix, struct kiln_buffer *pairs, uint32_t count,
                      bool reverse, struct kiln_error *error);

#endif
