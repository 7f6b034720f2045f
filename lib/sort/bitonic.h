/* Technique `bitonic`: lists and sorts in compute, by bitonic merges. */
#ifndef KILN_SORT_BITONIC_H
#define KILN_SORT_BITONIC_H

#include "sort/sort.h"

struct kiln_bitonic;

/* NULL with an error. */
struct kiln_bitonic *kiln_bitonic_create(struct kiln_device *device, struct kiln_error *error);
void kiln_bitonic_destroy(struct kiln_bitonic **bitonic);

/* Like kiln_sort_run. */
bool kiln_bitonic_run(struct kiln_bitonic *bitonic, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_buffer *entries,
                      uint32_t *count, struct kiln_error *error);

/* How many pairs a buffer must have room for to sort `count`: the next power of two. */
uint32_t kiln_bitonic_padded(uint32_t count);

/* Writes the words of a list of `count` to entries, ordered by pairs: (key, place in the list),
 * ascending, or descending in `reverse`. The pairs are lost. */
bool kiln_bitonic_pairs(struct kiln_bitonic *bitonic, struct kiln_buffer *pairs,
                        struct kiln_buffer *list, uint32_t count, bool reverse,
                        struct kiln_buffer *entries, struct kiln_error *error);

#endif
