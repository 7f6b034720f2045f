/* A kiln_instance_tiles holds the silhouettes of particles that are meshes, as the sun sees them.
 * Each particle has a tile of an atlas, whose texels are the part of their area that is covered.
 * Each coarser level has half the edge. */
#ifndef KILN_DRAW_LIGHT_INSTANCE_TILES_H
#define KILN_DRAW_LIGHT_INSTANCE_TILES_H

#include "base/thread.h"
#include "draw/moment/instances.h"
#include "shared/shape_layout.h"

/* Describes the projection of a mesh along the sun's direction: `across` takes a corner of
 * kiln_instances to coordinates in the tile, -1 to 1. */
struct kiln_silhouette {
    float across[2][3];
    uint32_t system;
    /* Results: the part of the tile that is covered; the silhouette's bounding box in the tile. */
    float covered, low[2], high[2];
};

/* Holds where a tile starts in the atlas, in texels. */
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

/* Returns the bytes of the tiles. */
uint64_t kiln_instance_tiles_bytes(void);

/* Returns the mesh of a system's particles. */
const struct kiln_instance_mesh *kiln_instance_tiles_mesh(const struct kiln_instance_tiles *tiles,
                                                          uint32_t system);

/* Draws the silhouette of each place into the tile with the place's number. The result is the same
 * for any number of threads. */
void kiln_instance_tiles_run(struct kiln_instance_tiles *tiles, struct kiln_silhouette *places,
                             uint32_t count, struct kiln_threads *threads);

struct kiln_instance_tile kiln_instance_tile_at(const struct kiln_instance_tiles *tiles,
                                                uint32_t number);

/* Returns the texels of KILN_INSTANCE_LEVELS levels, the finest first: KILN_INSTANCE_ATLAS squared,
 * then a quarter as many for each level. */
const float *kiln_instance_tiles_texels(const struct kiln_instance_tiles *tiles);

#endif
