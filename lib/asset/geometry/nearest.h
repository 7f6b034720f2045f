/* Finds how far a point is from the triangles of a mesh, in all directions or along a ray, by a
 * tree of bounding boxes.
 * asset/geometry/field.c builds a tree while it makes the signed distance field of a mesh that
 * particles bounce off. It asks for the distance of each sample, on several threads at once.
 *
 * Particles must move alike on every machine, so the result has the same bits on every machine. A
 * change that alters the result alters fields. It needs a new VERSION in field.c, since fields are
 * cached, and a new KILN_STATE_VERSION, since saved states depend on them. */
#ifndef KILN_ASSET_GEOMETRY_NEAREST_H
#define KILN_ASSET_GEOMETRY_NEAREST_H

#include "asset/geometry/mesh.h"

struct kiln_nearest;

/* Builds the tree of a mesh. The mesh must outlive the tree, which the caller destroys. Returns
 * NULL when memory is short. */
struct kiln_nearest *kiln_nearest_create(const struct kiln_mesh *mesh);
void kiln_nearest_destroy(struct kiln_nearest **nearest);

/* Returns the bytes of the tree of a mesh. */
uint64_t kiln_nearest_bytes(const struct kiln_mesh *mesh);

/* Returns the square of the distance from p to the nearest triangle, or `most` if `most` is less.
 * `most` is a square, too; a small one saves time, since boxes that are farther are skipped.
 * Several threads may call it at once. */
double kiln_nearest_square(const struct kiln_nearest *nearest, const double p[3], double most);

/* A ray that leaves a triangle of the mesh. */
struct kiln_nearest_ray {
    double from[3];
    double way[3];  /* a unit vector */
    uint32_t start; /* the triangle, which it does not hit */
};

/* Returns the distance to the first triangle that the ray hits from behind, where triangles that
 * run counter-clockwise are seen from the front; or `most`, if that is less. */
double kiln_nearest_along(const struct kiln_nearest *nearest, const struct kiln_nearest_ray *ray,
                          double most);

#endif
