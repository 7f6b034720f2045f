/* Declares meshes and loads them from OBJ, glTF and GLB files. kiln-decode imports them, so that a
 * file on which the importer crashes gives an error and does not end kiln. It gets the file itself
 * and the buffers that a glTF file names, and nothing else. A loader of NULL may open any file. */
#ifndef KILN_ASSET_GEOMETRY_MESH_H
#define KILN_ASSET_GEOMETRY_MESH_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

struct kiln_loader;

enum {
    KILN_MAX_MESH_BYTES = 64 << 20, /* bytes of the file, and of each buffer that it names */
    KILN_MAX_MESH_VERTICES = 1 << 20,
    KILN_MAX_MESH_TRIANGLES = 1 << 20,
};

/* Holds all geometry of a file in one piece: nodes are resolved, polygons are split into
 * triangles. */
struct kiln_mesh {
    uint32_t vertex_count, triangle_count; /* triangle_count is at least 1 */
    float (*vertices)[6];                  /* position, within 1e6; unit normal */
    uint32_t (*triangles)[3];              /* indices below vertex_count */
    /* texture coordinates of the vertices of an unwrapped mesh, else NULL */
    float (*uvs)[2];
    float min[3], max[3]; /* bounds of the positions */
    char hash[65];        /* SHA-256 of the bytes that were read, in hex */
};

/* Loads a file whose name ends in .obj, .gltf or .glb. Files that it names must lie in its folder
 * or below, and below the loader's root. NULL: KILN_IO when it cannot be read or there is no
 * importer; KILN_INVALID_INPUT, with what was found and what is allowed, when it is no mesh,
 * broken, cut short, beyond the limits above or names files elsewhere; KILN_DEVICE_FAILED when
 * memory is short; KILN_OVER_LIMIT; KILN_INTERRUPTED when the loader is told to stop. The caller
 * destroys the mesh. */
struct kiln_mesh *kiln_mesh_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error);

/* Loads a mesh with the first set of texture coordinates of every vertex; KILN_INVALID_INPUT where
 * there are none. Vertices that differ only in texture coordinates stay separate, so the mesh may
 * have more of them. */
struct kiln_mesh *kiln_mesh_load_unwrapped(struct kiln_loader *loader, const char *path,
                                           struct kiln_error *error);

/* Reverses all triangles if the volume that they enclose is negative, since files differ in which
 * winding is outside. */
void kiln_mesh_face_outwards(struct kiln_mesh *mesh);

/* Copies a mesh. NULL when memory is short. The caller destroys the copy. */
struct kiln_mesh *kiln_mesh_copy(const struct kiln_mesh *mesh);

/* Loads a mesh as kiln_mesh_load does, from bytes in memory, which may name no other files. name
 * stands for the file in messages. */
struct kiln_mesh *kiln_mesh_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error);
void kiln_mesh_destroy(struct kiln_mesh **mesh);

#endif
