/* What the sun sees of particles that are meshes: the silhouette of each in a tile of an atlas, as
 * parts of texels that are covered, and the same at half the size and so on. */
#ifndef KILN_DRAW_LIGHT_INSTANCE_TILES_H
#define KILN_DRAW_LIGHT_INSTANCE_TILES_H

#include "base/thread.h"
#include "draw/moment/instances.h"
#include "shared/shape_layout.h"

/* A mesh across the sun's direction: from kiln_instances' corners to parts of the tile's half. */
struct kiln_instance_place {
    float across[2][3];
    uint32_t system;
    /* Results: the part of the tile that is covered, and the box around that, in those parts. */
    float covered, low[2], high[2];
};

/* The place of a tile: where it starts, in texels. */
struct kiln_instance_tile {
    uint32_t x, y;
};

struct kiln_instance_tiles;

/* Creates the tiles of a scene whose kiln_instance_tile_edge is not 0. meshes are those of its
 * particles and must outlive the tiles. NULL: KILN_DEVICE_FAILED, no memory. */
struct kiln_instance_tiles *kiln_instance_tiles_create(const struct kiln_scene *scene,
                                                       const struct kiln_instances *meshes,
                                                       struct kiln_error *error);
void kiln_instance_tiles_destroy(struct kiln_instance_tiles **tiles);

/* The mesh of a system. */
const struct kiln_instance_mesh *kiln_instance_tiles_mesh(const struct kiln_instance_tiles *tiles,
                                                          uint32_t system);

/* Draws the places into the tiles of their numbers; for any number of threads the same. */
void kiln_instance_tiles_run(struct kiln_instance_tiles *tiles, struct kiln_instance_place *places,
                             uint32_t count, struct kiln_threads *threads);

struct kiln_instance_tile kiln_instance_tile_at(const struct kiln_instance_tiles *tiles,
                                                uint32_t number);

/* Levels of KILN_INSTANCE_ATLAS texels squared, a quarter of that, and so on, one after the other:
 * KILN_INSTANCE_LEVELS of them. */
const float *kiln_instance_tiles_texels(const struct kiln_instance_tiles *tiles);

#endif
