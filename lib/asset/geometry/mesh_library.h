/* Holds the meshes of a scene. Each file is imported only once, even if several objects show it or
 * collide with it. Meshes are imported while the scene is loaded, by one thread; afterwards any
 * number of threads may read them. */
#ifndef KILN_ASSET_GEOMETRY_MESH_LIBRARY_H
#define KILN_ASSET_GEOMETRY_MESH_LIBRARY_H

#include "asset/geometry/rig.h"
#include "asset/geometry/skin.h"

struct kiln_mesh_library;

/* Creates an empty library. Triangles are counted in the loader's budget; the loader must outlive
 * the library. NULL when memory is short. */
struct kiln_mesh_library *kiln_mesh_library_create(struct kiln_loader *loader);

/* Frees the library and all its meshes. */
void kiln_mesh_library_destroy(struct kiln_mesh_library **library);

/* Return the result of kiln_mesh_load, kiln_mesh_load_unwrapped, kiln_skin_load or kiln_rig_load
 * for a file, which is imported unless the library has it. Errors are those of these functions, and
 * KILN_OVER_LIMIT. The library owns the result. */
const struct kiln_mesh *kiln_mesh_library_get(struct kiln_mesh_library *library, const char *path,
                                              struct kiln_error *error);
const struct kiln_mesh *kiln_mesh_library_get_unwrapped(struct kiln_mesh_library *library,
                                                        const char *path, struct kiln_error *error);
const struct kiln_skin *kiln_mesh_library_get_skin(struct kiln_mesh_library *library,
                                                   const char *path, struct kiln_error *error);

const struct kiln_rig *kiln_mesh_library_get_rig(struct kiln_mesh_library *library,
                                                 const char *path, struct kiln_error *error);

/* Returns the bytes of all meshes, skins and rigs. */
uint64_t kiln_mesh_library_bytes(const struct kiln_mesh_library *library);

/* Visits each file of the library that has a mesh once, in the order of the paths. skin: of a mesh
 * that moves, else NULL. Stops and returns false when a visit does, or when memory is short. */
bool kiln_mesh_library_visit(const struct kiln_mesh_library *library,
                             bool (*visit)(void *user, const char *path,
                                           const struct kiln_mesh *mesh,
                                           const struct kiln_skin *skin),
                             void *user);

#endif
