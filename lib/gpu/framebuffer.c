/* Framebuffer objects are made once per set of targets, not per frame. */
#include "gpu/framebuffer.h"

#include "base/error.h"

enum { MAX_ATTACHMENTS = 4 };

GLuint kiln_framebuffer_create(struct kiln_device *device, struct kiln_image *const *images,
                               size_t count, struct kiln_error *error)
{
    GLuint framebuffer = 0;
    GLenum buffers[MAX_ATTACHMENTS];
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    for (size_t i = 0; i < count && i < MAX_ATTACHMENTS; i++) {
        GLuint texture = kiln_image_gl(images[i], KILN_OVERWRITE, error);
        if (!texture)
            goto fail;
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        glFramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, texture, 0);
    }
    glDrawBuffers((GLsizei)count, buffers);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        kiln_error_set(error, KILN_DEVICE_FAILED,
                       "%s: framebuffer with '%s' is incomplete (0x%04x)", device->info.name,
                       images[0]->label, status);
        goto fail;
    }
    kiln_device_label(device, GL_FRAMEBUFFER, framebuffer, images[0]->label);
    return framebuffer;

fail:
    kiln_framebuffer_destroy(&framebuffer);
    return 0;
}

void kiln_framebuffer_destroy(GLuint *framebuffer)
{
    if (*framebuffer)
        glDeleteFramebuffers(1, framebuffer);
    *framebuffer = 0;
}

void kiln_framebuffer_fill(GLuint vertex_array, uint32_t width, uint32_t height)
{
    glViewport(0, 0, (GLsizei)width, (GLsizei)height);
    glBindVertexArray(vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
