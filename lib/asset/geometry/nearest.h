/* Finds how far a point is from the triangles of a mesh, by a tree of boxes around them. */
#ifndef KILN_ASSET_GEOMETRY_NEAREST_H
#define KILN_ASSET_GEOMETRY_NEAREST_H

#include "asset/geometry/mesh.h"

struct kiln_nearest;

/* Builds the tree of a mesh, which must outlive it. NULL when memory is short. The caller destroys
 * the tree. */
struct kiln_nearest *kiln_nearest_create(const struct kiln_mesh *mesh);
void kiln_nearest_destroy(struct kiln_nearest **nearest);

/* Returns the square of the distance to the nearest triangle, or `most` if that is less. Several
 * threads may call it at once. The bits are the same on every machine. */
double kiln_nearest_square(const struct kiln_nearest *nearest, const double p[3], double most);

#endif
