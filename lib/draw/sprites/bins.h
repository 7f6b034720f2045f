/* Which sprites touch which tiles of the picture: for each tile a list, in drawing order. */
#ifndef KILN_DRAW_SPRITES_BINS_H
#define KILN_DRAW_SPRITES_BINS_H

#include "base/thread.h"
#include "draw/sprites/tile.h"

/* The depth of the scene in a tile, m. */
struct kiln_tile_depth {
    float nearest, farthest;
};

struct kiln_bins {
    uint32_t columns, rows;        /* of tiles */
    struct kiln_tile_depth *depth; /* of each tile */
    uint32_t *counts;              /* by piece of the sprites and tile; then where a piece's go */
    size_t count_room;
    uint32_t *first; /* of each tile's list in `list`, and the end of the last one */
    uint32_t *list;  /* numbers of sprites */
    size_t list_room;
};

bool kiln_bins_init(struct kiln_bins *bins, uint32_t width, uint32_t height,
                    struct kiln_error *error);
void kiln_bins_finish(struct kiln_bins *bins);

/* Takes in the depths of a scene: an image of at most the bins' size, rows from the top. Until the
 * next call, the lists are for pictures of its size. */
void kiln_bins_measure(struct kiln_bins *bins, const float *depth, uint32_t width, uint32_t height,
                       struct kiln_threads *threads);

/* Makes the lists of sprites; those with no pixels (x_from = x_to) are in none, nor is one in a
 * tile that is nearer all over. */
bool kiln_bins_fill(struct kiln_bins *bins, const struct kiln_sprite *sprites, uint32_t count,
                    struct kiln_threads *threads, struct kiln_error *error);

#endif
