/* Declares how solid particles (opaque spheres and meshes) are drawn for backdrop=gl: spheres as
 * impostors, meshes as instances, with four samples a pixel. Only draw/solids/solids.c calls it;
 * solids.h explains the parameters. */
#ifndef KILN_DRAW_SOLIDS_SOLIDS_GL_H
#define KILN_DRAW_SOLIDS_SOLIDS_GL_H

#include "draw/solids/solids.h"

struct kiln_solids_gl;

/* The moment and the objects in params must outlive the stage. Returns NULL with an error. */
struct kiln_solids_gl *kiln_solids_gl_create(struct kiln_device *device,
                                             const struct kiln_moment *moment,
                                             const struct kiln_solids_params *params,
                                             struct kiln_error *error);
void kiln_solids_gl_destroy(struct kiln_solids_gl **stage);

/* Draws `count` particles, whose draw entries are in the buffer `entries`. It is called after
 * kiln_backdrop_draw, which leaves the uniform blocks and textures bound that it reads. Returns
 * false with an error. */
bool kiln_solids_gl_draw(struct kiln_solids_gl *stage, const struct kiln_moment *moment,
                         struct kiln_buffer *entries, uint32_t count, struct kiln_error *error);

#endif
