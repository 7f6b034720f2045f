/* This file allocates buffers on the host and in GL and copies their bytes between the two sides
 * when one of them is stale. All GL calls bind GL_COPY_WRITE_BUFFER, which no draw or dispatch
 * uses. */
#include "gpu/buffer.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"

enum { LEAST_SIZE = 64 };

void kiln_buffer_init(struct kiln_buffer *buffer, struct kiln_device *device, size_t size,
                      const char *label)
{
    *buffer = (struct kiln_buffer){.device = device, .label = label, .size = size, .content = size};
}

void kiln_buffer_finish(struct kiln_buffer *buffer)
{
    if (buffer->gl)
        glDeleteBuffers(1, &buffer->gl);
    free(buffer->host);
    *buffer = (struct kiln_buffer){.device = NULL};
}

void kiln_buffer_reserve(struct kiln_buffer *buffer, size_t size)
{
    if (buffer->size >= size)
        return;
    struct kiln_device *device = buffer->device;
    const char *label = buffer->label;
    kiln_buffer_finish(buffer);
    kiln_buffer_init(buffer, device, size, label);
}

/* Returns how many bytes to allocate. The result is never 0, so that a buffer of size 0 has an
 * address as well. */
static size_t storage_size(const struct kiln_buffer *buffer)
{
    return buffer->size > LEAST_SIZE ? buffer->size : LEAST_SIZE;
}

static bool allocate_host(struct kiln_buffer *buffer, struct kiln_error *error)
{
    const size_t size = storage_size(buffer);
    buffer->host = kiln_alloc_pages(size);
    if (!buffer->host)
        return kiln_error_no_memory(error, "%zu bytes of the buffer '%s' on the host", buffer->size,
                                    buffer->label);
    if (!buffer->gl_valid)
        memset(buffer->host, 0, size);
    return true;
}

static bool copy_to_host(struct kiln_buffer *buffer, struct kiln_error *error)
{
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->gl);
    glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)buffer->size, buffer->host);
    buffer->device->traffic.to_host += buffer->size;
    return kiln_device_check(buffer->device, buffer->label, error);
}

void *kiln_buffer_host(struct kiln_buffer *buffer, enum kiln_access access,
                       struct kiln_error *error)
{
    if (!buffer->host && !allocate_host(buffer, error))
        return NULL;
    if (!buffer->host_valid && buffer->gl_valid && access != KILN_OVERWRITE &&
        !copy_to_host(buffer, error))
        return NULL;
    buffer->host_valid = true;
    if (access != KILN_READ) {
        buffer->gl_valid = false;
        buffer->content = buffer->size;
    }
    return buffer->host;
}

void kiln_buffer_set_content(struct kiln_buffer *buffer, size_t bytes)
{
    assert(bytes <= buffer->size);
    buffer->content = bytes;
}

static bool allocate_gl(struct kiln_buffer *buffer, struct kiln_error *error)
{
    const size_t size = storage_size(buffer);
    if (!buffer->device)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: a host buffer is not in GL",
                              buffer->label);
    if (size > PTRDIFF_MAX)
        return kiln_error_no_memory(error, "%zu bytes of the buffer '%s' in GL", size,
                                    buffer->label);
    GLuint gl = 0;
    glGenBuffers(1, &gl);
    glBindBuffer(GL_COPY_WRITE_BUFFER, gl);
    glBufferData(GL_COPY_WRITE_BUFFER, (GLsizeiptr)size, NULL, GL_DYNAMIC_COPY);
    char description[128]; /* the size shows why memory may run out */
    snprintf(description, sizeof description, "%s, %zu bytes", buffer->label, size);
    if (!kiln_device_check(buffer->device, description, error)) {
        glDeleteBuffers(1, &gl);
        return false;
    }
    kiln_device_label(buffer->device, GL_BUFFER, gl, buffer->label);
    if (!buffer->host_valid) {
        const GLuint zero = 0;
        glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    }
    buffer->gl = gl;
    return true;
}

static bool copy_to_gl(struct kiln_buffer *buffer, struct kiln_error *error)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->gl);
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)buffer->content, buffer->host);
    buffer->device->traffic.to_device += buffer->content;
    return kiln_device_check(buffer->device, buffer->label, error);
}

GLuint kiln_buffer_gl(struct kiln_buffer *buffer, enum kiln_access access, struct kiln_error *error)
{
    if (!buffer->gl && !allocate_gl(buffer, error))
        return 0;
    if (!buffer->gl_valid && buffer->host_valid && access != KILN_OVERWRITE &&
        !copy_to_gl(buffer, error))
        return 0;
    buffer->gl_valid = true;
    if (access != KILN_READ)
        buffer->host_valid = false;
    return buffer->gl;
}

bool kiln_buffer_copy(struct kiln_buffer *to, struct kiln_buffer *from, struct kiln_error *error)
{
    assert(to->size == from->size && to->device == from->device);
    if (from->host_valid || !from->gl_valid) {
        const void *source = kiln_buffer_host(from, KILN_READ, error);
        void *target = source ? kiln_buffer_host(to, KILN_OVERWRITE, error) : NULL;
        if (target)
            memcpy(target, source, from->size);
        return target != NULL;
    }
    if (!kiln_buffer_gl(to, KILN_OVERWRITE, error))
        return false;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, from->gl);
    glBindBuffer(GL_COPY_WRITE_BUFFER, to->gl);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, (GLsizeiptr)from->size);
    return kiln_device_check(to->device, to->label, error);
}

void kiln_buffer_swap_gl(struct kiln_buffer *a, struct kiln_buffer *b)
{
    assert(a->size == b->size && a->gl && b->gl && a->gl_valid && b->gl_valid);
    const GLuint gl = a->gl;
    a->gl = b->gl;
    b->gl = gl;
    a->host_valid = b->host_valid = false;
    kiln_device_label(a->device, GL_BUFFER, a->gl, a->label);
    kiln_device_label(b->device, GL_BUFFER, b->gl, b->label);
}

GLuint kiln_buffer_upload(struct kiln_buffer *buffer, const void *bytes, struct kiln_error *error)
{
    void *host = kiln_buffer_host(buffer, KILN_OVERWRITE, error);
    if (!host)
        return 0;
    memcpy(host, bytes, buffer->size);
    return kiln_buffer_gl(buffer, KILN_READ, error);
}
