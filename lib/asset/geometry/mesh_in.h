/* Declares a mesh as kiln-decode sends it through its socket. Two programs include this:
 * kiln-decode fills the arrays from a file and sends them (decode/), and kiln receives them
 * (mesh_in.c). The arrays cross as they lie in memory, so both programs must be of one version.
 *
 * kiln-decode reads untrusted files, so kiln trusts no number that it sends: mesh_in.c checks the
 * counts before it receives an array, and then checks the contents. */
#ifndef KILN_ASSET_GEOMETRY_MESH_IN_H
#define KILN_ASSET_GEOMETRY_MESH_IN_H

#include "asset/geometry/material_in.h"
#include "asset/geometry/mesh.h"
#include "asset/geometry/rig_in.h"
#include "asset/geometry/skin_in.h"
#include "asset/loader/protocol.h"

/* Holds the arrays in their largest sizes, 134 MiB together. Pages of a result that are never
 * touched take no memory. */
struct kiln_mesh_result {
    uint32_t vertex_count, triangle_count, morph_target_count;
    float vertices[KILN_MAX_MESH_VERTICES][6]; /* position and normal */
    uint32_t triangles[KILN_MAX_MESH_TRIANGLES][3];
    struct kiln_skin_result skin;         /* filled for a mesh that moves; of a rig, its clips */
    struct kiln_rig_result rig;           /* filled if it was asked for, and then no vertices are */
    struct kiln_looks_result looks;       /* filled if materials were asked for */
    float uvs[KILN_MAX_MESH_VERTICES][2]; /* filled if they were asked for */
    /* what was changed or left out, for the user: a line each, none at the end */
    char notes[KILN_MESSAGE_SIZE];
};

/* Returns an empty result, all of whose numbers are 0, or NULL if memory is short (mesh_arrays.c).
 * The caller frees it by kiln_mesh_result_destroy. large_pages: asks the kernel for pages of 2 MiB,
 * which are quicker to fill, but zeroed as a whole when a byte of them is touched. */
struct kiln_mesh_result *kiln_mesh_result_create(bool large_pages);

/* Frees a result with skin.deltas and looks.bytes, and sets *result to NULL, which it may be
 * already. */
void kiln_mesh_result_destroy(struct kiln_mesh_result **result);

/* Calls `visit` for each array that crosses the socket, in the order in which it does, with its
 * size by the counts of the result. The request says which arrays are sent. Both programs use it
 * (mesh_arrays.c), so their orders agree. Returns false as soon as visit does. */
bool kiln_mesh_visit_arrays(struct kiln_mesh_result *result,
                            const struct kiln_decode_request *wanted,
                            bool (*visit)(void *user, void *array, size_t bytes), void *user);

/* Computes a mesh's bounding box, min and max, from the positions of its vertices (mesh.c). */
void kiln_mesh_find_bounds(struct kiln_mesh *mesh);

/* Checks the part `skin` of a result (skin_check.c). */
bool kiln_skin_check(const char *name, const struct kiln_mesh_result *result,
                     struct kiln_error *error);

/* Checks the clips of a result that has as many nodes and no morph targets (skin_check.c). */
bool kiln_clips_check(const char *name, const struct kiln_mesh_result *result, uint32_t node_count,
                      struct kiln_error *error);

/* Checks the nodes and clips of a result and makes a rig of them (rig.c). NULL with an error. hash:
 * of the contents of the files. */
struct kiln_rig *kiln_rig_take(const char *name, const struct kiln_mesh_result *result,
                               const char hash[65], struct kiln_error *error);

/* Checks the part `skin` of a result and makes a skin of it (skin.c). The mesh is made from the
 * rest of the same result, which mesh_in.c has checked. This takes ownership of the mesh, also on
 * failure: then it is destroyed, and NULL is returned with an error. name is for messages. */
struct kiln_skin *kiln_skin_take(const char *name, const struct kiln_mesh_result *result,
                                 struct kiln_mesh *mesh, struct kiln_error *error);

#endif
