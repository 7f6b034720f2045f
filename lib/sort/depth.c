/* This file sorts the living particles by depth, in several threads. lib/sort/cpu.c (technique
 * sort=cpu) calls kiln_sort_depth_run for each list of particles that is drawn in the order of
 * depth.
 *
 * It runs three loops. The first writes the key of each slot, which is made from the depth, and
 * counts the particles of each cell, an interval of depth, in each block, a range of slots of one
 * system. The second moves draw entries into the cells, in the order of drawing. In the third, one
 * thread sorts each cell, within its caches: it makes pairs of its entries and their keys, sorts
 * these, and writes the entries back. So sorting holds a key and an entry, 8 bytes a particle.
 *
 * Few slots are sorted by one thread as if they were one cell (sort_few). In two cases sort_at_once
 * makes pairs of all particles and sorts them together instead, in 16 bytes a particle: the depths
 * of the sampled slots span no useful interval (choose_cells), or a cell would get more particles
 * than the scratch of a thread holds.
 *
 * Particles of equal depth stay in the order of their serials, or in its reverse if the nearest
 * comes first, however the work is divided. This holds because blocks come in the order of serials,
 * a cell keeps the order of its blocks, and both sorts are stable. The numbers in the enum below
 * change how long sorting takes, but not the order. */
#include "sort/depth.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "sort/bucket.h"
#include "sort/cells.h"

enum {
    FEWEST_SLOTS = 16384, /* with fewer slots, cells cost more than they save */
    SLOTS_A_CELL = 1024,  /* 8 KiB of pairs and as much scratch fit a first-level cache */
    MOST_IN_CELL = 32768, /* 256 KiB of pairs and as much scratch fit a second-level cache */
    CELLS_AT_A_TIME = 4,  /* cells that a thread takes at a time */
    SAMPLES = 512,        /* slots whose depths determine the cells */
    OUTLIERS = 2,         /* how many samples do not count at the near end, and at the far end */
    CELL_SCRATCH = 2 * MOST_IN_CELL, /* pairs of a thread */
    FEWEST_FETCHED = 300000,         /* the keys of fewer particles fit a second-level cache */
};

/* Describes the particles of a block. */
struct block_part {
    /* For each cell, how many of the particles it gets, and behind the last cell the number of dead
     * ones. After sum_cells: for each cell, the place of the block's next entry. */
    uint32_t *counts;
    /* The range of the block's pairs, and the span of their keys; sort_at_once alone sets them. */
    size_t first, count;
    struct kiln_sort_span span;
};

struct kiln_sort_depth {
    struct kiln_threads *threads;
    const struct kiln_sort_loops *loops;
    kiln_sort_bucket *sort_cell;
    struct kiln_buffer keys;      /* one for each slot; pairs, where sort_at_once runs */
    struct kiln_buffer parts;     /* struct block_part, one for each block */
    struct kiln_buffer counts;    /* memory of the counts in struct block_part */
    kiln_sort_pair *cell_scratch; /* CELL_SCRATCH pairs for each thread */
    uint32_t *digit_counts;       /* scratch of kiln_sort_pairs */
};

struct kiln_sort_depth *kiln_sort_depth_create(struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_sort_depth *sorter = calloc(1, sizeof *sorter);
    if (!sorter) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    sorter->threads = threads;
    sorter->loops = KILN_SIMD_PICK(kiln_sort_loops, simd);
    sorter->sort_cell = KILN_SIMD_PICK(kiln_sort_bucket, simd);
    kiln_buffer_init(&sorter->keys, NULL, 0, "sort keys");
    kiln_buffer_init(&sorter->parts, NULL, 0, "parts of blocks");
    kiln_buffer_init(&sorter->counts, NULL, 0, "counts of cells");
    sorter->cell_scratch =
        malloc((size_t)kiln_threads_count(threads) * CELL_SCRATCH * sizeof *sorter->cell_scratch);
    sorter->digit_counts = malloc(kiln_sort_count_words(threads) * sizeof *sorter->digit_counts);
    if (!sorter->cell_scratch || !sorter->digit_counts) {
        kiln_error_no_memory(error, "the sort");
        kiln_sort_depth_destroy(&sorter);
    }
    return sorter;
}

void kiln_sort_depth_footprint(uint64_t slots, struct kiln_footprint *footprint)
{
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, slots,
                       2 * sizeof(kiln_sort_pair)); /* entries and keys of sort_at_once */
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, footprint->threads,
                       CELL_SCRATCH * sizeof(kiln_sort_pair));
}

