/* A kiln_instance_tiles holds the silhouettes of particles that are meshes, as the sun sees them.
 * Each has a tile of an atlas, whose texels are the parts that are covered; coarser levels have
 * half the size each. */
#ifndef KILN_DRAW_LIGHT_INSTANCE_TILES_H
#define KILN_DRAW_LIGHT_INSTANCE_TILES_H

#include "base/thread.h"
#include "draw/moment/instances.h"
#include "shared/shape_layout.h"

/* Describes how a mesh is projected across the sun's direction: from kiln_instances' corners to
 * parts of the tile's half. */
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

/* Draws the silhouettes of places into the tiles of their numbers; the result is the same for any
 * number of threads. */
void kiln_instance_tiles_run(struct kiln_instance_tiles *tiles, struct kiln_instance_place *places,
                             uint32_t count, struct kiln_threads *threads);

struct kiln_instance_tile kiln_instance_tile_at(const struct kiln_instance_tiles *tiles,
                                                uint32_t number);

/* Returns KILN_INSTANCE_LEVELS levels, one after the other: KILN_INSTANCE_ATLAS texels squared, a
 * quarter of that, and so on. */
const float *kiln_instance_tiles_texels(const struct kiln_instance_tiles *tiles);

#endif
