/* Declares meshes, and loads them from OBJ, glTF, GLB, PLY and STL files. The mesh library
 * (asset/geometry/mesh_library.h) loads each file that a scene names once, and its meshes stay as
 * they are. Code that poses or turns a mesh (draw/moment/meshes.c, sim/world/volumes.c) works on a
 * copy.
 *
 * A process of kiln-decode imports the file, so that a file on which the importer crashes gives an
 * error and does not end kiln. That process gets the file itself, the buffers that a glTF file
 * names and, where materials are wanted, the files of materials that an OBJ file names, and nothing
 * else. With a loader of NULL, any file may be opened. */
#ifndef KILN_ASSET_GEOMETRY_MESH_H
#define KILN_ASSET_GEOMETRY_MESH_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

struct kiln_loader;
struct kiln_mesh_looks;

enum {
    KILN_MAX_MESH_BYTES = 64 << 20, /* bytes of the file, and of each buffer that it names */
    KILN_MAX_MESH_VERTICES = 1 << 20,
    KILN_MAX_MESH_TRIANGLES = 1 << 20,
    /* The version of the readers. It is raised with every change of the vertices or triangles that
     * a file gives, so that states of particles that hit meshes, saved by earlier versions, are not
     * used. */
    KILN_MESH_READER_VERSION = 1,
};

/* Holds all geometry of a file in one piece: nodes are resolved, polygons are split into
 * triangles. */
struct kiln_mesh {
    uint32_t vertex_count, triangle_count; /* triangle_count is at least 1 */
    float (*vertices)[6];                  /* position, within 1e6; unit normal */
    uint32_t (*triangles)[3];              /* indices below vertex_count */
    /* texture coordinates of the vertices of an unwrapped mesh, else NULL */
    float (*uvs)[2];
    /* materials, of a mesh that was loaded with them, else NULL; its vertices have `uvs`, too, if
     * the file has some (asset/geometry/material.h) */
    struct kiln_mesh_looks *looks;
    float min[3], max[3];        /* bounds of the positions */
    uint32_t morph_target_count; /* of the meshes that a glTF file shows, together */
    /* SHA-256, in hex, of the hashes of the files that were read. Hashes of scenes and of their
     * motion contain it, so it may depend on nothing but the content of the files. */
    char hash[65];
    /* what of the file was changed or left out, for the user: a line each, none at the end; "":
     * nothing was */
    char notes[KILN_MESSAGE_SIZE];
};

/* Loads a file whose name ends in .obj, .gltf, .glb, .ply or .stl. Files that it names must lie in
 * its folder or below, and below the loader's root. The caller destroys the mesh. Returns NULL with
 * an error: KILN_IO when the file cannot be read or there is no importer; KILN_INVALID_INPUT, with
 * what was found and what is allowed, when the file is no mesh, broken, cut short, beyond the
 * limits above or names files elsewhere; KILN_DEVICE_FAILED when memory is short; KILN_OVER_LIMIT
 * when the scene's budget is spent; KILN_INTERRUPTED when the loader is told to stop. */
struct kiln_mesh *kiln_mesh_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error);

/* Loads a mesh as kiln_mesh_load does, with the first set of texture coordinates of every vertex.
 * A file without texture coordinates is KILN_INVALID_INPUT. Vertices that differ only in texture
 * coordinates stay separate, so this mesh may have more vertices than kiln_mesh_load gives it. */
struct kiln_mesh *kiln_mesh_load_unwrapped(struct kiln_loader *loader, const char *path,
                                           struct kiln_error *error);

/* Loads a mesh as kiln_mesh_load does, with its materials, and with what vertices have of texture
 * coordinates and colours. Vertices that differ only in these stay separate. The files that
 * materials name must lie in the mesh's folder or below, too. One that is missing, too large or
 * elsewhere is no error: the mesh's notes say so. They are no part of the mesh's hash. Textures are
 * not decoded. */
struct kiln_mesh *kiln_mesh_load_with_materials(struct kiln_loader *loader, const char *path,
                                                struct kiln_error *error);

/* Reverses all triangles if the volume that they enclose is negative, since files differ in which
 * winding is outside. */
void kiln_mesh_face_outwards(struct kiln_mesh *mesh);

/* Copies a mesh without its materials. NULL when memory is short. The caller destroys the copy. */
struct kiln_mesh *kiln_mesh_copy(const struct kiln_mesh *mesh);

/* Returns the bytes of the vertices and triangles of a mesh. */
uint64_t kiln_mesh_bytes(const struct kiln_mesh *mesh);

/* Loads a mesh as kiln_mesh_load does, from bytes in memory, which may name no other files. The end
 * of `name` tells the format, and `name` stands for the file in messages. Only tests call these. */
struct kiln_mesh *kiln_mesh_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error);
struct kiln_mesh *kiln_mesh_parse_with_materials(const void *bytes, size_t size, const char *name,
                                                 struct kiln_error *error);
void kiln_mesh_destroy(struct kiln_mesh **mesh);

#endif
