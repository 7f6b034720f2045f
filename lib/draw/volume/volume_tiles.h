/* Finds the tiles of the picture that blocks of gas touch, and between which depths. */
#ifndef KILN_DRAW_VOLUME_VOLUME_TILES_H
#define KILN_DRAW_VOLUME_VOLUME_TILES_H

#include "draw/volume/volume_march.h"

/* The depths of the blocks in a tile, m; near_m is not below far_m where there are none. */
struct kiln_tile_depths {
    float near_m, far_m;
};

struct kiln_volume_tiles {
    struct kiln_tile_depths *depths; /* rows of tiles from the top */
    struct kiln_block_box *boxes;    /* of each block */
    uint32_t tile_room, box_room;
};

/* Fills the depths of all tiles. Returns false with an error when memory is short. */
bool kiln_volume_tiles_find(struct kiln_volume_tiles *tiles, const struct kiln_volume_march *march,
                            struct kiln_threads *threads, struct kiln_error *error);

void kiln_volume_tiles_finish(struct kiln_volume_tiles *tiles);

#endif
