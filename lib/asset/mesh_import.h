/* What the child process of asset/mesh.c does, and the memory that it shares with its parent. */
#ifndef KILN_ASSET_MESH_IMPORT_H
#define KILN_ASSET_MESH_IMPORT_H

#include "asset/mesh.h"

struct kiln_mesh_request {
    const char *name;      /* for messages */
    const char *extension; /* ".obj", ".gltf" or ".glb" */
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
};

/* Imports on this process, whatever that takes. */
void kiln_mesh_import(const struct kiln_mesh_request *request, struct kiln_mesh_result *result);

#endif
