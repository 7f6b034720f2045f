/* The meshes of a scene, each imported once, however many show it or collide with it. They are
 * imported while the scene is loaded. Filling one is for one thread; what is in it is for any
 * number. */
#ifndef KILN_ASSET_GEOMETRY_MESH_LIBRARY_H
#define KILN_ASSET_GEOMETRY_MESH_LIBRARY_H

#include "asset/geometry/skin.h"

struct kiln_mesh_library;

/* The loader, in whose budget triangles are counted, must outlive it. NULL: no memory. */
struct kiln_mesh_library *kiln_mesh_library_create(struct kiln_loader *loader);

/* Frees all meshes in it. */
void kiln_mesh_library_destroy(struct kiln_mesh_library **library);

/* What kiln_mesh_load, kiln_mesh_load_unwrapped and kiln_skin_load give, with their errors and
 * KILN_OVER_LIMIT, out of the library or imported into it. They are the library's. */
const struct kiln_mesh *kiln_mesh_library_get(struct kiln_mesh_library *library, const char *path,
                                              struct kiln_error *error);
const struct kiln_mesh *kiln_mesh_library_get_unwrapped(struct kiln_mesh_library *library,
                                                        const char *path, struct kiln_error *error);
const struct kiln_skin *kiln_mesh_library_get_skin(struct kiln_mesh_library *library,
                                                   const char *path, struct kiln_error *error);

#endif
