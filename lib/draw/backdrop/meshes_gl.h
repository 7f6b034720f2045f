/* This header declares how technique backdrop=gl rasterises meshes for its rays and draws their
 * shadow maps. */
#ifndef KILN_DRAW_BACKDROP_MESHES_GL_H
#define KILN_DRAW_BACKDROP_MESHES_GL_H

#include "draw/moment/meshes.h"
#include "draw/moment/shapes.h"
#include "gpu/device.h"

struct kiln_meshes_gl;

/* Creates targets of the scene's size, or none for a scene without meshes; NULL with an error.
 * Scene and meshes must outlive them. */
struct kiln_meshes_gl *kiln_meshes_gl_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_meshes *meshes,
                                             struct kiln_error *error);
void kiln_meshes_gl_destroy(struct kiln_meshes_gl **meshes);

/* Binds the shadow maps that kiln_meshes_gl_draw draws to KILN_UNIT_MESH_SHADOW. */
void kiln_meshes_gl_bind_shadows(const struct kiln_meshes_gl *meshes);

/* Draws the meshes as the camera and the sun see them. The results stay bound to
 * KILN_UNIT_MESH_HITS and KILN_UNIT_MESH_SHADOW, and the paint as of the last kiln_painted_update
 * to KILN_UNIT_MESH_PAINT. The blocks of the view, the backdrop and the shapes must be bound.
 * Changes the framebuffer, the viewport and the program. */
bool kiln_meshes_gl_draw(struct kiln_meshes_gl *meshes, const struct kiln_draw_shapes *shapes,
                         struct kiln_error *error);

#endif
