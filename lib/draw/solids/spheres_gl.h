/* Technique backdrop=gl: spheres as impostors with four samples a pixel. */
#ifndef KILN_DRAW_SPHERES_GL_H
#define KILN_DRAW_SPHERES_GL_H

#include "draw/solids/spheres.h"

struct kiln_spheres_gl;

struct kiln_spheres_gl *kiln_spheres_gl_create(struct kiln_device *device,
                                               const struct kiln_scene *scene,
                                               const struct kiln_spheres_params *params,
                                               struct kiln_error *error);
void kiln_spheres_gl_destroy(struct kiln_spheres_gl **stage);

/* With the view and backdrop blocks that kiln_backdrop_draw left bound. */
bool kiln_spheres_gl_draw(struct kiln_spheres_gl *stage, struct kiln_pool *pool,
                          struct kiln_buffer *entries, uint32_t count, float time_s,
                          struct kiln_error *error);

#endif
