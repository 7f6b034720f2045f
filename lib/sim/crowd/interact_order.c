/* This file sorts the bodies of a system into cells or into the two staggered grids of UberFlow
 * (2004, 4.3), with all threads.
 *
 * In cells, the order of bodies that share one is up to chance. It changes no result, since the
 * partner that a body chooses depends on the two bodies alone (contact_choose). In the staggered
 * grids a body looks at its neighbours in the sorted order, so the order matters, and bodies of one
 * cell keep that of their slots.
 */
#include <assert.h>
#include <string.h>

#include "shared/interact_staggered.h"
#include "sim/crowd/interact_crowd.h"

enum { SLOTS_AT_A_TIME = 2048, CELLS_AT_A_TIME = 1 << 16 };

static_assert(sizeof(struct kiln_interact_entry) == 16, "as in GL");

static struct kiln_particle record_of(const struct kiln_interact_crowd *crowd, size_t slot)
{
    return crowd->records[slot];
}

static void put_body(struct kiln_interact_crowd *crowd, uint32_t at, uint32_t slot)
{
    const struct kiln_interact_params *params = crowd->view.params;
    crowd->bodies[at] = body_of(&crowd->view, record_of(crowd, slot), slot);
    if (params->spins)
        crowd->bodies[params->used + at].position_radius = crowd->spins[slot].rate;
}

/* ---- cells ---------------------------------------------------------------------------------- */

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
        const struct kiln_particle p = record_of(crowd, slot);
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
            put_body(crowd, cell_begin(&crowd->view, cell) + before[slot], (uint32_t)slot);
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

/* ---- the paper's grids ------------------------------------------------------------------------
 */

/* Describes a range of slots: the number of living particles, and the range of their cells along
 * each axis. */
struct extent {
    uint32_t count;
    uint32_t low[3], high[3];
};

struct grids {
    struct kiln_interact_crowd *crowd;
    uint32_t stretches;
    struct extent extents[KILN_SORT_STRETCHES];
    uint32_t low[3], shifts[3]; /* lowest cells, and the shifts that short_key uses */
    uint32_t bits;
};

struct cell {
    uint32_t along[3];
};

static struct cell stagger_cell(const struct kiln_interact_crowd *crowd, float3 p, float aside)
{
    return (struct cell){{stagger_along(&crowd->view, p.x, aside),
                          stagger_along(&crowd->view, p.y, aside),
                          stagger_along(&crowd->view, p.z, aside)}};
}

/* Returns a key that sorts as stagger_key_of does, in no more bits than the occupied cells need. */
static uint64_t short_key(const struct grids *grids, float3 p, float aside)
{
    const struct cell cell = stagger_cell(grids->crowd, p, aside);
    uint64_t key = 0;
    for (int c = 0; c < 3; c++)
        key |= (uint64_t)(cell.along[c] - grids->low[c]) << grids->shifts[c];
    return key;
}

static void measure(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct grids *grids = context;
    struct kiln_interact_crowd *crowd = grids->crowd;
    const uint32_t used = crowd->view.params->used;
    for (size_t s = begin; s < end; s++) {
        struct extent extent = {.low = {STAGGER_CELLS, STAGGER_CELLS, STAGGER_CELLS}};
        const size_t last = kiln_sort_stretch(used, (uint32_t)s + 1, grids->stretches);
        for (size_t i = kiln_sort_stretch(used, (uint32_t)s, grids->stretches); i < last; i++) {
            const struct kiln_particle p = record_of(crowd, i);
            if (!particle_is_alive(p))
                continue;
            const struct cell cell = stagger_cell(crowd, particle_position(p), 0.0f);
            extent.count++;
            for (int c = 0; c < 3; c++) {
                const uint32_t at = cell.along[c];
                extent.low[c] = at < extent.low[c] ? at : extent.low[c];
                extent.high[c] = at > extent.high[c] ? at : extent.high[c];
            }
        }
        grids->extents[s] = extent;
    }
}

/* Combines the extents of all ranges of slots into counts, and into the shifts of a short key. In
 * the second grid, the number of a cell may be higher by one. */
static void add_up(struct grids *grids)
{
    uint32_t high[3] = {0};
    for (int c = 0; c < 3; c++)
        grids->low[c] = STAGGER_CELLS;
    for (uint32_t s = 0; s < grids->stretches; s++) {
        struct extent *extent = &grids->extents[s];
        const uint32_t before = grids->crowd->count;
        grids->crowd->count += extent->count;
        extent->count = before; /* number of particles in earlier ranges */
        for (int c = 0; c < 3; c++) {
            grids->low[c] = extent->low[c] < grids->low[c] ? extent->low[c] : grids->low[c];
            high[c] = extent->high[c] > high[c] ? extent->high[c] : high[c];
        }
    }
    for (int c = 2; c >= 0; c--) {
        grids->shifts[c] = grids->bits;
        const uint32_t most = high[c] + 1 < STAGGER_CELLS ? high[c] + 1 : STAGGER_CELLS - 1;
        for (uint32_t span = most - grids->low[c]; span > 0; span /= 2)
            grids->bits++;
    }
}

static void fill_first(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct grids *grids = context;
    struct kiln_interact_crowd *crowd = grids->crowd;
    const uint32_t used = crowd->view.params->used;
    for (size_t s = begin; s < end; s++) {
        uint32_t at = grids->extents[s].count;
        const size_t last = kiln_sort_stretch(used, (uint32_t)s + 1, grids->stretches);
        for (size_t i = kiln_sort_stretch(used, (uint32_t)s, grids->stretches); i < last; i++) {
            const struct kiln_particle p = record_of(crowd, i);
            if (particle_is_alive(p))
                crowd->entries[at++] = (struct kiln_interact_entry){
                    .cell = short_key(grids, particle_position(p), 0.0f), .what = (uint32_t)i};
        }
    }
}

static void fill_second(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct grids *grids = context;
    struct kiln_interact_crowd *crowd = grids->crowd;
    for (size_t i = begin; i < end; i++) {
        put_body(crowd, (uint32_t)i, crowd->entries[i].what);
        crowd->entries[i] = (struct kiln_interact_entry){
            .cell = short_key(grids, body_position(crowd->bodies[i]), 0.5f), .what = (uint32_t)i};
    }
}

static void note_order(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    for (size_t i = begin; i < end; i++) {
        crowd->order[i] = crowd->entries[i].what;
        crowd->order[crowd->view.params->used + crowd->entries[i].what] = (uint32_t)i;
    }
}

void kiln_interact_into_grids(struct kiln_interact_crowd *crowd)
{
    struct kiln_threads *threads = crowd->threads;
    struct grids grids = {.crowd = crowd, .stretches = kiln_sort_stretches(threads)};
    kiln_threads_for(threads, grids.stretches, 1, measure, &grids);
    add_up(&grids);
    kiln_threads_for(threads, grids.stretches, 1, fill_first, &grids);
    const struct kiln_interact_sorting sorting = {.threads = threads,
                                                  .entries = crowd->entries,
                                                  .scratch = crowd->entries + crowd->count,
                                                  .count = crowd->count,
                                                  .bits = crowd->count ? grids.bits : 0,
                                                  .counts = crowd->counts};
    kiln_interact_sort(&sorting);
    kiln_threads_for(threads, crowd->count, SLOTS_AT_A_TIME, fill_second, &grids);
    kiln_interact_sort(&sorting);
    kiln_threads_for(threads, crowd->count, SLOTS_AT_A_TIME, note_order, crowd);
}
