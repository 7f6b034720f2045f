/* A kiln_sort_depth sorts the living particles by depth, in several threads. It is the larger part
 * of technique `cpu`. */
#ifndef KILN_SORT_DEPTH_H
#define KILN_SORT_DEPTH_H

#include "base/footprint.h"
#include "sort/sort.h"

/* Describes slots of one system whose serials are consecutive. */
struct kiln_sort_block {
    uint32_t system;
    uint32_t first, end; /* slots of the pool */
    uint32_t place;      /* set and read by the function that lists the block's particles */
};

struct kiln_sort_depth;

/* The threads are borrowed. Returns NULL with an error when memory is short. */
struct kiln_sort_depth *kiln_sort_depth_create(struct kiln_threads *threads,
                                               struct kiln_error *error);

/* Adds the memory of sorting the particles of `slots` slots, and of their draw entries. */
void kiln_sort_depth_footprint(uint64_t slots, struct kiln_footprint *footprint);
void kiln_sort_depth_destroy(struct kiln_sort_depth **sorter);

/* Fills entries with the draw entries of the living particles of the blocks, ordered by
 * params->order (not KILN_SORT_BY_SERIAL), and counts them. May enlarge entries to twice the words,
 * to sort in them. The blocks cover the systems' slots in the order of serials. */
bool kiln_sort_depth_run(struct kiln_sort_depth *sorter, struct kiln_pool *pool,
                         const struct kiln_sort_params *params,
                         const struct kiln_sort_block *blocks, size_t block_count,
                         struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error);

#endif
