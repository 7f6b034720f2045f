/* Cells divide the depth of the scene for sorting. Particles are first distributed to the cells;
 * one thread then sorts each cell within its caches. */
#ifndef KILN_SORT_CELLS_H
#define KILN_SORT_CELLS_H

#include "base/simd.h"
#include "shared/keys.h"
#include "sort/pairs.h"

enum { KILN_SORT_MOST_CELLS = 1024 };

/* Describes cells of equal extent in depth, from the farthest to the nearest. The first and the
 * last cell also take all particles that lie beyond them. The choice of cells changes only how long
 * sorting takes, not the order. */
struct kiln_sort_cells {
    float far_edge_m, cells_per_m;
    uint32_t count;
};

/* Describes slots of one system whose serials are consecutive. */
struct kiln_sort_slots {
    const struct kiln_particle *records; /* of the pool */
    uint32_t system;
    uint32_t first, end; /* slots of the pool */
    float3 eye, forward; /* as in struct kiln_sort_params */
};

struct kiln_sort_loops {
    /* Writes a pair of key and draw entry for each living particle and returns the number of pairs;
     * `pairs` has room for one pair a slot. Adds the number of pairs in each cell to counts, which
     * has one cell more for dead particles. Widens the span to hold the keys. */
    size_t (*list)(const struct kiln_sort_slots *slots, const struct kiln_sort_cells *cells,
                   kiln_sort_pair *pairs, uint32_t *counts, struct kiln_sort_span *span);
    /* Copies each pair to the next free place of its cell. places: that place for each cell. */
    void (*scatter)(const kiln_sort_pair *pairs, size_t count, const struct kiln_sort_cells *cells,
                    uint32_t *places, kiln_sort_pair *to);
};
KILN_SIMD_DECLARE(const struct kiln_sort_loops, kiln_sort_loops);

#endif
