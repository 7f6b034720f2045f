/* A kiln_coarse_gl converts between a frame and its coarse picture by fragment shaders. Its
 * functions do what those of kiln_coarse_cpu do on the host (draw/sprites/coarse_cpu.h). */
#ifndef KILN_DRAW_SPRITES_COARSE_GL_H
#define KILN_DRAW_SPRITES_COARSE_GL_H

#include "draw/sprites/coarse_images.h"

struct kiln_coarse_gl;

/* Returns NULL with an error. images and device must outlive the result. */
struct kiln_coarse_gl *kiln_coarse_gl_create(struct kiln_device *device,
                                             struct kiln_coarse_images *images,
                                             struct kiln_error *error);
void kiln_coarse_gl_destroy(struct kiln_coarse_gl **coarse);

bool kiln_coarse_gl_measure(struct kiln_coarse_gl *coarse, struct kiln_image *depth,
                            struct kiln_error *error);
bool kiln_coarse_gl_enlarge(struct kiln_coarse_gl *coarse, const struct kiln_coarse_blend *blend,
                            struct kiln_image *depth, struct kiln_error *error);

#endif
