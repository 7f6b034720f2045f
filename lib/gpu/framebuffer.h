/* Drawing into images. */
#ifndef KILN_GPU_FRAMEBUFFER_H
#define KILN_GPU_FRAMEBUFFER_H

#include "gpu/image.h"

/* A framebuffer object that draws into up to 4 images, in order; 0 with an error. The images must
 * outlive it; the caller deletes it with kiln_framebuffer_destroy. */
GLuint kiln_framebuffer_create(struct kiln_device *device, struct kiln_image *const *images,
                               size_t count, struct kiln_error *error);
void kiln_framebuffer_destroy(GLuint *framebuffer);

/* Draws one triangle over the whole of the bound framebuffer, width x height pixels, with the bound
 * program (its vertex shader is draw/fullscreen.vert). vertex_array: any, it has no attributes. */
void kiln_framebuffer_fill(GLuint vertex_array, uint32_t width, uint32_t height);

#endif
