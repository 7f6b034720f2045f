/* Declares depth maps of a mesh from chosen directions (Kolb et al. 2004, as described in Heinz
 * 2019, 2.5.1). For each column along a direction, a map has the first and the last surface and
 * their normals. A point between them in every map counts as inside. This includes hollows of the
 * mesh that no direction looks into. The mesh need not be closed. */
#ifndef KILN_ASSET_GEOMETRY_DEPTH_MAPS_H
#define KILN_ASSET_GEOMETRY_DEPTH_MAPS_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"
#include "shared/limits.h"

enum {
    KILN_MIN_DEPTH_RESOLUTION = 16, /* least samples along each edge of a map */
    KILN_MAX_DEPTH_RESOLUTION = 256,
};

struct kiln_depth_maps {
    uint32_t count, resolution;
    float min[3], max[3]; /* bounds in which a map may have a surface, in units of the file */
    size_t word_count;
    /* First for each map three rows, which take a point to its column and its row, in samples, and
     * to its height along the direction, in units of the file. Then for each map, by row and
     * column, the front and the back: unit normal, height. Where there is no surface, front and
     * back have one height. */
    float (*words)[4];
};

/* Returns how many words the maps of a mesh have. */
size_t kiln_depth_maps_words(uint32_t count, uint32_t resolution);

/* Refuses maps that take too long, as KILN_INVALID_INPUT: with very many triangles that are large
 * in a map. Parameters as of kiln_depth_maps_create. */
bool kiln_depth_maps_check(const struct kiln_mesh *mesh, const char *name,
                           const float (*directions)[3], uint32_t count, uint32_t resolution,
                           struct kiln_error *error);

/* Makes the maps by a rasteriser in exact integers, with the same bytes for any number of threads.
 * There are at most KILN_MAX_DEPTH_DIRECTIONS directions, of any length but 0. Surfaces up to one
 * sample away from a sample count as hit, so that thin parts are not lost. name stands for the mesh
 * in messages. NULL: KILN_DEVICE_FAILED when memory is short. The caller destroys the result. */
struct kiln_depth_maps *kiln_depth_maps_create(const struct kiln_mesh *mesh, const char *name,
                                               const float (*directions)[3], uint32_t count,
                                               uint32_t resolution, struct kiln_threads *threads,
                                               struct kiln_error *error);
void kiln_depth_maps_destroy(struct kiln_depth_maps **maps);

#endif