void kiln_sort_depth_destroy(struct kiln_sort_depth **sorter)
{
    struct kiln_sort_depth *d = *sorter;
    if (!d)
        return;
    kiln_buffer_finish(&d->keys);
    kiln_buffer_finish(&d->parts);
    kiln_buffer_finish(&d->counts);
    free(d->cell_scratch);
    free(d->digit_counts);
    free(d);
    *sorter = NULL;
}

struct work {
    const struct kiln_sort_depth *sorter;
    const struct kiln_particle *records;
    const struct kiln_sort_params *params;
    const struct kiln_sort_block *blocks;
    size_t block_count;
    bool reverse; /* the nearest comes first */
    struct kiln_sort_cells cells;
    struct block_part *parts;
    uint32_t *keys; /* of the slots */
    uint32_t *list; /* the entries: first ordered by cell, then the result */
    uint32_t count;
    kiln_sort_pair *listed, *pairs; /* of sort_at_once: with gaps between blocks; without */
    /* where each cell begins in `list`, in the order of drawing */
    uint32_t cell_starts[KILN_SORT_MOST_CELLS + 1];
};

/* ---- cells ----------------------------------------------------------------------------------- */

struct extremes {
    float least[OUTLIERS + 1], greatest[OUTLIERS + 1]; /* outermost first */
};

static void take_sample(struct extremes *range, float depth_m)
{
    float low = depth_m, high = depth_m;
    for (int i = 0; i <= OUTLIERS; i++) {
        const float least = range->least[i], greatest = range->greatest[i];
        range->least[i] = low < least ? low : least;
        low = low < least ? least : low;
        range->greatest[i] = high > greatest ? high : greatest;
        high = high > greatest ? greatest : high;
    }
}

/* Returns the extreme depths of living particles in evenly spaced slots. */
static struct extremes sample_depths(const struct work *work, size_t slots)
{
    struct extremes range;
    for (int i = 0; i <= OUTLIERS; i++) {
        range.least[i] = INFINITY;
        range.greatest[i] = -INFINITY;
    }
    size_t before = 0, block = 0;
    for (size_t s = 0; s < SAMPLES; s++) {
        const size_t slot = slots * s / SAMPLES;
        while (slot - before >= work->blocks[block].end - work->blocks[block].first) {
            before += work->blocks[block].end - work->blocks[block].first;
            block++;
        }
        const struct kiln_particle p = work->records[work->blocks[block].first + (slot - before)];
        if (particle_is_alive(p))
            take_sample(&range, float3_dot(float3_sub(particle_position(p), work->params->eye),
                                           work->params->forward));
    }
    return range;
}

/* Divides the range of the sampled depths, and a margin of 3 % before and behind it, into cells.
 * Returns a single cell if there are few slots, if the range is shorter than 1e-6 m or longer than
 * 1e6 m, or if fewer than six of the sampled slots hold a living particle. */
static struct kiln_sort_cells choose_cells(const struct work *work, size_t slots)
{
    const struct kiln_sort_cells one = {.far_edge_m = 0.0f, .cells_per_m = 0.0f, .count = 1};
    if (slots < FEWEST_SLOTS)
        return one;
    const struct extremes range = sample_depths(work, slots);
    const float near_m = range.least[OUTLIERS], far_m = range.greatest[OUTLIERS];
    const float across_m = (far_m - near_m) * 1.0625f;
    if (!(across_m > 1e-6f && across_m < 1e6f))
        return one;
    struct kiln_sort_cells cells = {.far_edge_m = far_m + 0.03f * across_m, .count = 16};
    while (cells.count < KILN_SORT_MOST_CELLS && (size_t)cells.count * SLOTS_A_CELL < slots)
        cells.count *= 2;
    cells.cells_per_m = (float)cells.count / across_m;
    return cells;
}

/* Replaces each count by the place in `list` of the block's first entry in the cell. Cells lie in
 * `list` in the order of drawing, blocks within a cell in the order of serials, and dead particles
 * behind all cells. Returns false if a cell has more than MOST_IN_CELL particles. */
