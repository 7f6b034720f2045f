/* A kiln_framebuffer is a set of images that shaders draw into together. */
#ifndef KILN_GPU_FRAMEBUFFER_H
#define KILN_GPU_FRAMEBUFFER_H

#include "gpu/image.h"

enum { KILN_MAX_TARGETS = 4 };

/* Holds images of one size that are drawn into together. Zero-initialised has none. */
struct kiln_framebuffer {
    struct kiln_device *device;
    GLuint gl; /* made when it is bound first */
    struct kiln_image *images[KILN_MAX_TARGETS];
    size_t count;
};

/* Takes 1 to KILN_MAX_TARGETS images, in the order of the shader's outputs; they must outlive it.
 * device NULL: its images are only drawn into on the host. Returns false with an error. */
bool kiln_framebuffer_init(struct kiln_framebuffer *framebuffer, struct kiln_device *device,
                           struct kiln_image *const *images, size_t count,
                           struct kiln_error *error);
void kiln_framebuffer_finish(struct kiln_framebuffer *framebuffer);

/* Binds it with a viewport over all of it. The images' host sides become stale, since the next draw
 * writes the textures. */
bool kiln_framebuffer_bind(struct kiln_framebuffer *framebuffer, struct kiln_error *error);

/* Draws one triangle over the whole of the bound framebuffer with the bound program, whose vertex
 * shader is gpu/framebuffer_fill.vert. vertex_array: any, it has no attributes. */
void kiln_framebuffer_fill(GLuint vertex_array);

#endif
