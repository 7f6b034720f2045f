/* This file sorts the living particles by depth, in several threads. lib/sort/cpu.c (technique
 * sort=cpu) calls kiln_sort_depth_run for each list of particles that is drawn in the order of
 * depth.
 *
 * It runs three loops. The first lists the living particles of each block, a range of slots of one
 * system, as pairs of a key, which is made from the depth, and a draw entry. The second moves the
 * pairs into cells, which are intervals of depth, the farthest first. In the third, one thread
 * sorts each cell, within its caches. In three cases kiln_sort_pairs sorts all pairs at once
 * instead: there are few slots, the depths of the sampled slots span no useful interval
 * (choose_cells), or a cell would get more pairs than the scratch of a thread holds.
 *
 * Particles of equal depth stay in the order of their serials, or in its reverse if the nearest
 * comes first, however the work is divided. This holds because blocks come in the order of serials,
 * a cell keeps the order of its blocks, and both sorts are stable. The numbers in the enum below
 * change how long sorting takes, but not the order.
 *
 * Sorting holds the pairs twice, 16 bytes a particle. The first loop writes its pairs, `listed`,
 * into the buffer that the caller gives for the entries. The sorted entries overwrite them, when
 * they have been moved into cells. */
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
};

/* Describes the pairs that were listed for a block. */
struct block_pairs {
    size_t first, count;        /* range of the block's pairs in `listed` */
    struct kiln_sort_span span; /* of the pairs' keys */
    /* For each cell, how many of the pairs it gets, and behind the last cell the number of dead
     * particles. After sum_cells: for each cell, where in `pairs` the block's next pair goes. */
    uint32_t *counts;
};

struct kiln_sort_depth {
    struct kiln_threads *threads;
    const struct kiln_sort_loops *loops;
    kiln_sort_bucket *sort_cell;
    struct kiln_buffer pairs;       /* all pairs, ordered by cell */
    struct kiln_buffer block_pairs; /* one for each block */
    struct kiln_buffer counts;      /* memory of the counts in struct block_pairs */
    kiln_sort_pair *cell_scratch;   /* MOST_IN_CELL pairs for each thread */
    uint32_t *digit_counts;         /* scratch of kiln_sort_pairs */
};

struct kiln_sort_depth *kiln_sort_depth_create(struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_sort_depth *sorter = calloc(1, sizeof *sorter);
    if (!sorter) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "sort: no memory");
        return NULL;
    }
    sorter->threads = threads;
    sorter->loops = KILN_SIMD_PICK(kiln_sort_loops, simd);
    sorter->sort_cell = KILN_SIMD_PICK(kiln_sort_bucket, simd);
    kiln_buffer_init(&sorter->pairs, NULL, 0, "sort pairs");
    kiln_buffer_init(&sorter->block_pairs, NULL, 0, "blocks of pairs");
    kiln_buffer_init(&sorter->counts, NULL, 0, "counts of cells");
    sorter->cell_scratch =
        malloc((size_t)kiln_threads_count(threads) * MOST_IN_CELL * sizeof *sorter->cell_scratch);
    sorter->digit_counts = malloc(kiln_sort_count_words(threads) * sizeof *sorter->digit_counts);
    if (!sorter->cell_scratch || !sorter->digit_counts) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "sort: no memory");
        kiln_sort_depth_destroy(&sorter);
    }
    return sorter;
}

void kiln_sort_depth_destroy(struct kiln_sort_depth **sorter)
{
    struct kiln_sort_depth *d = *sorter;
    if (!d)
        return;
    kiln_buffer_finish(&d->pairs);
    kiln_buffer_finish(&d->block_pairs);
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
    struct kiln_sort_cells cells;
    struct block_pairs *block_pairs;
    kiln_sort_pair *listed, *pairs; /* ordered by block; ordered by cell */
    uint32_t *list;                 /* the result; the same memory as listed */
    uint32_t count;
    uint32_t cell_starts[KILN_SORT_MOST_CELLS + 1]; /* where each cell begins in pairs */
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

/* Replaces each count by the index in `pairs` of the block's first pair in the cell; `pairs` is
 * ordered by cell, then by block. Returns false if a cell has more than MOST_IN_CELL pairs. */
static bool sum_cells(struct work *work)
{
    uint32_t place = 0;
    for (uint32_t cell = 0; cell < work->cells.count; cell++) {
        work->cell_starts[cell] = place;
        for (size_t b = 0; b < work->block_count; b++) {
            const uint32_t alive_count = work->block_pairs[b].counts[cell];
            work->block_pairs[b].counts[cell] = place;
            place += alive_count;
        }
        if (place - work->cell_starts[cell] > MOST_IN_CELL)
            return false;
    }
    work->cell_starts[work->cells.count] = place;
    return true;
}

/* ---- loops ----------------------------------------------------------------------------------- */

static void list_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    for (size_t b = begin; b < end; b++) {
        const struct kiln_sort_block *block = &work->blocks[b];
        struct block_pairs *block_pairs = &work->block_pairs[b];
        memset(block_pairs->counts, 0, (work->cells.count + 1) * sizeof *block_pairs->counts);
        const struct kiln_sort_slots slots = {
            .records = work->records,
            .system = block->system,
            .first = block->first,
            .end = block->end,
            .eye = work->params->eye,
            .forward = work->params->forward,
        };
        block_pairs->span = (struct kiln_sort_span){UINT32_MAX, 0};
        block_pairs->count =
            work->sorter->loops->list(&slots, &work->cells, work->listed + block_pairs->first,
                                      block_pairs->counts, &block_pairs->span);
    }
}