static bool sum_cells(struct work *work)
{
    uint32_t place = 0;
    for (uint32_t turn = 0; turn < work->cells.count; turn++) {
        const uint32_t cell = work->reverse ? work->cells.count - 1 - turn : turn;
        work->cell_starts[turn] = place;
        for (size_t b = 0; b < work->block_count; b++) {
            const uint32_t alive_count = work->parts[b].counts[cell];
            work->parts[b].counts[cell] = place;
            place += alive_count;
        }
        if (place - work->cell_starts[turn] > MOST_IN_CELL)
            return false;
    }
    work->cell_starts[work->cells.count] = place;
    work->count = place;
    for (size_t b = 0; b < work->block_count; b++) {
        const uint32_t dead_count = work->parts[b].counts[work->cells.count];
        work->parts[b].counts[work->cells.count] = place;
        place += dead_count;
    }
    return true;
}

static struct kiln_sort_slots slots_of(const struct work *work, size_t block)
{
    return (struct kiln_sort_slots){
        .records = work->records,
        .system = work->blocks[block].system,
        .first = work->blocks[block].first,
        .end = work->blocks[block].end,
        .eye = work->params->eye,
        .forward = work->params->forward,
    };
}

static void count_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    for (size_t b = begin; b < end; b++) {
        uint32_t *counts = work->parts[b].counts;
        memset(counts, 0, (work->cells.count + 1) * sizeof *counts);
        const struct kiln_sort_slots slots = slots_of(work, b);
        work->sorter->loops->count(&slots, &work->cells, work->keys, counts);
    }
}

static void scatter_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    for (size_t b = begin; b < end; b++) {
        const struct kiln_sort_slots slots = slots_of(work, b);
        work->sorter->loops->scatter(&slots, &work->cells, work->keys, work->parts[b].counts,
                                     work->list);
    }
}

static void sort_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct work *work = context;
    const struct kiln_sort_loops *loops = work->sorter->loops;
    kiln_sort_pair *pairs = work->sorter->cell_scratch + (size_t)worker * CELL_SCRATCH;
    const bool fetches = work->count >= FEWEST_FETCHED;
    for (size_t turn = begin; turn < end; turn++) {
        uint32_t *list = work->list + work->cell_starts[turn];
        const uint32_t count = work->cell_starts[turn + 1] - work->cell_starts[turn];
        if (count == 0)
            continue;
        const uint32_t fetch_count = fetches ? work->count - work->cell_starts[turn] : 0;
        const struct kiln_sort_span span = loops->pair(list, count, fetch_count, work->keys, pairs);
        work->sorter->sort_cell(pairs, count, span, pairs + MOST_IN_CELL,
                                work->reverse ? list + count - 1 : list, work->reverse ? -1 : 1);
    }
}

/* Sorts by cells, after count_blocks. Returns false if a cell has too many particles. */
static bool sort_by_cells(struct work *work)
{
    struct kiln_threads *threads = work->sorter->threads;
    if (!sum_cells(work))
        return false;
    kiln_threads_for(threads, work->block_count, 1, scatter_blocks, work);
    kiln_threads_for(threads, work->cells.count, CELLS_AT_A_TIME, sort_cells, work);
    return true;
}

/* Sorts at most MOST_IN_CELL slots, after count_blocks, as if they were one cell. */
static void sort_few(struct work *work)
{
    const struct kiln_sort_depth *sorter = work->sorter;
    kiln_sort_pair *pairs = sorter->cell_scratch;
    struct kiln_sort_span span = {UINT32_MAX, 0};
    size_t count = 0;
    for (size_t b = 0; b < work->block_count; b++) {
        const struct kiln_sort_slots slots = slots_of(work, b);
        count += sorter->loops->list(&slots, work->keys, pairs + count, &span);
    }
    if (count > 0)
        sorter->sort_cell(pairs, count, span, pairs + MOST_IN_CELL,
                          work->reverse ? work->list + count - 1 : work->list,
                          work->reverse ? -1 : 1);
    work->count = (uint32_t)count;
}

/* ---- all at once ----------------------------------------------------------------------------- */

static void list_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    for (size_t b = begin; b < end; b++) {
        struct block_part *part = &work->parts[b];
        const struct kiln_sort_slots slots = slots_of(work, b);
        part->span = (struct kiln_sort_span){UINT32_MAX, 0};
        part->count =
            work->sorter->loops->list(&slots, work->keys, work->listed + part->first, &part->span);
    }
}

/* Copies the pairs of each block from `listed` to `pairs`, without the gaps between blocks. */
static void compact_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    for (size_t b = begin; b < end; b++) {
        size_t first = 0;
        for (size_t before = 0; before < b; before++)
            first += work->parts[before].count;
        memcpy(work->pairs + first, work->listed + work->parts[b].first,
               work->parts[b].count * sizeof *work->pairs);
    }
}

