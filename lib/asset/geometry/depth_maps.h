/* Depth maps of a mesh from chosen directions (Kolb et al. 2004, as Heinz 2019, 2.5.1 tells of it):
 * of each column along a direction, the first and the last of the surface, and their normals. What
 * lies between them in every map counts as inside: the mesh, and its hollows that no direction
 * looks into. The mesh need not be closed. */
#ifndef KILN_ASSET_GEOMETRY_DEPTH_MAPS_H
#define KILN_ASSET_GEOMETRY_DEPTH_MAPS_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"
#include "shared/limits.h"

enum {
    KILN_MIN_DEPTH_RESOLUTION = 16, /* samples along each edge of a map */
    KILN_MAX_DEPTH_RESOLUTION = 256,
};

struct kiln_depth_maps {
    uint32_t count, resolution;
    float min[3], max[3]; /* where any map finds anything, in units of the file */
    size_t word_count;
    /* For each map, three rows that take a point to its column and its row, in samples, and to its
     * height along the direction, in units of the file; then for each map, by row and column, the
     * front and the back: unit normal, height. Where there is nothing, both are at one height. */
    float (*words)[4];
};

/* How many words the maps of a mesh have. */
size_t kiln_depth_maps_words(uint32_t count, uint32_t resolution);

/* Refuses what would take long to make, as KILN_INVALID_INPUT: very many triangles that are large
 * in a map. Parameters as of kiln_depth_maps_create. */
bool kiln_depth_maps_check(const struct kiln_mesh *mesh, const char *name,
                           const float (*directions)[3], uint32_t count, uint32_t resolution,
                           struct kiln_error *error);

/* By an exact rasteriser of our own, the same bytes for any number of threads. The directions, at
 * most KILN_MAX_DEPTH_DIRECTIONS, are of any length but 0. What a sample misses by at most one is
 * found nonetheless, so that nothing is too thin. name stands for the mesh in messages. NULL:
 * KILN_DEVICE_FAILED when memory is short. The caller destroys it. */
struct kiln_depth_maps *kiln_depth_maps_create(const struct kiln_mesh *mesh, const char *name,
                                               const float (*directions)[3], uint32_t count,
                                               uint32_t resolution, struct kiln_threads *threads,
                                               struct kiln_error *error);
void kiln_depth_maps_destroy(struct kiln_depth_maps **maps);

#endif
