/* This file allocates the texels of cells from blocks. The first block is small, since most scenes
 * need few cells; the others have the large pages of base/pages.h. */
#include "draw/sprites/cell_pool.h"

#include <stdlib.h>

#include "base/pages.h"

enum { LINE = 64, FIRST_BLOCK = 1 << 16, NEXT_BLOCK = 1 << 22 }; /* bytes */

struct kiln_cell_block {
    _Alignas(LINE) struct kiln_cell_block *before;
};

uint8_t *kiln_cell_pool_alloc(struct kiln_cell_pool *pool, size_t bytes)
{
    if (bytes > SIZE_MAX / 2)
        return NULL;
    bytes = (bytes + LINE - 1) / LINE * LINE;
    if (pool->room - pool->used < bytes) {
        /* kiln_alloc_pages adds a byte: less than a page is asked for, to get no second one. */
        size_t room = (pool->last ? NEXT_BLOCK : FIRST_BLOCK) - LINE;
        if (room < sizeof(struct kiln_cell_block) + bytes)
            room = sizeof(struct kiln_cell_block) + bytes;
        struct kiln_cell_block *block = kiln_alloc_pages(room);
        if (!block)
            return NULL;
        block->before = pool->last;
        *pool = (struct kiln_cell_pool){block, sizeof *block, room};
    }
    uint8_t *memory = (uint8_t *)pool->last + pool->used;
    pool->used += bytes;
    return memory;
}

void kiln_cell_pool_finish(struct kiln_cell_pool *pool)
{
    for (struct kiln_cell_block *block = pool->last; block;) {
        struct kiln_cell_block *before = block->before;
        free(block);
        block = before;
    }
    *pool = (struct kiln_cell_pool){0};
}
