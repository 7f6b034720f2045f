/* Memory with a residency: the same bytes on the host, in GL, or both. A stage asks for them where
 * it works, and they move only when they must. */
#ifndef KILN_GPU_BUFFER_H
#define KILN_GPU_BUFFER_H

#include "gpu/device.h"

enum kiln_access {
    KILN_READ,       /* the other side stays valid */
    KILN_READ_WRITE, /* the other side becomes stale */
    KILN_OVERWRITE,  /* as above, and what was there is not fetched: every byte will be written */
};

struct kiln_buffer {
    struct kiln_device *device; /* NULL: host only */
    const char *label;
    size_t size;
    void *host; /* allocated at first use, 64-byte aligned */
    GLuint gl;  /* created at first use */
    bool host_valid, gl_valid;
    size_t content; /* bytes that GL is sent: all, unless who wrote them on the host knows better */
};

/* Size 0 is allowed. Contents start as zeros. label must outlive the buffer. */
void kiln_buffer_init(struct kiln_buffer *buffer, struct kiln_device *device, size_t size,
                      const char *label);
void kiln_buffer_finish(struct kiln_buffer *buffer);

/* Makes it at least so large; what is in it is lost if it grows. */
void kiln_buffer_reserve(struct kiln_buffer *buffer, size_t size);

/* The bytes on the host, or NULL with an error (KILN_DEVICE_FAILED: memory). */
void *kiln_buffer_host(struct kiln_buffer *buffer, enum kiln_access access,
                       struct kiln_error *error);

/* Of what the host has just written, nobody will read more than the first so many bytes. Holds
 * until the host asks to write again. */
void kiln_buffer_set_content(struct kiln_buffer *buffer, size_t bytes);

/* The GL buffer object, or 0 with an error. A shader that wrote it needs no barrier before
 * kiln_buffer_host, which issues it. */
GLuint kiln_buffer_gl(struct kiln_buffer *buffer, enum kiln_access access,
                      struct kiln_error *error);

/* Exchanges the contents of two buffers of one device and size that were last written in GL,
 * without copying: each takes the other's buffer object. */
void kiln_buffer_swap_gl(struct kiln_buffer *a, struct kiln_buffer *b);

/* Replaces all `size` bytes; returns the GL buffer object, or 0 with an error. */
GLuint kiln_buffer_upload(struct kiln_buffer *buffer, const void *bytes, struct kiln_error *error);

#endif
