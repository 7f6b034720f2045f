/* Technique `gl` runs stage `bloom` in fragment shaders. Its functions are those of
 * post/bloom.h. */
#ifndef KILN_POST_BLOOM_GL_H
#define KILN_POST_BLOOM_GL_H

#include "post/bloom.h"

struct kiln_bloom_gl;

struct kiln_bloom_gl *kiln_bloom_gl_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_bloom_params *params,
                                           struct kiln_error *error);
void kiln_bloom_gl_destroy(struct kiln_bloom_gl **stage);

struct kiln_image *kiln_bloom_gl_run(struct kiln_bloom_gl *stage,
                                     const struct kiln_bloom_inputs *inputs, float *scale,
                                     struct kiln_error *error);

#endif
