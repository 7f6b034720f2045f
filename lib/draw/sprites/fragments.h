/* A kiln_fragments blends particles in an order that is decided pixel by pixel, on the host: each
 * thread has the lists of a tile (shared/fragment_layout.h). */
#ifndef KILN_DRAW_SPRITES_FRAGMENTS_H
#define KILN_DRAW_SPRITES_FRAGMENTS_H

#include "draw/sprites/tile.h"

/* Holds the lists of a thread. */
struct kiln_fragments;

/* NULL when memory runs out. */
struct kiln_fragments *kiln_fragments_create(void);
void kiln_fragments_destroy(struct kiln_fragments **fragments);

/* Blends sprites into the tile, each pixel's fragments farthest first, those of one depth in the
 * order of the list; `draw` draws each sprite. Allocates no memory: if the fragments do not fit, it
 * draws again for some of the rows or, in one row, for nearer and nearer fragments. */
void kiln_fragments_draw(struct kiln_fragments *fragments, kiln_tile_draw *draw,
                         struct kiln_tile *tile, const struct kiln_sprite *sprites,
                         const struct kiln_cells *cells, const uint32_t *list, size_t count);

#endif
