/* This header declares the sums of the shutter in GL; the functions are those of post/shutter.h. */
#ifndef KILN_POST_SHUTTER_GL_H
#define KILN_POST_SHUTTER_GL_H

#include "post/shutter.h"

struct kiln_shutter_gl;

/* sums: KILN_SHUTTER_SUM_COUNT images, which must outlive the result. */
struct kiln_shutter_gl *kiln_shutter_gl_create(struct kiln_device *device, struct kiln_image *sums,
                                               struct kiln_error *error);
void kiln_shutter_gl_destroy(struct kiln_shutter_gl **gl);

bool kiln_shutter_gl_add_composed(struct kiln_shutter_gl *gl,
                                  const struct kiln_composite_inputs *inputs, float weight,
                                  bool first, struct kiln_error *error);
bool kiln_shutter_gl_add(struct kiln_shutter_gl *gl, enum kiln_shutter_sum sum,
                         struct kiln_image *image, float weight, bool first,
                         struct kiln_error *error);

#endif
