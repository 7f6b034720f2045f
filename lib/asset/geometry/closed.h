/* Checks whether a mesh is closed, so that it has an inside. */
#ifndef KILN_ASSET_GEOMETRY_CLOSED_H
#define KILN_ASSET_GEOMETRY_CLOSED_H

#include "asset/geometry/mesh.h"

/* Says where a mesh is open. */
struct kiln_opening {
    char text[256]; /* "1 triangle is at the edge from ..."; "": the mesh is closed */
};

/* Finds the first edge that the triangles do not pass as often in one direction as in the other.
 * Vertices at the same place count as one. Returns false when memory is short. */
bool kiln_mesh_find_opening(const struct kiln_mesh *mesh, struct kiln_opening *opening);

/* Checks that a mesh is closed. KILN_INVALID_INPUT with where it is open, after `name`;
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_mesh_check_closed(const struct kiln_mesh *mesh, const char *name,
                            struct kiln_error *error);

#endif
