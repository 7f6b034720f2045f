/* Particles whose order is decided pixel by pixel, on the host: a tile's lists in its thread
 * (shared/fragment_layout.h). */
#ifndef KILN_DRAW_SPRITES_FRAGMENTS_H
#define KILN_DRAW_SPRITES_FRAGMENTS_H

#include "draw/sprites/tile.h"

/* A thread's lists. */
struct kiln_fragments;

/* NULL when memory runs out. */
struct kiln_fragments *kiln_fragments_create(void);
void kiln_fragments_destroy(struct kiln_fragments **fragments);

/* Blends sprites into the tile, each pixel's fragments farthest first, those of one depth in the
 * order of the list; draw makes them. Takes no memory: what does not fit is found by drawing again,
 * for some of the rows or, in one row, for nearer and nearer fragments. */
void kiln_fragments_draw(struct kiln_fragments *fragments, kiln_tile_draw *draw,
                         struct kiln_tile *tile, const struct kiln_sprite *sprites,
                         const struct kiln_cells *cells, const uint32_t *list, size_t count);

#endif
