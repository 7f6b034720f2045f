/* A mesh on its way from kiln-decode: the arrays that it sends, and what they are checked for. */
#ifndef KILN_ASSET_GEOMETRY_MESH_IN_H
#define KILN_ASSET_GEOMETRY_MESH_IN_H

#include "asset/geometry/mesh.h"
#include "asset/geometry/skin_in.h"

/* Memory that is never touched costs nothing. */
struct kiln_mesh_result {
    uint32_t vertex_count, triangle_count;
    float vertices[KILN_MAX_MESH_VERTICES][6];
    uint32_t triangles[KILN_MAX_MESH_TRIANGLES][3];
    struct kiln_skin_result skin;         /* of a moving one */
    float uvs[KILN_MAX_MESH_VERTICES][2]; /* if wanted */
};

/* The arrays that follow an answer, in their order, on both sides of the socket; the counts are
 * those of the result. Calls visit for each, and stops where that returns false. */
bool kiln_mesh_visit_arrays(struct kiln_mesh_result *result, bool uvs, bool moving,
                            bool (*visit)(void *user, void *array, size_t bytes), void *user);

/* min and max, of the positions that the vertices have. */
void kiln_mesh_bound(struct kiln_mesh *mesh);

/* Checks what came and makes a skin of it, which takes the mesh, whatever comes of it. name is for
 * messages. */
struct kiln_skin *kiln_skin_take(const char *name, const struct kiln_mesh_result *result,
                                 struct kiln_mesh *mesh, struct kiln_error *error);

#endif
