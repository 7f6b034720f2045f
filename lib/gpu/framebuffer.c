/* This file creates framebuffer objects with images as attachments, binds them and draws over a
 * whole framebuffer. A GL framebuffer is created at the first bind and reused in later frames. */
#include "gpu/framebuffer.h"

#include "base/error.h"

bool kiln_framebuffer_init(struct kiln_framebuffer *framebuffer, struct kiln_device *device,
                           struct kiln_image *const *images, size_t count, struct kiln_error *error)
{
    *framebuffer = (struct kiln_framebuffer){.device = device};
    if (count < 1 || count > KILN_MAX_TARGETS)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "a framebuffer of %zu images; 1 to %d",
                              count, KILN_MAX_TARGETS);
    for (size_t i = 0; i < count; i++)
        framebuffer->images[i] = images[i];
    framebuffer->count = count;
    return true;
}

void kiln_framebuffer_finish(struct kiln_framebuffer *framebuffer)
{
    if (framebuffer->gl)
        glDeleteFramebuffers(1, &framebuffer->gl);
    *framebuffer = (struct kiln_framebuffer){.gl = 0};
}

/* Creates the GL framebuffer and binds it. The images must have their textures. */
static bool create(struct kiln_framebuffer *framebuffer, struct kiln_error *error)
{
    struct kiln_device *device = framebuffer->device;
    struct kiln_image *const *images = framebuffer->images;
    GLenum buffers[KILN_MAX_TARGETS];
    glGenFramebuffers(1, &framebuffer->gl);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer->gl);
    for (size_t i = 0; i < framebuffer->count; i++) {
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        glFramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, images[i]->gl, 0);
    }
    glDrawBuffers((GLsizei)framebuffer->count, buffers);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "%s: framebuffer with '%s' is incomplete (0x%04x)", device->info.name,
                              images[0]->label, status);
    kiln_device_label(device, GL_FRAMEBUFFER, framebuffer->gl, images[0]->label);
    return kiln_device_check(device, images[0]->label, error);
}

bool kiln_framebuffer_bind(struct kiln_framebuffer *framebuffer, struct kiln_error *error)
{
    for (size_t i = 0; i < framebuffer->count; i++) {
        if (!kiln_image_gl(framebuffer->images[i], KILN_READ_WRITE, error))
            return false;
    }
    if (!framebuffer->gl && !create(framebuffer, error))
        return false;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer->gl);
    glViewport(0, 0, (GLsizei)framebuffer->images[0]->width,
               (GLsizei)framebuffer->images[0]->height);
    return true;
}

void kiln_framebuffer_fill(GLuint vertex_array)
{
    glBindVertexArray(vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
