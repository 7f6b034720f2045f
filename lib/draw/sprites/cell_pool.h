/* A kiln_cell_pool holds the texels of cells side by side in large pages. The CPU rasteriser reads
 * thousands of cells in no order: each in memory of its own, the processor would spend time on the
 * translation of addresses. */
#ifndef KILN_DRAW_SPRITES_CELL_POOL_H
#define KILN_DRAW_SPRITES_CELL_POOL_H

#include <stddef.h>
#include <stdint.h>

struct kiln_cell_block;

/* A pool of zeros is empty. */
struct kiln_cell_pool {
    struct kiln_cell_block *last; /* the block that has room, and points to the one before */
    size_t used, room;            /* bytes of it */
};

/* Allocates memory of undefined contents, aligned to 64 bytes, which lives as long as the pool.
 * NULL when memory is short. Not thread-safe. */
uint8_t *kiln_cell_pool_alloc(struct kiln_cell_pool *pool, size_t bytes);

/* Frees all memory of a pool. */
void kiln_cell_pool_finish(struct kiln_cell_pool *pool);

#endif
