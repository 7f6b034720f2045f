/* The signed distance field of a closed mesh (UberFlow 2004, 4.6): how far points of a lattice are
 * from its surface, below 0 inside. It is kept on disk, under a name out of all that it follows
 * from. */
#ifndef KILN_ASSET_GEOMETRY_FIELD_H
#define KILN_ASSET_GEOMETRY_FIELD_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"

enum {
    KILN_MIN_FIELD_CELLS = 8, /* along the longest edge of the mesh's box */
    KILN_MAX_FIELD_CELLS = 128,
};

struct kiln_field {
    uint32_t size[3];    /* samples along x, y and z: two cells more than the box on every side, and
                            as many as what it is looked up with reaches */
    float origin[3];     /* of the first, in units of the file */
    float spacing;       /* edge of a cell, likewise */
    float (*samples)[4]; /* how the distance grows along x, y and z; distance; by z, y, x */
};

/* Whether a mesh can have a field, and how many samples that has. reach: how far around the mesh
 * the field is asked for, in units of the file. name stands for the mesh in messages. False:
 * KILN_INVALID_INPUT when the mesh is not closed, or so thin that no sample is inside, or when
 * there would be too many samples, KILN_DEVICE_FAILED when memory is short. */
bool kiln_field_check(const struct kiln_mesh *mesh, const char *name, uint32_t cells, float reach,
                      size_t *samples, struct kiln_error *error);

/* Of a mesh that kiln_field_check takes, with the same values. From the cache in the folder, if
 * that is not NULL, or made on the threads, and then left there if that is possible; both give the
 * same bytes, on every machine. A file in the cache that is not as it was written counts for
 * nothing. NULL with an error when memory is short. The caller destroys it. */
struct kiln_field *kiln_field_create(const struct kiln_mesh *mesh, const char *name, uint32_t cells,
                                     float reach, const char *cache, struct kiln_threads *threads,
                                     struct kiln_error *error);
void kiln_field_destroy(struct kiln_field **field);

#endif
