/* Meshes in: OBJ, glTF and GLB, imported by kiln-decode, so that a file that the importer cannot
 * bear is an error and no crash. It gets the file itself and the buffers that a glTF file names,
 * and nothing else. A loader of NULL stands for one that opens any file. */
#ifndef KILN_ASSET_GEOMETRY_MESH_H
#define KILN_ASSET_GEOMETRY_MESH_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

struct kiln_loader;

enum {
    KILN_MAX_MESH_BYTES = 64 << 20, /* of the file, and of each buffer that it names */
    KILN_MAX_MESH_VERTICES = 1 << 20,
    KILN_MAX_MESH_TRIANGLES = 1 << 20,
};

/* Everything in the file, in one piece: nodes are resolved, polygons are triangles. */
struct kiln_mesh {
    uint32_t vertex_count, triangle_count; /* at least 1 triangle */
    float (*vertices)[6];                  /* position, within 1e6; unit normal */
    uint32_t (*triangles)[3];              /* below vertex_count */
    float (*uvs)[2];                       /* of an unwrapped one: places of the vertices in a
                                            * texture; else NULL */
    float min[3], max[3];                  /* of the positions */
    char hash[65];                         /* SHA-256 of what was read, in hex */
};

/* Reads a file whose name ends in .obj, .gltf or .glb; files that it names must lie in its folder
 * or below, and below the loader's root. NULL: KILN_IO when it cannot be read or there is no
 * importer, KILN_INVALID_INPUT with what was found and what is allowed when it is no mesh, broken,
 * cut short, beyond the limits above or names files elsewhere, KILN_DEVICE_FAILED when memory is
 * short, KILN_OVER_LIMIT, KILN_INTERRUPTED when the loader is told to stop. The caller destroys it.
 */
struct kiln_mesh *kiln_mesh_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error);

/* The same with the first set of texture coordinates of every vertex; KILN_INVALID_INPUT where
 * there are none. Vertices that differ by them alone are several, so it may have more of them. */
struct kiln_mesh *kiln_mesh_load_unwrapped(struct kiln_loader *loader, const char *path,
                                           struct kiln_error *error);

/* Turns all triangles around where the volume that they enclose is negative: files differ in which
 * way around is outside. */
void kiln_mesh_face_outwards(struct kiln_mesh *mesh);

/* NULL when memory is short. The caller destroys it. */
struct kiln_mesh *kiln_mesh_copy(const struct kiln_mesh *mesh);

/* As kiln_mesh_load, from bytes in memory, which may name no other files; name stands for the file.
 */
struct kiln_mesh *kiln_mesh_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error);
void kiln_mesh_destroy(struct kiln_mesh **mesh);

#endif
