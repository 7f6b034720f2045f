/* This header declares solid particles for technique backdrop=gl, which draws spheres as impostors
 * and meshes as instances, with four samples a pixel. */
#ifndef KILN_DRAW_SOLIDS_SOLIDS_GL_H
#define KILN_DRAW_SOLIDS_SOLIDS_GL_H

#include "draw/solids/solids.h"

struct kiln_solids_gl;

struct kiln_solids_gl *kiln_solids_gl_create(struct kiln_device *device,
                                             const struct kiln_moment *moment,
                                             const struct kiln_solids_params *params,
                                             struct kiln_error *error);
void kiln_solids_gl_destroy(struct kiln_solids_gl **stage);

/* Draws the solids. kiln_backdrop_draw must have bound the blocks of view and backdrop. */
bool kiln_solids_gl_draw(struct kiln_solids_gl *stage, const struct kiln_moment *moment,
                         struct kiln_buffer *entries, uint32_t count, struct kiln_error *error);

#endif
