/* Declares depth maps of a mesh from chosen directions, by which particles collide with the mesh
 * (Kolb et al. 2004, as described in Heinz 2019, 2.5.1). For each column along a direction, a map
 * has the first and the last surface and their normals. A point that lies between them in every map
 * counts as inside. So hollows of the mesh that cannot be seen from any direction count as inside,
 * too. The mesh need not be closed. */
#ifndef KILN_ASSET_GEOMETRY_PAPERS_DEPTH_MAPS_H
#define KILN_ASSET_GEOMETRY_PAPERS_DEPTH_MAPS_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"
#include "shared/limits.h"

struct kiln_depth_maps {
    uint32_t count, resolution;
    /* bounding box of all surfaces in the maps: the mesh's, grown by a few samples; in units of the
     * file */
    float min[3], max[3];
    size_t word_count;
    /* Words of four floats, as sim/world/grids.c copies them to the host's or the device's grids.
     * First, for each map, a 3 x 4 matrix, row by row: it maps a point (x, y, z, 1) to its column
     * and its row in the map, in samples, and to its height along the direction, in units of the
     * file. Then, for each map, row by row, two words for each sample: the front, which is the
     * surface of the greatest height, and the back. Each has a unit normal and a height. Where
     * there is no surface, front and back have the same height: no point lies between them. */
    float (*words)[4];
};

/* Returns how many words of four floats all maps of a mesh have together. */
size_t kiln_depth_maps_words(uint32_t count, uint32_t resolution);

/* Returns false with KILN_INVALID_INPUT if the maps would take too long to make, as when very many
 * triangles each cover much of a map. The parameters are those of kiln_depth_maps_create. */
bool kiln_depth_maps_check(const struct kiln_mesh *mesh, const char *name,
                           const float (*directions)[3], uint32_t count, uint32_t resolution,
                           struct kiln_error *error);

/* Makes the maps by a rasteriser in exact integers, with the same bytes for any number of threads.
 * There are at most KILN_MAX_DEPTH_DIRECTIONS directions, of any length but 0. A sample also gets a
 * surface that passes it at a distance of up to one sample, so that thin parts are not lost. `name`
 * stands for the mesh in messages. Returns NULL with KILN_DEVICE_FAILED when memory is short. The
 * caller destroys the result. */
struct kiln_depth_maps *kiln_depth_maps_create(const struct kiln_mesh *mesh, const char *name,
                                               const float (*directions)[3], uint32_t count,
                                               uint32_t resolution, struct kiln_threads *threads,
                                               struct kiln_error *error);
void kiln_depth_maps_destroy(struct kiln_depth_maps **maps);

#endif
