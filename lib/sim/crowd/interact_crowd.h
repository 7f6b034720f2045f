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
    const struct kiln_particle *records; /* of the system */
    struct kiln_body *bodies, *after;
    uint32_t *cell_ends, *partners, *order;
    struct kiln_interact_entry *entries; /* of the paper's grids, as the counts are */
    uint32_t *counts;
    float4 *pushes;          /* of the system */
    struct kiln_spin *spins; /* likewise; NULL unless its balls turn */
    uint32_t count;          /* of bodies */
    bool staggered;
    bool later;      /* not the first round */
    atomic_uint met; /* bodies that have a partner */
};

/* Fills bodies and count, and cell_ends: of each cell, where its bodies end; order is scratch. */
void kiln_interact_into_cells(struct kiln_interact_crowd *crowd);

/* The same for the paper's grids: fills bodies, count and order. */
void kiln_interact_into_grids(struct kiln_interact_crowd *crowd);

#endif
