/* This file paints splats onto the texels of a mesh in threads. A grid holds the blocks of texels
 * by the cells that their middles lie in, and gives each splat to the blocks that it may reach. The
 * lists of splats are counted first and then written, by chunks of the splats, so that a block's
 * list keeps their order for any number of threads. Then each block is painted by one thread.
 *
 * kiln_paint_step (paint.c) calls kiln_paint_gather for each painted mesh in each step of the
 * simulation; `kiln bench` calls it, too. The canvas is part of the state hash, so the texels must
 * have the same bits for any number of threads, and with lists as without. Therefore each list must
 * be ascending, and it may have splats that do not reach the block, which the loop over the block
 * skips, but it must not lack one that does. The numbers below change only speed and memory. The
 * factors next to 1 make up for rounding and must not be removed. */
#include "sim/paint/paint_gather.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

enum {
    CELLS = 32,        /* most cells along an axis */
    CHUNKS = 16,       /* most chunks of the splats */
    LEAST_CHUNK = 256, /* least splats of a chunk */
    /* Most entries of all lists together, more than a mesh has blocks. If there would be more, the
     * splats are painted in parts, one after the other, so that the memory is bounded. */
    MOST_LISTED = 1 << 21,
    BLOCKS_AT_A_TIME = 16, /* blocks that a thread takes at once */
};

/* ---- the grid -------------------------------------------------------------------------------- */

static uint32_t cell_along(const struct kiln_paint_grid *grid, int axis, float at)
{
    const float cell = (at - grid->origin[axis]) * grid->per_unit;
    const float last = (float)(grid->size[axis] - 1);
    return (uint32_t)(cell > 0.0f ? (cell < last ? cell : last) : 0.0f);
}

static size_t cell_of(const struct kiln_paint_grid *grid, const float at[3])
{
    const size_t z = cell_along(grid, 2, at[2]), y = cell_along(grid, 1, at[1]);
    return (z * grid->size[1] + y) * grid->size[0] + cell_along(grid, 0, at[0]);
}

/* Chooses cells as large as blocks, so that a small splat looks at few of them. */
static void measure(struct kiln_paint_grid *grid, const struct kiln_chart *chart)
{
    float longest = 1e-6f;
    for (uint32_t b = 0; b < chart->block_count; b++) {
        for (int c = 0; c < 3; c++) {
            const float low = chart->low[b][c], high = chart->high[b][c];
            grid->middle[b][c] = 0.5f * low + 0.5f * high;
            const float half = 0.5f * (high - low) * 1.0001f + 1e-6f * (fabsf(low) + fabsf(high));
            grid->reach = half > grid->reach ? half : grid->reach;
        }
    }
    for (int c = 0; c < 3; c++) {
        grid->origin[c] = chart->min[c];
        const float size = chart->max[c] - chart->min[c];
        longest = size > longest ? size : longest;
    }
    const float least = longest / (float)CELLS, twice = 2.0f * grid->reach;
    grid->per_unit = 1.0f / (least > twice ? least : twice);
    for (int c = 0; c < 3; c++) {
        const float cells = (chart->max[c] - chart->min[c]) * grid->per_unit;
        grid->size[c] = 1 + (uint32_t)(cells < (float)(CELLS - 1) ? cells : (float)(CELLS - 1));
    }
}

bool kiln_paint_grid_init(struct kiln_paint_grid *grid, const struct kiln_chart *chart,
                          struct kiln_error *error)
{
    *grid = (struct kiln_paint_grid){.reach = 0.0f};
    grid->middle = malloc(chart->block_count * sizeof *grid->middle);
    grid->blocks = malloc(chart->block_count * sizeof *grid->blocks);
    grid->ends = malloc((size_t)chart->block_count * CHUNKS * sizeof *grid->ends);
    if (grid->middle)
        measure(grid, chart);
    const size_t cells = (size_t)grid->size[0] * grid->size[1] * grid->size[2];
    grid->first = calloc(cells + 2, sizeof *grid->first);
    if (!grid->middle || !grid->blocks || !grid->ends || !grid->first) {
        kiln_error_no_memory(error, "the paint");
        return false;
    }
    /* While blocks are placed, ends[cell] is the place of the cell's next block. When all are
     * placed it is the end of the cell, which is where the next cell starts. */
    uint32_t *ends = grid->first + 1;
    for (uint32_t b = 0; b < chart->block_count; b++)
        ends[cell_of(grid, grid->middle[b]) + 1]++;
    for (size_t cell = 0; cell < cells; cell++)
        ends[cell + 1] += ends[cell];
    for (uint32_t b = 0; b < chart->block_count; b++)
        grid->blocks[ends[cell_of(grid, grid->middle[b])]++] = b;
    return true;
}

