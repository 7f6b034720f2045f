/* Holds the bodies of a system while their pushes are gathered on the host, and declares how the
 * bodies are sorted. */
#ifndef KILN_SIM_CROWD_INTERACT_CROWD_H
#define KILN_SIM_CROWD_INTERACT_CROWD_H

#include <stdatomic.h>

#include "shared/spin.h"
#include "sim/crowd/interact.h"
#include "sim/crowd/interact_sort.h"

struct kiln_interact_crowd {
    struct kiln_crowd view;
    struct kiln_threads *threads;
    const struct kiln_particle *records; /* records of the system */
    struct kiln_body *bodies, *after;
    uint32_t *cell_ends, *partners, *order;
    struct kiln_interact_entry *entries; /* entries of the two staggered grids, as are the counts */
    uint32_t *counts;
    float4 *pushes;          /* pushes of the system */
    struct kiln_spin *spins; /* spins of the system; NULL unless its particles spin */
    uint32_t count;          /* number of bodies */
    bool staggered;
    bool later;      /* true in all rounds but the first */
    atomic_uint met; /* number of bodies that have a partner */
};

/* Sorts bodies into cells. Fills bodies and count, and cell_ends with the index behind each cell's
 * last body; order is scratch memory. */
void kiln_interact_into_cells(struct kiln_interact_crowd *crowd);

/* Sorts bodies into the two staggered grids: fills bodies, count and order. */
void kiln_interact_into_grids(struct kiln_interact_crowd *crowd);

#endif
