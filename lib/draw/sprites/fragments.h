/* A kiln_fragments sorts and blends the fragments of each pixel of a tile on the host
 * (post.compose: oit; shared/fragment_layout.h). Each thread has its own. */
#ifndef KILN_DRAW_SPRITES_FRAGMENTS_H
#define KILN_DRAW_SPRITES_FRAGMENTS_H

#include "draw/sprites/tile.h"

struct kiln_fragments;

/* Returns NULL when memory is short. */
struct kiln_fragments *kiln_fragments_create(enum kiln_simd simd);

/* Returns the bytes of one such scratch memory. */
uint64_t kiln_fragments_bytes(enum kiln_simd simd);
void kiln_fragments_destroy(struct kiln_fragments **fragments);

/* Blends sprites into the tile. The fragments of a pixel are blended from the farthest to the
 * nearest, those of equal depth in the order of the list. `draw` draws each sprite. The function
 * allocates no memory: if the fragments do not fit, it draws the sprites again for fewer rows or,
 * in a single row, again for the next nearer fragments. */
void kiln_fragments_draw(struct kiln_fragments *fragments, kiln_tile_draw *draw,
                         struct kiln_tile *tile, struct kiln_sprites sprites,
                         const struct kiln_cells *cells, const uint32_t *list, size_t count);

#endif