void kiln_paint_grid_footprint(uint32_t edge, uint64_t splats, struct kiln_footprint *footprint)
{
    const struct kiln_paint_grid *g = NULL;
    const uint64_t blocks = ((uint64_t)edge * edge + KILN_CHART_BLOCK - 1) / KILN_CHART_BLOCK;
    const uint64_t of_block = sizeof *g->middle + sizeof *g->blocks + CHUNKS * sizeof *g->ends;
    const uint64_t listed = splats < MOST_LISTED / blocks ? splats * blocks : MOST_LISTED;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, blocks, of_block);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, (uint64_t)CELLS * CELLS * CELLS + 2,
                       sizeof *g->first);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, listed, sizeof *g->list);
}

void kiln_paint_grid_finish(struct kiln_paint_grid *grid)
{
    free(grid->first);
    free(grid->blocks);
    free(grid->middle);
    free(grid->ends);
    free(grid->list);
    *grid = (struct kiln_paint_grid){.list = NULL};
}

/* ---- lists ----------------------------------------------------------------------------------- */

struct gathering {
    const struct kiln_paint_gather *gather;
    const struct kiln_splat *splats;
    uint32_t count, chunk; /* number of splats, and of splats in a chunk */
    float (*texels)[4];
    atomic_bool changed;
};

/* Returns whether a splat may reach a block. */
static bool may_reach(const struct kiln_chart *chart, uint32_t block,
                      const struct kiln_splat *splat)
{
    const float *low = chart->low[block], *high = chart->high[block];
    float square = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float at = splat->position[c];
        const float beside = at < low[c] ? low[c] - at : at > high[c] ? at - high[c] : 0.0f;
        square += beside * beside;
    }
    return square * 0.9999f <= splat->radius_squared; /* the factor covers rounding */
}

/* Visits the blocks that a splat may reach. The first pass, in which list is NULL, adds 1 to each
 * such block's entry of `ends`. The second pass also writes the splat's number into the list, at
 * the index that the entry has before. */
static void deal(const struct gathering *g, uint32_t number, uint32_t *ends, uint32_t *list)
{
    const struct kiln_paint_grid *grid = g->gather->grid;
    const struct kiln_splat *splat = &g->splats[number];
    const float reach = sqrtf(splat->radius_squared) * 1.0001f + grid->reach;
    uint32_t from[3], to[3];
    for (int c = 0; c < 3; c++) {
        from[c] = cell_along(grid, c, splat->position[c] - reach);
        to[c] = cell_along(grid, c, splat->position[c] + reach);
    }
    for (uint32_t z = from[2]; z <= to[2]; z++) {
        for (uint32_t y = from[1]; y <= to[1]; y++) {
            const uint32_t *row = grid->first + ((size_t)z * grid->size[1] + y) * grid->size[0];
            for (uint32_t i = row[from[0]]; i < row[to[0] + 1]; i++) {
                const uint32_t block = grid->blocks[i];
                if (!may_reach(g->gather->chart, block, splat))
                    continue;
                if (list)
                    list[ends[block]] = number;
                ends[block]++;
            }
        }
    }
}

static void deal_chunks(const struct gathering *g, size_t begin, size_t end, uint32_t *list)
{
    const uint32_t blocks = g->gather->chart->block_count;
    for (size_t chunk = begin; chunk < end; chunk++) {
        const uint64_t first = (uint64_t)chunk * g->chunk, last = first + g->chunk;
        for (uint64_t i = first; i < last && i < g->count; i++)
            deal(g, (uint32_t)i, g->gather->grid->ends + chunk * blocks, list);
    }
}

