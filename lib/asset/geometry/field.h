/* Declares the signed distance field of a closed mesh (UberFlow 2004, 4.6): the distances of the
 * points of a lattice from its surface, below 0 inside. Fields are cached on the disk; a file's
 * name is a hash of all that decides its content. */
#ifndef KILN_ASSET_GEOMETRY_FIELD_H
#define KILN_ASSET_GEOMETRY_FIELD_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"

enum {
    KILN_MIN_FIELD_CELLS = 8, /* cells along the longest edge of the mesh's bounding box */
    KILN_MAX_FIELD_CELLS = 128,
};

struct kiln_field {
    /* samples along x, y and z. On every side, the lattice extends beyond the bounding box by two
     * cells and by the `reach` of kiln_field_check */
    uint32_t size[3];
    float origin[3];     /* place of the first sample, in units of the file */
    float spacing;       /* edge of a cell, in units of the file */
    float (*samples)[4]; /* gradient along x, y and z, then distance; ordered by z, y, x */
};

/* Checks that a mesh can have a field, and counts its samples. reach: the largest distance from the
 * mesh at which the field is read, in units of the file. name stands for the mesh in messages.
 * False: KILN_INVALID_INPUT when the mesh is not closed, or so thin that no sample is inside, or
 * when there would be too many samples; KILN_DEVICE_FAILED when memory is short. */
bool kiln_field_check(const struct kiln_mesh *mesh, const char *name, uint32_t cells, float reach,
                      size_t *samples, struct kiln_error *error);

/* Makes the field of a mesh that kiln_field_check accepted with the same values. The field is read
 * from the cache folder, if that is not NULL; otherwise it is computed on the threads and written
 * to the cache, if that is possible. Both ways give the same bytes, on every machine. A damaged
 * file in the cache is ignored. NULL with an error when memory is short. The caller destroys the
 * field. */
struct kiln_field *kiln_field_create(const struct kiln_mesh *mesh, const char *name, uint32_t cells,
                                     float reach, const char *cache, struct kiln_threads *threads,
                                     struct kiln_error *error);
void kiln_field_destroy(struct kiln_field **field);

#endif
