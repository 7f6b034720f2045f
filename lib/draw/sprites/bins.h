/* A kiln_bins holds for each tile of the picture a list of the sprites that touch it, in drawing
 * order. The CPU rasteriser (particles_cpu.c) uses it. */
#ifndef KILN_DRAW_SPRITES_BINS_H
#define KILN_DRAW_SPRITES_BINS_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/sprites/tile.h"

/* The depth of the scene in a tile, m. */
struct kiln_tile_depth {
    float nearest, farthest;
};

/* Holds what the lists of tiles need of a sprite. */
struct kiln_bin_box {
    int16_t x_from, y_from, x_to, y_to; /* those of struct kiln_sprite */
    float depth;                        /* of its nearest pixel, m; 0 if it is deep */
};

struct kiln_bins {
    uint32_t columns, rows;        /* tiles along the picture's edges */
    struct kiln_tile_depth *depth; /* by tile */
    uint32_t *counts; /* by piece and tile: a count of sprites, then a place in `list` */
    size_t count_room;
    struct kiln_bin_box *boxes; /* by sprite */
    size_t box_room;
    uint32_t *first; /* by tile: start of its list in `list`; at last, the end of all lists */
    uint32_t *list;  /* numbers of sprites, tile after tile */
    size_t list_room;
};

/* Makes empty lists for pictures of up to this size, px. Returns false with an error;
 * kiln_bins_finish must be called in that case, too. */
bool kiln_bins_init(struct kiln_bins *bins, uint32_t width, uint32_t height,
                    struct kiln_error *error);
void kiln_bins_finish(struct kiln_bins *bins);

/* Measures the depth of the scene in each tile. depth is an image of at most the bins' size, m,
 * rows from the top. Until the next call, the lists are for pictures of the image's size. */
void kiln_bins_measure(struct kiln_bins *bins, const float *depth, uint32_t width, uint32_t height,
                       struct kiln_threads *threads);

/* Makes room for the boxes of `count` sprites; earlier boxes are lost. Returns false with an error.
 */
bool kiln_bins_begin(struct kiln_bins *bins, uint32_t count, struct kiln_error *error);

/* Notes the boxes of the sprites from `begin` to `end`. Threads may note different sprites; best
 * soon after making them, while the processor's cache has them. */
void kiln_bins_note(const struct kiln_bins *bins, const struct kiln_sprite *sprites, size_t begin,
                    size_t end);

/* Makes the lists of `count` sprites, whose boxes are noted, for the tiles from `begin` to `end`;
 * the other tiles get empty lists. A sprite without pixels (x_from = x_to) is in no list. A tile
 * does not list sprites that are farther than the scene everywhere in it. Returns false with an
 * error. */
bool kiln_bins_fill_tiles(struct kiln_bins *bins, uint32_t count, size_t begin, size_t end,
                          struct kiln_threads *threads, struct kiln_error *error);

/* Makes the lists of all tiles, of the sprites from `begin` to *end or, where they would need much
 * memory, of fewer. Sets *end to that of the listed sprites. */
bool kiln_bins_fill_some(struct kiln_bins *bins, uint32_t begin, uint32_t *end,
                         struct kiln_threads *threads, struct kiln_error *error);

/* Adds the memory of the lists of up to `sprites` sprites at a time, in a picture of up to this
 * size, px. */
void kiln_bins_footprint(uint32_t width, uint32_t height, uint64_t sprites,
                         struct kiln_footprint *footprint);

#endif
