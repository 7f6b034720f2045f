/* This file creates integer textures with one framebuffer for all of them, binds them and draws
 * into them. Integer textures are neither filtered nor blended. */
#include "gpu/integer_textures.h"

#include "base/error.h"

bool kiln_integer_textures_init(struct kiln_integer_textures *set, struct kiln_device *device,
                                uint32_t count, uint32_t width, uint32_t height, const char *label,
                                struct kiln_error *error)
{
    *set = (struct kiln_integer_textures){.count = count, .width = width, .height = height};
    glGenVertexArrays(1, &set->vertex_array);
    glGenTextures((GLsizei)count, set->textures);
    glGenFramebuffers(1, &set->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, set->framebuffer);
    kiln_device_label(device, GL_FRAMEBUFFER, set->framebuffer, label);
    GLenum targets[KILN_MAX_INTEGER_TEXTURES];
    for (uint32_t i = 0; i < count; i++) {
        targets[i] = GL_COLOR_ATTACHMENT0 + i;
        glBindTexture(GL_TEXTURE_2D, set->textures[i]);
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32UI, (GLsizei)width, (GLsizei)height);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glFramebufferTexture2D(GL_FRAMEBUFFER, targets[i], GL_TEXTURE_2D, set->textures[i], 0);
        kiln_device_label(device, GL_TEXTURE, set->textures[i], label);
    }
    glBindTexture(GL_TEXTURE_2D, 0);
    glDrawBuffers((GLsizei)count, targets);
    if (!kiln_device_check(device, label, error))
        return false;
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: %s: incomplete (0x%04x)",
                              device->info.name, label, status);
    const GLuint zeros[4] = {0};
    for (uint32_t i = 0; i < count; i++)
        glClearBufferuiv(GL_COLOR, (GLint)i, zeros);
    return kiln_device_check(device, label, error);
}

void kiln_integer_textures_finish(struct kiln_integer_textures *set)
{
    if (set->framebuffer) {
        glDeleteFramebuffers(1, &set->framebuffer);
        glDeleteTextures((GLsizei)set->count, set->textures);
        glDeleteVertexArrays(1, &set->vertex_array);
    }
    *set = (struct kiln_integer_textures){.count = 0};
}

void kiln_integer_textures_bind(const struct kiln_integer_textures *set, GLuint first)
{
    for (uint32_t i = 0; i < set->count; i++) {
        glActiveTexture(GL_TEXTURE0 + first + i);
        glBindTexture(GL_TEXTURE_2D, set->textures[i]);
    }
    glActiveTexture(GL_TEXTURE0);
}

void kiln_integer_textures_draw(const struct kiln_integer_textures *set, uint32_t first_row,
                                uint32_t rows)
{
    glBindFramebuffer(GL_FRAMEBUFFER, set->framebuffer);
    glViewport(0, (GLint)first_row, (GLsizei)set->width, (GLsizei)rows);
    glBindVertexArray(set->vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
