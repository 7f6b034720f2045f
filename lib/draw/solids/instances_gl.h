/* A kiln_instances_gl draws particles that are meshes by instanced draw calls, for technique
 * backdrop=gl. */
#ifndef KILN_DRAW_SOLIDS_INSTANCES_GL_H
#define KILN_DRAW_SOLIDS_INSTANCES_GL_H

#include "draw/moment/moment.h"
#include "gpu/device.h"

struct kiln_instances_gl;

/* Uploads the meshes of a scene that has particles that are meshes. Returns NULL with an error.
 * Device and moment must outlive the result. */
struct kiln_instances_gl *kiln_instances_gl_create(struct kiln_device *device,
                                                   const struct kiln_moment *moment,
                                                   struct kiln_error *error);
void kiln_instances_gl_destroy(struct kiln_instances_gl **meshes);

/* Draws the meshes among the first `count` entries into the bound framebuffer, with the caller's
 * depth test. The bindings of kiln_moment_bind and kiln_backdrop_draw must be in place. */
bool kiln_instances_gl_draw(struct kiln_instances_gl *meshes, uint32_t count,
                            struct kiln_error *error);

#endif