/* Lists the pairs, after count_blocks, in the memory of the entries, which is made twice as large,
 * and sorts them in that of the keys. The sorted entries overwrite the list. */
static bool sort_at_once(struct kiln_sort_depth *sorter, struct work *work, size_t slots,
                         struct kiln_buffer *entries, struct kiln_error *error)
{
    kiln_buffer_reserve(entries, slots * sizeof(kiln_sort_pair));
    work->listed = kiln_buffer_host(entries, KILN_OVERWRITE, error);
    if (!work->listed)
        return false;
    kiln_threads_for(sorter->threads, work->block_count, 1, list_blocks, work);
    struct kiln_sort_span span = {UINT32_MAX, 0};
    work->count = 0;
    for (size_t b = 0; b < work->block_count; b++) {
        const struct kiln_sort_span *keys = &work->parts[b].span;
        span.least = keys->least < span.least ? keys->least : span.least;
        span.greatest = keys->greatest > span.greatest ? keys->greatest : span.greatest;
        work->count += (uint32_t)work->parts[b].count;
    }
    kiln_buffer_reserve(&sorter->keys, work->count * sizeof(kiln_sort_pair));
    work->pairs = kiln_buffer_host(&sorter->keys, KILN_OVERWRITE, error);
    if (!work->pairs)
        return false;
    kiln_threads_for(sorter->threads, work->block_count, 1, compact_blocks, work);
    kiln_sort_pairs(sorter->threads, work->pairs, work->count, span, work->reverse,
                    (uint32_t *)(void *)work->listed, sorter->digit_counts);
    return true;
}

/* ---- run ------------------------------------------------------------------------------------- */

static size_t count_slots(const struct kiln_sort_block *blocks, size_t block_count)
{
    size_t slots = 0;
    for (size_t b = 0; b < block_count; b++)
        slots += blocks[b].end - blocks[b].first;
    return slots;
}

/* Reserves memory for keys, entries, and the parts of blocks, and fills these. */
static bool reserve(struct kiln_sort_depth *sorter, uint32_t slot_count,
                    struct kiln_buffer *entries, struct work *work, struct kiln_error *error)
{
    const size_t words = (size_t)work->cells.count + 1;
    kiln_buffer_reserve(entries, slot_count * sizeof *work->list);
    kiln_buffer_reserve(&sorter->keys, slot_count * sizeof *work->keys);
    kiln_buffer_reserve(&sorter->parts, work->block_count * sizeof *work->parts);
    kiln_buffer_reserve(&sorter->counts, work->block_count * words * sizeof(uint32_t));
    work->list = kiln_buffer_host(entries, KILN_OVERWRITE, error);
    work->keys = work->list ? kiln_buffer_host(&sorter->keys, KILN_OVERWRITE, error) : NULL;
    work->parts = work->keys ? kiln_buffer_host(&sorter->parts, KILN_OVERWRITE, error) : NULL;
    uint32_t *counts =
        work->parts ? kiln_buffer_host(&sorter->counts, KILN_OVERWRITE, error) : NULL;
    if (!counts)
        return false;
    size_t slots = 0;
    for (size_t b = 0; b < work->block_count; b++) {
        work->parts[b] = (struct block_part){.counts = counts + b * words, .first = slots};
        slots += work->blocks[b].end - work->blocks[b].first;
    }
    return true;
}

bool kiln_sort_depth_run(struct kiln_sort_depth *sorter, struct kiln_pool *pool,
                         const struct kiln_sort_params *params,
                         const struct kiln_sort_block *blocks, size_t block_count,
                         struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error)
{
    *count = 0;
    struct work work = {
        .sorter = sorter,
        .params = params,
        .blocks = blocks,
        .block_count = block_count,
        .reverse = params->order == KILN_SORT_FRONT_TO_BACK,
    };
    work.records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!work.records)
        return false;
    const size_t slots = count_slots(blocks, block_count);
    work.cells = choose_cells(&work, slots);
    if (!reserve(sorter, pool->slot_count, entries, &work, error))
        return false;
    kiln_threads_for(sorter->threads, block_count, 1, count_blocks, &work);
    if (work.cells.count == 1 && slots <= MOST_IN_CELL)
        sort_few(&work);
    else if (!(work.cells.count > 1 && sort_by_cells(&work)) &&
             !sort_at_once(sorter, &work, slots, entries, error))
        return false;
    *count = work.count;
    return true;
}
