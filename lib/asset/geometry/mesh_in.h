/* Declares a mesh as kiln-decode sends it: its arrays, and functions that check and convert
 * them. */
#ifndef KILN_ASSET_GEOMETRY_MESH_IN_H
#define KILN_ASSET_GEOMETRY_MESH_IN_H

#include "asset/geometry/mesh.h"
#include "asset/geometry/skin_in.h"

/* Holds the arrays in their largest sizes. Pages that are never touched take no memory. */
struct kiln_mesh_result {
    uint32_t vertex_count, triangle_count;
    float vertices[KILN_MAX_MESH_VERTICES][6];
    uint32_t triangles[KILN_MAX_MESH_TRIANGLES][3];
    struct kiln_skin_result skin;         /* of a mesh that moves */
    float uvs[KILN_MAX_MESH_VERTICES][2]; /* if they were asked for */
};

/* Calls `visit` for each array that follows an answer, in their order, with the counts of the
 * result. Both sides of the socket use this order. Stops where visit returns false. */
bool kiln_mesh_visit_arrays(struct kiln_mesh_result *result, bool uvs, bool moving,
                            bool (*visit)(void *user, void *array, size_t bytes), void *user);

/* Computes min and max from the positions of the vertices. */
void kiln_mesh_bound(struct kiln_mesh *mesh);

/* Checks a result and makes a skin of it. The skin takes ownership of the mesh, also on failure.
 * name is for messages. */
struct kiln_skin *kiln_skin_take(const char *name, const struct kiln_mesh_result *result,
                                 struct kiln_mesh *mesh, struct kiln_error *error);

#endif
