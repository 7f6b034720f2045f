/* A kiln_image is a two-dimensional render target that is on the host, in GL, or on both sides,
 * like a kiln_buffer. Its texture has one level, filters linearly and clamps at its edge. */
#ifndef KILN_GPU_IMAGE_H
#define KILN_GPU_IMAGE_H

#include "gpu/buffer.h"

struct kiln_image {
    struct kiln_device *device; /* NULL: host only */
    const char *label;
    uint32_t width, height, channels; /* size in pixels; 1 or 4 channels */
    GLenum gl_format; /* GL_R32F or a format of four channels; the host side is always float */
    float *host;      /* rows from the top, pixels interleaved */
    GLuint gl;        /* texture; row 0 is the top row, since kiln draws with y down */
    bool host_valid, gl_valid;
};

/* The contents are undefined until they are written. label must outlive the image. */
void kiln_image_init(struct kiln_image *image, struct kiln_device *device, uint32_t width,
                     uint32_t height, GLenum gl_format, const char *label);
void kiln_image_finish(struct kiln_image *image);
float *kiln_image_host(struct kiln_image *image, enum kiln_access access, struct kiln_error *error);
GLuint kiln_image_gl(struct kiln_image *image, enum kiln_access access, struct kiln_error *error);

/* Exchanges the pixels of an image that is on the host alone for those at *pixels: memory of the
 * same size, which free() frees. */
void kiln_image_exchange(struct kiln_image *image, float **pixels);

#endif
