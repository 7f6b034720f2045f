/* Technique `gl` runs stage `composite` in a fragment shader. Its functions are those of
 * post/composite.h. */
#ifndef KILN_POST_COMPOSITE_GL_H
#define KILN_POST_COMPOSITE_GL_H

#include "post/composite.h"

struct kiln_composite_gl;

struct kiln_composite_gl *kiln_composite_gl_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   const struct kiln_composite_params *params,
                                                   struct kiln_error *error);
void kiln_composite_gl_destroy(struct kiln_composite_gl **stage);

bool kiln_composite_gl_run(struct kiln_composite_gl *stage,
                           const struct kiln_composite_inputs *inputs, struct kiln_error *error);
bool kiln_composite_gl_read_display(struct kiln_composite_gl *stage, void *pixels,
                                    struct kiln_error *error);
bool kiln_composite_gl_read_beauty(struct kiln_composite_gl *stage, float *pixels,
                                   struct kiln_error *error);

#endif