static void scatter_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    for (size_t b = begin; b < end; b++) {
        const struct block_pairs *block_pairs = &work->block_pairs[b];
        work->sorter->loops->scatter(work->listed + block_pairs->first, block_pairs->count,
                                     &work->cells, block_pairs->counts, work->pairs);
    }
}

static void sort_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct work *work = context;
    const bool reverse = work->params->order == KILN_SORT_FRONT_TO_BACK;
    kiln_sort_pair *scratch = work->sorter->cell_scratch + (size_t)worker * MOST_IN_CELL;
    for (size_t cell = begin; cell < end; cell++) {
        const uint32_t first = work->cell_starts[cell], count = work->cell_starts[cell + 1] - first;
        if (count > 0)
            work->sorter->sort_cell(work->pairs + first, count, scratch,
                                    work->list + (reverse ? work->count - 1 - first : first),
                                    reverse ? -1 : 1);
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
            first += work->block_pairs[before].count;
        memcpy(work->pairs + first, work->listed + work->block_pairs[b].first,
               work->block_pairs[b].count * sizeof *work->pairs);
    }
}

static void sort_at_once(struct work *work)
{
    struct kiln_sort_span span = {UINT32_MAX, 0};
    for (size_t b = 0; b < work->block_count; b++) {
        const struct kiln_sort_span *keys = &work->block_pairs[b].span;
        span.least = keys->least < span.least ? keys->least : span.least;
        span.greatest = keys->greatest > span.greatest ? keys->greatest : span.greatest;
    }
    kiln_threads_for(work->sorter->threads, work->block_count, 1, compact_blocks, work);
    kiln_sort_pairs(work->sorter->threads, work->pairs, work->count, span,
                    work->params->order == KILN_SORT_FRONT_TO_BACK, work->list,
                    work->sorter->digit_counts);
}

/* ---- run ------------------------------------------------------------------------------------- */

/* Sets where each block's pairs begin in `listed`, with room for all its slots. Returns the number
 * of slots of all blocks. */
static size_t assign_ranges(const struct work *work)
{
    size_t slots = 0;
    for (size_t b = 0; b < work->block_count; b++) {
        work->block_pairs[b] = (struct block_pairs){.first = slots};
        slots += work->blocks[b].end - work->blocks[b].first;
    }
    return slots;
}

static bool reserve(struct kiln_sort_depth *sorter, const struct kiln_pool *pool,
                    struct kiln_buffer *entries, struct work *work, struct kiln_error *error)
{
    const size_t pairs = pool->slot_count * sizeof(kiln_sort_pair);
    kiln_buffer_reserve(entries, pairs);
    kiln_buffer_reserve(&sorter->pairs, pairs);
    kiln_buffer_reserve(&sorter->block_pairs, work->block_count * sizeof(struct block_pairs));
    work->pairs = kiln_buffer_host(&sorter->pairs, KILN_OVERWRITE, error);
    work->block_pairs =
        work->pairs ? kiln_buffer_host(&sorter->block_pairs, KILN_OVERWRITE, error) : NULL;
    work->listed = work->block_pairs ? kiln_buffer_host(entries, KILN_OVERWRITE, error) : NULL;
    work->list = (uint32_t *)(void *)work->listed;
    return work->listed;
}

/* Reserves memory for the counts of each block. */
static bool reserve_counts(struct kiln_sort_depth *sorter, struct work *work,
                           struct kiln_error *error)
{
    const size_t words = (size_t)work->cells.count + 1;
    kiln_buffer_reserve(&sorter->counts, work->block_count * words * sizeof(uint32_t));
    uint32_t *counts = kiln_buffer_host(&sorter->counts, KILN_OVERWRITE, error);
    if (!counts)
        return false;
    for (size_t b = 0; b < work->block_count; b++)
        work->block_pairs[b].counts = counts + b * words;
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
    };
    work.records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!work.records || !reserve(sorter, pool, entries, &work, error))
        return false;
    work.cells = choose_cells(&work, assign_ranges(&work));
    if (!reserve_counts(sorter, &work, error))
        return false;
    kiln_threads_for(sorter->threads, block_count, 1, list_blocks, &work);
    for (size_t b = 0; b < block_count; b++)
        work.count += (uint32_t)work.block_pairs[b].count;
    if (work.cells.count > 1 && sum_cells(&work)) {
        kiln_threads_for(sorter->threads, block_count, 1, scatter_blocks, &work);
        kiln_threads_for(sorter->threads, work.cells.count, CELLS_AT_A_TIME, sort_cells, &work);
    } else {
        sort_at_once(&work);
    }
    *count = work.count;
    return true;
}