static void count_chunks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    deal_chunks(context, begin, end, NULL);
}

static void write_chunks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gathering *g = context;
    deal_chunks(g, begin, end, g->gather->grid->list);
}

/* Counts the entries of all lists, and finds where each begins. */
static uint64_t count_entries(struct gathering *g)
{
    struct kiln_paint_grid *grid = g->gather->grid;
    const uint32_t blocks = g->gather->chart->block_count;
    g->chunk = (g->count + CHUNKS - 1) / CHUNKS;
    g->chunk = g->chunk > LEAST_CHUNK ? g->chunk : LEAST_CHUNK;
    memset(grid->ends, 0, (size_t)blocks * CHUNKS * sizeof *grid->ends);
    kiln_threads_for(g->gather->threads, CHUNKS, 1, count_chunks, g);
    uint64_t total = 0;
    for (uint32_t b = 0; b < blocks; b++) {
        for (size_t chunk = 0; chunk < CHUNKS; chunk++) {
            uint32_t *end = &grid->ends[chunk * blocks + b];
            const uint32_t count = *end;
            *end = (uint32_t)total;
            total += count;
        }
    }
    return total;
}

/* Makes the lists of the next splats: of all that are left, or of as many as the lists may hold.
 * Afterwards, the ends of the last chunk are the ends of the blocks' lists. */
static bool make_lists(struct gathering *g, struct kiln_error *error)
{
    struct kiln_paint_grid *grid = g->gather->grid;
    uint64_t total = count_entries(g);
    while (total > MOST_LISTED) {
        g->count = (g->count + 1) / 2;
        total = count_entries(g);
    }
    if (total > grid->list_capacity) {
        free(grid->list);
        const uint64_t more = total + total / 2;
        grid->list_capacity = more < MOST_LISTED ? more : MOST_LISTED;
        grid->list = malloc(grid->list_capacity * sizeof *grid->list);
    }
    if (total > 0 && !grid->list) {
        grid->list_capacity = 0;
        kiln_error_no_memory(error, "%u splats of paint", g->count);
        return false;
    }
    kiln_threads_for(g->gather->threads, CHUNKS, 1, write_chunks, g);
    return true;
}

/* ---- the gather ------------------------------------------------------------------------------ */

/* Paints a range of blocks on one thread: each with its list, or with all splats if there are no
 * lists. */
static void paint_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct gathering *g = context;
    const struct kiln_paint_gather *gather = g->gather;
    const uint32_t blocks = gather->chart->block_count;
    bool changed = false;
    for (size_t b = begin; b < end; b++) {
        const uint32_t *list = NULL;
        size_t count = g->count;
        if (gather->grid) {
            const uint32_t *ends = gather->grid->ends + (size_t)(CHUNKS - 1) * blocks;
            const uint32_t from = b > 0 ? ends[b - 1] : 0;
            list = gather->grid->list + from;
            count = ends[b] - from;
        }
        if (count > 0)
            changed =
                gather->block(gather->chart, (uint32_t)b, g->splats, list, count, g->texels) ||
                changed;
    }
    if (changed)
        atomic_store(&g->changed, true);
}

bool kiln_paint_gather(const struct kiln_paint_gather *gather, const struct kiln_splat *splats,
                       uint32_t count, float (*texels)[4], bool *changed, struct kiln_error *error)
{
    struct gathering g = {.gather = gather, .splats = splats, .count = count, .texels = texels};
    *changed = false;
    for (uint32_t done = 0; done < count; done += g.count) {
        g.splats = splats + done;
        if (!gather->grid || g.count > count - done)
            g.count = count - done;
        if (gather->grid && !make_lists(&g, error))
            return false;
        kiln_threads_for(gather->threads, gather->chart->block_count, BLOCKS_AT_A_TIME,
                         paint_blocks, &g);
    }
    *changed = atomic_load(&g.changed);
    return true;
}
