/* A kiln_bins holds for each tile of the picture a list of the sprites that touch it, in drawing
 * order. */
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
    uint32_t *counts;              /* by piece of the sprites and tile: counts, then places */
    size_t count_room;
    uint32_t *first; /* of each tile's list in `list`, and the end of the last one */
    uint32_t *list;  /* numbers of sprites */
    size_t list_room;
};

bool kiln_bins_init(struct kiln_bins *bins, uint32_t width, uint32_t height,
                    struct kiln_error *error);
void kiln_bins_finish(struct kiln_bins *bins);

/* Measures the depths of a scene in each tile. depth is an image of at most the bins' size, rows
 * from the top. Until the next call, the lists are for pictures of its size. */
void kiln_bins_measure(struct kiln_bins *bins, const float *depth, uint32_t width, uint32_t height,
                       struct kiln_threads *threads);

/* Makes the lists of sprites. Sprites with no pixels (x_from = x_to) are in no list; a tile that is
 * nearer than a sprite all over does not list it. */
bool kiln_bins_fill(struct kiln_bins *bins, const struct kiln_sprite *sprites, uint32_t count,
                    struct kiln_threads *threads, struct kiln_error *error);

#endif
