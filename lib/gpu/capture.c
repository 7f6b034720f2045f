/* This file sets up the GL objects of draws with transform feedback: a vertex array and a
 * framebuffer without images. Nothing is rasterised, but llvmpipe still requires a complete
 * framebuffer, and without a display there is no default framebuffer. */
#include "gpu/capture.h"

enum { WORD4_BYTES = 16 };

bool kiln_capture_init(struct kiln_capture *capture, struct kiln_device *device, GLuint attributes,
                       struct kiln_error *error)
{
    *capture = (struct kiln_capture){.vertex_array = 0};
    glGenVertexArrays(1, &capture->vertex_array);
    glBindVertexArray(capture->vertex_array);
    for (GLuint i = 0; i < attributes; i++) {
        glEnableVertexAttribArray(i);
        glVertexAttribIFormat(i, 4, GL_UNSIGNED_INT, i * WORD4_BYTES);
        glVertexAttribBinding(i, 0);
    }
    glGenFramebuffers(1, &capture->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, capture->framebuffer);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
    kiln_device_label(device, GL_FRAMEBUFFER, capture->framebuffer, "capture");
    return kiln_device_check(device, "transform feedback", error);
}

void kiln_capture_finish(struct kiln_capture *capture)
{
    if (capture->vertex_array)
        glDeleteVertexArrays(1, &capture->vertex_array);
    if (capture->framebuffer)
        glDeleteFramebuffers(1, &capture->framebuffer);
    *capture = (struct kiln_capture){.vertex_array = 0};
}

void kiln_capture_begin(const struct kiln_capture *capture)
{
    glBindFramebuffer(GL_FRAMEBUFFER, capture->framebuffer);
    glBindVertexArray(capture->vertex_array);
    glEnable(GL_RASTERIZER_DISCARD);
}

void kiln_capture_end(void)
{
    glDisable(GL_RASTERIZER_DISCARD);
}
