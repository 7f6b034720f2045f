/* A kiln_buffer holds the same bytes on the host, in GL, or on both sides. A stage asks for them on
 * the side where it works, and they are copied only when that side is stale. */
#ifndef KILN_GPU_BUFFER_H
#define KILN_GPU_BUFFER_H

#include "gpu/device.h"

enum kiln_access {
    KILN_READ,       /* both sides stay valid */
    KILN_READ_WRITE, /* the other side becomes stale */
    KILN_OVERWRITE,  /* the other side becomes stale; nothing is copied, since the caller writes
                      * every byte */
};

struct kiln_buffer {
    struct kiln_device *device; /* NULL: host only */
    const char *label;
    size_t size;
    void *host; /* allocated at first use, 64-byte aligned */
    GLuint gl;  /* created at first use */
    bool host_valid, gl_valid;
    size_t content; /* bytes that are sent to GL; kiln_buffer_set_content makes it less than size */
};

/* Size 0 is allowed. The contents start as zeros. label must outlive the buffer. */
void kiln_buffer_init(struct kiln_buffer *buffer, struct kiln_device *device, size_t size,
                      const char *label);
void kiln_buffer_finish(struct kiln_buffer *buffer);

/* Enlarges the buffer to at least `size` bytes. Its contents are lost if it grows. */
void kiln_buffer_reserve(struct kiln_buffer *buffer, size_t size);

/* Returns the bytes on the host, or NULL with an error (KILN_DEVICE_FAILED: memory). */
void *kiln_buffer_host(struct kiln_buffer *buffer, enum kiln_access access,
                       struct kiln_error *error);

/* Declares that only the first `bytes` of the bytes just written on the host will be read, so that
 * only these are copied to GL. Applies until the next request to write on the host. */
void kiln_buffer_set_content(struct kiln_buffer *buffer, size_t bytes);

/* Returns the GL buffer object, or 0 with an error. A shader that wrote it needs no barrier before
 * kiln_buffer_host, which issues it. */
GLuint kiln_buffer_gl(struct kiln_buffer *buffer, enum kiln_access access,
                      struct kiln_error *error);

/* Copies all bytes to a buffer of the same size, on the host, or in GL if they are valid only
 * there. Both buffers must have the same device. */
bool kiln_buffer_copy(struct kiln_buffer *to, struct kiln_buffer *from, struct kiln_error *error);

/* Exchanges the contents of two buffers of one device and size that were last written in GL,
 * without copying: each takes the other's buffer object. */
void kiln_buffer_swap_gl(struct kiln_buffer *a, struct kiln_buffer *b);

/* Replaces all `size` bytes; returns the GL buffer object, or 0 with an error. */
GLuint kiln_buffer_upload(struct kiln_buffer *buffer, const void *bytes, struct kiln_error *error);

#endif
