/* The backdrop's meshes, rasterised for its rays, and their shadow maps. */
#ifndef KILN_DRAW_MESHES_H
#define KILN_DRAW_MESHES_H

#include "draw/shapes.h"
#include "gpu/device.h"

struct kiln_meshes;

/* Loads the scene's meshes (KILN_INVALID_INPUT as kiln_mesh_load) and makes targets of the scene's
 * size; a scene without meshes makes none. The scene must outlive it. */
struct kiln_meshes *kiln_meshes_create(struct kiln_device *device, const struct kiln_scene *scene,
                                       struct kiln_error *error);
void kiln_meshes_destroy(struct kiln_meshes **meshes);

/* In the scene's order, for kiln_shapes_fill. */
struct kiln_mesh *const *kiln_meshes_loaded(const struct kiln_meshes *meshes);

/* Binds the texture that kiln_meshes_draw fills with what the sun sees to KILN_UNIT_MESH_SHADOW. */
void kiln_meshes_bind_shadows(const struct kiln_meshes *meshes);

/* Draws what the camera and the sun see of them and leaves that bound to KILN_UNIT_MESH_HITS and
 * KILN_UNIT_MESH_SHADOW; the blocks of the view, the backdrop and the shapes must be bound.
 * Changes the framebuffer, the viewport and the program. */
bool kiln_meshes_draw(struct kiln_meshes *meshes, const struct kiln_draw_shapes *shapes,
                      struct kiln_error *error);

#endif
