/* Paints splats onto the texels of a mesh, in threads and for each width of vectors. */
#ifndef KILN_SIM_PAINT_PAINT_GATHER_H
#define KILN_SIM_PAINT_PAINT_GATHER_H

#include "asset/geometry/chart.h"
#include "base/simd.h"
#include "base/thread.h"
#include "particles/canvas.h"

/* Paints the texels of a block of the chart with splats in order: those of a list, or all `count`
 * splats where list is NULL. Returns whether a splat reached a texel. */
typedef bool kiln_paint_block(const struct kiln_chart *chart, uint32_t block,
                              const struct kiln_splat *splats, const uint32_t *list, size_t count,
                              float (*texels)[4]);
KILN_SIMD_DECLARE(kiln_paint_block, kiln_paint_block_of);

/* Holds the blocks of a chart by their places, and the list of splats that may reach each block. */
struct kiln_paint_grid {
    uint32_t size[3]; /* number of cells */
    float origin[3], per_unit;
    /* along each axis, the largest distance of a texel from the middle of its block */
    float reach;
    uint32_t *first;    /* first entry of each cell in `blocks`, and the end of the last */
    uint32_t *blocks;   /* blocks ordered by cell */
    float (*middle)[3]; /* middle of each block */

    uint32_t *ends;       /* ends of each block's part of the list, for each chunk of splats */
    uint32_t *list;       /* numbers of splats, ascending for each block */
    size_t list_capacity; /* capacity in entries */
};

bool kiln_paint_grid_init(struct kiln_paint_grid *grid, const struct kiln_chart *chart,
                          struct kiln_error *error);
void kiln_paint_grid_finish(struct kiln_paint_grid *grid);

/* Adds the memory of the grid of a chart of edge * edge texels, onto which up to `splats` splats
 * are painted in a step. */
void kiln_paint_grid_footprint(uint32_t edge, uint64_t splats, struct kiln_footprint *footprint);

/* The threads and loops of a gather. */
struct kiln_paint_gather {
    struct kiln_threads *threads;
    kiln_paint_block *block;
    const struct kiln_chart *chart;
    struct kiln_paint_grid *grid; /* NULL: each texel tests all splats (7.6.1.2) */
};

/* Paints splats onto a canvas of the chart's size, each over the earlier ones. The bits are the
 * same with and without a grid. *changed: whether a splat reached a texel. False with
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_paint_gather(const struct kiln_paint_gather *gather, const struct kiln_splat *splats,
                       uint32_t count, float (*texels)[4], bool *changed, struct kiln_error *error);

#endif
