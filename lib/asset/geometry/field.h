/* Declares the signed distance field of a closed mesh (UberFlow, a paper of 2004, 4.6): for each
 * point of a lattice, its distance from the surface of the mesh, below 0 inside. Meshes that
 * particles collide with have one: lib/scene/samples.c checks them when a scene is loaded, and
 * lib/sim/world/grids.c makes the fields before the first step. Fields are cached on the disk; a
 * file's name is a hash of all that decides its content. */
#ifndef KILN_ASSET_GEOMETRY_FIELD_H
#define KILN_ASSET_GEOMETRY_FIELD_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"

enum {
    /* limits of `cells`: cells along the longest edge of the mesh's bounding box */
    KILN_MIN_FIELD_CELLS = 8,
    KILN_MAX_FIELD_CELLS = 128,
};

struct kiln_field {
    /* Samples along x, y and z. On every side, the lattice extends beyond the bounding box by two
     * cells plus the `reach` of kiln_field_check, rounded up to cells. */
    uint32_t size[3];
    float origin[3]; /* position of the first sample, in units of the file */
    float spacing;   /* edge of a cell, in units of the file */
    /* The gradient of the distance along x, y and z, which is not normalised, then the distance, in
     * units of the file. x varies fastest, then y, then z. */
    float (*samples)[4];
};

/* Checks that a mesh can have a field, and writes the number of its samples to `count`. `name`
 * names the mesh in messages. `cells` is from KILN_MIN_FIELD_CELLS to KILN_MAX_FIELD_CELLS. `reach`
 * is the largest distance from the mesh at which the field is read, in units of the file. Returns
 * false with KILN_INVALID_INPUT when the mesh is not closed, when it is so thin that no sample is
 * inside, when the reach is more than KILN_MAX_FIELD_CELLS cells, or when there would be more than
 * KILN_MAX_GRID_SAMPLES samples; with KILN_DEVICE_FAILED when the host's memory is short. */
bool kiln_field_check(const struct kiln_mesh *mesh, const char *name, uint32_t cells, float reach,
                      size_t *count, struct kiln_error *error);

/* Makes the field of a mesh that kiln_field_check accepted with the same values. The field is read
 * from the cache folder, if that is not NULL; otherwise it is computed on the threads and written
 * to the cache, if that is possible. A field that is read has the same bytes as one that is
 * computed, on every machine. A damaged file in the cache is ignored. NULL with an error when
 * memory is short. The caller destroys the field. */
struct kiln_field *kiln_field_create(const struct kiln_mesh *mesh, const char *name, uint32_t cells,
                                     float reach, const char *cache, struct kiln_threads *threads,
                                     struct kiln_error *error);
void kiln_field_destroy(struct kiln_field **field);

#endif
