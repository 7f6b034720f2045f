/* A kiln_instances_gl draws particles that are meshes, as instances, for technique backdrop=gl. */
#ifndef KILN_DRAW_SOLIDS_INSTANCES_GL_H
#define KILN_DRAW_SOLIDS_INSTANCES_GL_H

#include "draw/moment/moment.h"
#include "gpu/device.h"

struct kiln_instances_gl;

/* Makes the instances of a scene that has such particles. Returns NULL with an error. Device and
 * moment must outlive it. */
struct kiln_instances_gl *kiln_instances_gl_create(struct kiln_device *device,
                                                   const struct kiln_moment *moment,
                                                   struct kiln_error *error);
void kiln_instances_gl_destroy(struct kiln_instances_gl **meshes);

/* Draws the meshes among the first `count` entries with a depth test into the framebuffer at hand,
 * with what kiln_moment_bind and kiln_backdrop_draw left bound. */
bool kiln_instances_gl_draw(struct kiln_instances_gl *meshes, uint32_t count,
                            struct kiln_error *error);

#endif
