/* Depth in cells: particles are first thrown into these, each of which then is sorted by one thread
 * within its caches. */
#ifndef KILN_SORT_CELLS_H
#define KILN_SORT_CELLS_H

#include "base/simd.h"
#include "shared/keys.h"
#include "sort/pairs.h"

enum { KILN_SORT_MOST_CELLS = 1024 };

/* Cells of the same depth from the farthest on; the first and the last have whatever is beyond.
 * Which cells there are does not change an order, only how long it takes. */
struct kiln_sort_cells {
    float start_m, per_m;
    uint32_t count;
};

/* Slots of one system that follow one another by serial. */
struct kiln_sort_slots {
    const struct kiln_particle *records; /* of the pool */
    uint32_t system;
    uint32_t first, end; /* slots of the pool */
    float3 eye, forward; /* as in struct kiln_sort_params */
};

struct kiln_sort_loops {
    /* Writes a pair of key and draw entry for each that lives, of which there are as many as are
     * returned; `pairs` has room for as many as slots. Adds the number in each cell to counts,
     * which has room for one cell more, and makes the span as large as the keys need. */
    size_t (*list)(const struct kiln_sort_slots *slots, const struct kiln_sort_cells *cells,
                   kiln_sort_pair *pairs, uint32_t *counts, struct kiln_sort_span *span);
    /* Moves pairs to the place that is the next for their cell. */
    void (*scatter)(const kiln_sort_pair *pairs, size_t count, const struct kiln_sort_cells *cells,
                    uint32_t *places, kiln_sort_pair *to);
};
KILN_SIMD_DECLARE(const struct kiln_sort_loops, kiln_sort_loops);

#endif
