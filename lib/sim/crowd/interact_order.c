/* This file sorts the bodies of a system into cells, with all threads. The order of bodies that
 * share a cell is up to chance. It changes no result, since the partner that a body chooses depends
 * on the two bodies alone (contact_choose). */
#include <string.h>

#include "sim/crowd/interact_crowd.h"

enum { SLOTS_AT_A_TIME = 2048, CELLS_AT_A_TIME = 1 << 16 };

static void clear_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    memset(crowd->cell_ends + begin, 0, (end - begin) * sizeof *crowd->cell_ends);
}

/* Notes the cell of each living slot, and how many bodies were counted in that cell before. */
static void count_in_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    uint32_t *before = crowd->order + crowd->view.params->used;
    for (size_t slot = begin; slot < end; slot++) {
        const struct kiln_particle p = crowd->records[slot];
        crowd->order[slot] = INTERACT_NOBODY;
        if (!particle_is_alive(p))
            continue;
        const uint32_t cell = cell_of(&crowd->view, particle_position(p));
        crowd->order[slot] = cell;
        before[slot] = __atomic_fetch_add(&crowd->cell_ends[cell], 1u, __ATOMIC_RELAXED);
    }
}

static void place_in_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    const uint32_t *before = crowd->order + crowd->view.params->used;
    for (size_t slot = begin; slot < end; slot++) {
        const uint32_t cell = crowd->order[slot];
        if (cell != INTERACT_NOBODY)
            crowd_put_body(crowd, cell_begin(&crowd->view, cell) + before[slot], (uint32_t)slot);
    }
}

void kiln_interact_into_cells(struct kiln_interact_crowd *crowd)
{
    const size_t cells = (size_t)crowd->view.params->cell_mask + 1;
    const uint32_t used = crowd->view.params->used;
    kiln_threads_for(crowd->threads, cells, CELLS_AT_A_TIME, clear_cells, crowd);
    kiln_threads_for(crowd->threads, used, SLOTS_AT_A_TIME, count_in_cells, crowd);
    for (size_t cell = 0; cell < cells; cell++) {
        crowd->count += crowd->cell_ends[cell];
        crowd->cell_ends[cell] = crowd->count;
    }
    kiln_threads_for(crowd->threads, used, SLOTS_AT_A_TIME, place_in_cells, crowd);
}
