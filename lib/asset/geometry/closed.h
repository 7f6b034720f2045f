/* Checks whether a mesh is closed, so that it has an inside. */
#ifndef KILN_ASSET_GEOMETRY_CLOSED_H
#define KILN_ASSET_GEOMETRY_CLOSED_H

#include "asset/geometry/mesh.h"

/* Every edge must be gone along as often one way as the other; vertices at the same place are one.
 * KILN_INVALID_INPUT with the edge and what is wrong with it, after `name`; KILN_DEVICE_FAILED when
 * memory is short. */
bool kiln_mesh_check_closed(const struct kiln_mesh *mesh, const char *name,
                            struct kiln_error *error);

#endif
