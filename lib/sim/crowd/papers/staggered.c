/* This file finds partners as UberFlow does (2004, 4.3): it sorts the bodies of a system into two
 * staggered grids, and each body looks at its neighbours in the order of both. So the order
 * matters, and bodies of one cell keep that of their slots.
 *
 * On the host, threads sort the entries by a radix sort (staggered_sort.c), in GL a bitonic network
 * does. */
#include <assert.h>
#include <string.h>

#include "gpu/device.h"
#include "shared/papers/interact_layout.h"
#include "shared/papers/interact_staggered.h"
#include "sim/crowd/interact_crowd.h"
#include "sim/crowd/papers/papers.h"
#include "sim/crowd/papers/staggered_sort.h"

enum { SLOTS_AT_A_TIME = 2048 };

static_assert(sizeof(struct kiln_interact_entry) == 16, "as in GL");

/* ---- on the host ----------------------------------------------------------------------------- */

/* Describes a range of slots: the number of living particles, and the range of their cells along
 * each axis. */
struct extent {
    uint32_t count;
    uint32_t low[3], high[3];
};

struct grids {
    struct kiln_interact_crowd *crowd;
    struct kiln_interact_entry *entries; /* of one grid after the other */
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
            const struct kiln_particle p = crowd->records[i];
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
            const struct kiln_particle p = crowd->records[i];
            if (particle_is_alive(p))
                grids->entries[at++] = (struct kiln_interact_entry){
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
        crowd_put_body(crowd, (uint32_t)i, grids->entries[i].what);
        grids->entries[i] = (struct kiln_interact_entry){
            .cell = short_key(grids, body_position(crowd->bodies[i]), 0.5f), .what = (uint32_t)i};
    }
}

static void note_order(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct grids *grids = context;
    struct kiln_interact_crowd *crowd = grids->crowd;
    for (size_t i = begin; i < end; i++) {
        crowd->order[i] = grids->entries[i].what;
        crowd->order[crowd->view.params->used + grids->entries[i].what] = (uint32_t)i;
    }
}

/* Fills bodies, count and order of a crowd. */
static bool sort_into_grids(struct kiln_interact_crowd *crowd, struct kiln_interact *interact,
                            struct kiln_error *error)
{
    struct kiln_threads *threads = crowd->threads;
    kiln_buffer_reserve(&interact->contact_scratch,
                        (size_t)KILN_SORT_STRETCHES * KILN_SORT_DIGITS * sizeof(uint32_t));
    struct grids grids = {
        .crowd = crowd,
        .entries = kiln_buffer_host(&interact->entries, KILN_READ_WRITE, error),
        .stretches = kiln_sort_stretches(threads),
    };
    uint32_t *counts = kiln_buffer_host(&interact->contact_scratch, KILN_READ_WRITE, error);
    if (!grids.entries || !counts)
        return false;
    kiln_threads_for(threads, grids.stretches, 1, measure, &grids);
    add_up(&grids);
    kiln_threads_for(threads, grids.stretches, 1, fill_first, &grids);
    const struct kiln_interact_sorting sorting = {.threads = threads,
                                                  .entries = grids.entries,
                                                  .scratch = grids.entries + crowd->count,
                                                  .count = crowd->count,
                                                  .bits = crowd->count ? grids.bits : 0,
                                                  .counts = counts};
    kiln_interact_sort(&sorting);
    kiln_threads_for(threads, crowd->count, SLOTS_AT_A_TIME, fill_second, &grids);
    kiln_interact_sort(&sorting);
    kiln_threads_for(threads, crowd->count, SLOTS_AT_A_TIME, note_order, &grids);
    return true;
}

static uint32_t find_partner(const struct kiln_interact_crowd *crowd, uint32_t self)
{
    return stagger_find(&crowd->view, self, crowd->count);
}

static void find_partners(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    crowd_find_partners(context, begin, end, find_partner);
}

/* ---- in GL ----------------------------------------------------------------------------------- */

enum { COUNT, BITONIC, ORDER_FIRST, ORDER_SECOND, FIND };

/* Sorts the entries by a bitonic network; `count` is a power of two. */
static void sort_entries(const struct kiln_interact *interact, GLuint program, uint32_t count)
{
    glUseProgram(program);
    glUniform1ui(INTERACT_AT_ENTRY_COUNT, count);
    for (uint32_t length = 2; length <= count; length *= 2) {
        for (uint32_t distance = length / 2; distance > 0; distance /= 2) {
            glUniform1ui(INTERACT_AT_RUN, length);
            glUniform1ui(INTERACT_AT_DISTANCE, distance);
            kiln_device_dispatch(interact->device, count / 2, interact->group_size);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        }
    }
}

static bool sort_gl(struct kiln_interact *interact, const struct kiln_interact_params *params,
                    GLuint *find, struct kiln_error *error)
{
    if (!kiln_interact_bind(INTERACT_BIND_ENTRIES, &interact->entries, KILN_READ_WRITE, error) ||
        !kiln_interact_bind(INTERACT_BIND_ORDER, &interact->order, KILN_READ_WRITE, error))
        return false;
    const GLuint *programs = interact->contact_programs[KILN_CONTACT_STAGGERED];
    const uint32_t entries = kiln_interact_entries(params->used);
    kiln_interact_empty_cells(interact, params->cell_mask + 1);
    kiln_interact_run(interact, programs[COUNT], entries);
    sort_entries(interact, programs[BITONIC], entries);
    kiln_interact_run(interact, programs[ORDER_FIRST], params->used);
    sort_entries(interact, programs[BITONIC], entries);
    kiln_interact_run(interact, programs[ORDER_SECOND], params->used);
    *find = programs[FIND];
    return true;
}

const struct kiln_contact_row kiln_contact_staggered_row = {
    .sort = sort_into_grids,
    .find = find_partners,
    .files = {[COUNT] = {"sim/crowd/papers/staggered_count.comp", "", false},
              [BITONIC] = {"sim/crowd/papers/staggered_bitonic.comp", "", false},
              [ORDER_FIRST] = {"sim/crowd/papers/staggered_order.comp", "", false},
              [ORDER_SECOND] = {"sim/crowd/papers/staggered_order.comp", "#define SECOND 1\n",
                                false},
              [FIND] = {"sim/crowd/papers/staggered_find.comp", "", false}},
    .sort_gl = sort_gl,
};
