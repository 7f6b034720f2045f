/* Paints splats onto the texels of a mesh, in threads and for each width of vectors. */
#ifndef KILN_SIM_PAINT_PAINT_GATHER_H
#define KILN_SIM_PAINT_PAINT_GATHER_H

#include "asset/geometry/chart.h"
#include "base/simd.h"
#include "base/thread.h"
#include "particles/canvas.h"

/* Paints the texels of a block of the chart with splats in their order: those of a list, or all
 * `count` of them where list is NULL. Whether any reached a texel. */
typedef bool kiln_paint_block(const struct kiln_chart *chart, uint32_t block,
                              const struct kiln_splat *splats, const uint32_t *list, size_t count,
                              float (*texels)[4]);
KILN_SIMD_DECLARE(kiln_paint_block, kiln_paint_block_of);

/* The blocks of a chart by their places, and which splats may reach them. */
struct kiln_paint_grid {
    uint32_t size[3]; /* cells */
    float origin[3], per_unit;
    float reach;        /* a block's places are no farther from its middle, along each axis */
    uint32_t *first;    /* of each cell, and the end: in blocks */
    uint32_t *blocks;   /* by cell */
    float (*middle)[3]; /* of each block */

    uint32_t *ends;       /* of each block's part of the list; by chunk of the splats */
    uint32_t *list;       /* numbers of splats, a block's in their order */
    size_t list_capacity; /* entries */
};

bool kiln_paint_grid_init(struct kiln_paint_grid *grid, const struct kiln_chart *chart,
                          struct kiln_error *error);
void kiln_paint_grid_finish(struct kiln_paint_grid *grid);

/* What a gather works with. */
struct kiln_paint_gather {
    struct kiln_threads *threads;
    kiln_paint_block *block;
    const struct kiln_chart *chart;
    struct kiln_paint_grid *grid; /* NULL: each texel looks at all splats (7.6.1.2) */
};

/* Paints splats onto a canvas of the chart's size, one over the other: the same bits with a grid
 * and without. *changed: whether any reached it. False with KILN_DEVICE_FAILED for memory. */
bool kiln_paint_gather(const struct kiln_paint_gather *gather, const struct kiln_splat *splats,
                       uint32_t count, float (*texels)[4], bool *changed, struct kiln_error *error);

#endif
