/* Checks whether a mesh is closed, so that it has an inside. */
#ifndef KILN_ASSET_GEOMETRY_CLOSED_H
#define KILN_ASSET_GEOMETRY_CLOSED_H

#include "asset/geometry/mesh.h"

/* Checks that every edge is passed as often in one direction as in the other by the triangles.
 * Vertices at the same place count as one. KILN_INVALID_INPUT with the edge and its fault, after
 * `name`; KILN_DEVICE_FAILED when memory is short. */
bool kiln_mesh_check_closed(const struct kiln_mesh *mesh, const char *name,
                            struct kiln_error *error);

#endif
