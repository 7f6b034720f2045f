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

/* The key of a dead particle. No living one has it, since it is that of a NaN. */
#define KILN_SORT_DEAD 0u

struct kiln_sort_loops {
    /* Writes the key of each particle, or KILN_SORT_DEAD, to keys[slot]. If there are several
     * cells, adds the number of particles in each to counts, which has one cell more for dead
     * particles. */
    void (*count)(const struct kiln_sort_slots *slots, const struct kiln_sort_cells *cells,
                  uint32_t *keys, uint32_t *counts);
    /* Writes the draw entry of each particle, dead ones included, to the next free place of its
     * cell. keys: as written by `count`; places: that place for each cell. */
    void (*scatter)(const struct kiln_sort_slots *slots, const struct kiln_sort_cells *cells,
                    const uint32_t *keys, uint32_t *places, uint32_t *entries);
    /* Makes pairs of `count` draw entries and their keys, and returns the span of the keys. Fetches
     * keys ahead into the cache, of the first `fetch_count` entries at most, which may be more than
     * `count`. */
    struct kiln_sort_span (*pair)(const uint32_t *entries, size_t count, size_t fetch_count,
                                  const uint32_t *keys, kiln_sort_pair *pairs);
    /* Writes a pair of key and draw entry for each living particle and returns the number of pairs;
     * `pairs` has room for one pair a slot. Widens the span to hold the keys. */
    size_t (*list)(const struct kiln_sort_slots *slots, const uint32_t *keys, kiln_sort_pair *pairs,
                   struct kiln_sort_span *span);
};
KILN_SIMD_DECLARE(const struct kiln_sort_loops, kiln_sort_loops);

#endif
