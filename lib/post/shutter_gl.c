/* This file adds the pictures of moments to the sums of the shutter in GL. Each picture is drawn,
 * times its weight, with additive blending into a sum, whose image has float channels.
 *
 * shutter.c owns the images of the sums. It calls this file for each moment of a frame if the
 * composite runs in GL, and otherwise adds on the host. Both must give the same sums except for
 * rounding. The first moment of a frame is drawn without blending and so replaces the sum of the
 * frame before; the pass must therefore write every pixel. */
#include "post/shutter_gl.h"

#include <stdlib.h>

#include "base/error.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"

struct kiln_shutter_gl {
    struct kiln_device *device;
    GLuint compose, add, vertex_array;
    GLint compose_weight, separate_fire, add_weight;
    struct kiln_framebuffer sums[KILN_SHUTTER_SUM_COUNT];
};

static GLuint make_program(struct kiln_device *device, const char *fragment,
                           struct kiln_error *error)
{
    return kiln_program_create(
        device,
        &(struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert", .fragment = fragment},
        error);
}

struct kiln_shutter_gl *kiln_shutter_gl_create(struct kiln_device *device, struct kiln_image *sums,
                                               struct kiln_error *error)
{
    struct kiln_shutter_gl *gl = calloc(1, sizeof *gl);
    if (!gl) {
        kiln_error_no_memory(error, "the shutter");
        return NULL;
    }
    gl->device = device;
    gl->compose = make_program(device, "post/shutter_compose.frag", error);
    if (gl->compose)
        gl->add = make_program(device, "post/shutter_add.frag", error);
    bool ok = gl->add != 0;
    for (int i = 0; ok && i < KILN_SHUTTER_SUM_COUNT; i++) {
        struct kiln_image *image = &sums[i];
        ok = kiln_framebuffer_init(&gl->sums[i], device, &image, 1, error);
    }
    if (!ok) {
        kiln_shutter_gl_destroy(&gl);
        return NULL;
    }
    gl->compose_weight = glGetUniformLocation(gl->compose, "weight");
    gl->separate_fire = glGetUniformLocation(gl->compose, "separate_fire");
    gl->add_weight = glGetUniformLocation(gl->add, "weight");
    glGenVertexArrays(1, &gl->vertex_array);
    return gl;
}

void kiln_shutter_gl_destroy(struct kiln_shutter_gl **gl)
{
    struct kiln_shutter_gl *s = *gl;
    if (!s)
        return;
    for (int i = 0; i < KILN_SHUTTER_SUM_COUNT; i++)
        kiln_framebuffer_finish(&s->sums[i]);
    glDeleteProgram(s->compose); /* GL ignores 0 */
    glDeleteProgram(s->add);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *gl = NULL;
}

/* Binds images to texture units from 0 on, in the order in which the shader numbers them. An image
 * that is NULL leaves its unit empty. */
static bool bind_images(struct kiln_image *const *images, GLuint count, struct kiln_error *error)
{
    for (GLuint unit = 0; unit < count; unit++) {
        GLuint texture = images[unit] ? kiln_image_gl(images[unit], KILN_READ, error) : 0;
        if (images[unit] && !texture)
            return false;
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture);
    }
    return true;
}

/* Draws the picture of a moment into a sum. The caller has chosen the program and bound its images.
 */
static bool add_pass(struct kiln_shutter_gl *gl, enum kiln_shutter_sum sum, bool first,
                     struct kiln_error *error)
{
    if (!kiln_framebuffer_bind(&gl->sums[sum], error))
        return false;
    if (!first) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
    }
    kiln_framebuffer_fill(gl->vertex_array);
    glDisable(GL_BLEND);
    return kiln_device_check(gl->device, "shutter", error);
}

bool kiln_shutter_gl_add_composed(struct kiln_shutter_gl *gl,
                                  const struct kiln_composite_inputs *inputs, float weight,
                                  bool first, struct kiln_error *error)
{
    struct kiln_image *const images[] = {inputs->scene, inputs->particles, inputs->fire};
    glUseProgram(gl->compose);
    glUniform1f(gl->compose_weight, weight);
    glUniform1i(gl->separate_fire, inputs->fire != NULL);
    return bind_images(images, 3, error) && add_pass(gl, KILN_SHUTTER_COMPOSED, first, error);
}

bool kiln_shutter_gl_add(struct kiln_shutter_gl *gl, enum kiln_shutter_sum sum,
                         struct kiln_image *image, float weight, bool first,
                         struct kiln_error *error)
{
    glUseProgram(gl->add);
    glUniform1f(gl->add_weight, weight);
    return bind_images(&image, 1, error) && add_pass(gl, sum, first, error);
}
