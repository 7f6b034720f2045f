/* A kiln_framebuffer is a set of images that shaders draw into at the same time. */
#ifndef KILN_GPU_FRAMEBUFFER_H
#define KILN_GPU_FRAMEBUFFER_H

#include "gpu/image.h"

enum { KILN_MAX_TARGETS = 4 };

/* Holds images of one size. A zero-initialised kiln_framebuffer holds none and may be finished. */
struct kiln_framebuffer {
    struct kiln_device *device;
    GLuint gl; /* created at the first bind */
    struct kiln_image *images[KILN_MAX_TARGETS];
    size_t count;
};

/* Takes 1 to KILN_MAX_TARGETS images, which must outlive the framebuffer, in the order of the
 * shader's outputs. device is NULL if the images are only drawn into on the host. Returns false
 * with an error on failure. */
bool kiln_framebuffer_init(struct kiln_framebuffer *framebuffer, struct kiln_device *device,
                           struct kiln_image *const *images, size_t count,
                           struct kiln_error *error);
void kiln_framebuffer_finish(struct kiln_framebuffer *framebuffer);

/* Binds the framebuffer and sets the viewport to its size. The images' host sides become stale,
 * since the next draw writes the textures. */
bool kiln_framebuffer_bind(struct kiln_framebuffer *framebuffer, struct kiln_error *error);

/* Draws one triangle over the whole bound framebuffer with the current program, whose vertex shader
 * must be gpu/framebuffer_fill.vert, or make that triangle of vertices 0 to 2. vertex_array: any
 * vertex array, since the shader reads no attributes. */
void kiln_framebuffer_fill(GLuint vertex_array);

#endif
