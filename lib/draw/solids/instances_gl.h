/* Technique backdrop=gl: particles that are meshes, as instances. */
#ifndef KILN_DRAW_INSTANCES_GL_H
#define KILN_DRAW_INSTANCES_GL_H

#include "gpu/device.h"
#include "scene/scene.h"

struct kiln_instances_gl;

/* Whether the scene has any. */
bool kiln_instances_gl_exist(const struct kiln_scene *scene);

/* NULL with an error. Device and scene must outlive it. */
struct kiln_instances_gl *kiln_instances_gl_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   struct kiln_error *error);
void kiln_instances_gl_destroy(struct kiln_instances_gl **meshes);

/* Draws the meshes among the first `count` entries with a depth test into the framebuffer at hand,
 * with what kiln_particles_bind and kiln_backdrop_draw left bound. */
bool kiln_instances_gl_draw(struct kiln_instances_gl *meshes, uint32_t count,
                            struct kiln_error *error);

#endif
