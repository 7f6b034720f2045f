/* The import of meshes in the child process of asset/geometry/mesh.c, and the memory that it shares
 * with its parent. */
#ifndef KILN_ASSET_GEOMETRY_MESH_IMPORT_H
#define KILN_ASSET_GEOMETRY_MESH_IMPORT_H

#include "asset/geometry/mesh.h"
#include "asset/geometry/skin_import.h"

struct kiln_mesh_request {
    const char *name;      /* for messages */
    bool uvs;              /* wanted */
    const char *extension; /* ".obj", ".gltf" or ".glb" */
    bool moving;           /* nodes, bones and clips are wanted, and vertices before these */
    const void *bytes;
    size_t size;
    const char *folder;       /* of the file, where the paths in it start; NULL: none are allowed */
    const char *root;         /* absolute; they stay below it */
    bool (*stop)(void *user); /* may be NULL */
    void *user;
};

/* Memory that is never touched costs nothing. The parent believes none of it unchecked. */
struct kiln_mesh_result {
    bool done; /* set last: without it, the child died */
    bool ok;
    struct kiln_error error; /* unless ok */
    uint32_t vertex_count, triangle_count;
    char hash[65];
    float vertices[KILN_MAX_MESH_VERTICES][6];
    uint32_t triangles[KILN_MAX_MESH_TRIANGLES][3];
    struct kiln_skin_result skin;         /* of a moving one */
    float uvs[KILN_MAX_MESH_VERTICES][2]; /* if wanted */
};

/* Imports on this process, whatever that takes. */
void kiln_mesh_import(const struct kiln_mesh_request *request, struct kiln_mesh_result *result);

struct aiMesh;
struct aiScene;

/* Appends the vertices and triangles of one of assimp's meshes. */
bool kiln_mesh_import_part(const struct kiln_mesh_request *request, const struct aiMesh *mesh,
                           struct kiln_mesh_result *result);

/* The same for all of a scene that moves, with what moves it. */
bool kiln_skin_import(const struct kiln_mesh_request *request, const struct aiScene *scene,
                      struct kiln_mesh_result *result);

/* min and max, of the positions that the vertices have. */
void kiln_mesh_bound(struct kiln_mesh *mesh);

/* The parent's side: checks what came and makes a skin of it, which takes the mesh, whatever
 * comes of it. */
struct kiln_skin *kiln_skin_take(const struct kiln_mesh_request *request,
                                 const struct kiln_mesh_result *result, struct kiln_mesh *mesh,
                                 struct kiln_error *error);

#endif
