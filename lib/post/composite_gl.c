/* This file composes the picture in GL: one full-screen pass writes both the display picture and
 * the linear picture. */
#include "post/composite_gl.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"
#include "shared/exact.h"

struct uniforms {
    GLint bloom_strength, bloom_scale, separate_fire, scene_alone, exposure, tonemap, levels,
        dither, frame, texture;
};

struct kiln_composite_gl {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    uint32_t bits;
    bool texture;
    GLuint program, vertex_array;
    struct kiln_framebuffer framebuffer;
    struct kiln_image display, beauty;
    struct uniforms locations;
};

static void find_uniforms(struct kiln_composite_gl *stage)
{
    GLuint p = stage->program;
    stage->locations = (struct uniforms){
        .bloom_strength = glGetUniformLocation(p, "bloom_strength"),
        .bloom_scale = glGetUniformLocation(p, "bloom_scale"),
        .scene_alone = glGetUniformLocation(p, "scene_alone"),
        .separate_fire = glGetUniformLocation(p, "separate_fire"),
        .exposure = glGetUniformLocation(p, "exposure"),
        .tonemap = glGetUniformLocation(p, "tonemap"),
        .levels = glGetUniformLocation(p, "levels"),
        .dither = glGetUniformLocation(p, "dither"),
        .frame = glGetUniformLocation(p, "frame"),
        .texture = glGetUniformLocation(p, "is_texture"),
    };
}

struct kiln_composite_gl *kiln_composite_gl_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   const struct kiln_composite_params *params,
                                                   struct kiln_error *error)
{
    struct kiln_composite_gl *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the composite");
        return NULL;
    }
    *stage = (struct kiln_composite_gl){
        .device = device, .scene = scene, .bits = params->bits, .texture = params->texture};
    stage->program =
        kiln_program_create(device,
                            &(struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert",
                                                          .fragment = "post/composite.frag"},
                            error);
    kiln_image_init(&stage->display, device, scene->width, scene->height,
                    params->bits == 16 ? GL_RGBA16 : GL_RGBA8, "display");
    kiln_image_init(&stage->beauty, device, scene->width, scene->height, GL_RGBA32F, "beauty");
    struct kiln_image *targets[] = {&stage->display, &stage->beauty};
    if (!stage->program || !kiln_framebuffer_init(&stage->framebuffer, device, targets, 2, error)) {
        kiln_composite_gl_destroy(&stage);
        return NULL;
    }
    find_uniforms(stage);
    glGenVertexArrays(1, &stage->vertex_array);
    return stage;
}

void kiln_composite_gl_destroy(struct kiln_composite_gl **stage)
{
    struct kiln_composite_gl *s = *stage;
    if (!s)
        return;
    if (s->program)
        glDeleteProgram(s->program);
    kiln_framebuffer_finish(&s->framebuffer);
    kiln_image_finish(&s->display);
    kiln_image_finish(&s->beauty);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *stage = NULL;
}

/* Binds the inputs to texture units 0 to 3. The unit of an absent input stays empty, and the shader
 * does not read it. */
static bool bind_inputs(const struct kiln_composite_inputs *inputs, struct kiln_error *error)
{
    struct kiln_image *images[] = {inputs->scene, inputs->particles, inputs->fire, inputs->bloom};
    for (GLuint unit = 0; unit < 4; unit++) {
        GLuint texture = 0;
        if (images[unit]) {
            texture = kiln_image_gl(images[unit], KILN_READ, error);
            if (!texture)
                return false;
        }
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture);
    }
    return true;
}

bool kiln_composite_gl_run(struct kiln_composite_gl *stage,
                           const struct kiln_composite_inputs *inputs, struct kiln_error *error)
{
    const struct kiln_scene *scene = stage->scene;
    const struct kiln_post *post = &scene->post;
    if (!bind_inputs(inputs, error) || !kiln_framebuffer_bind(&stage->framebuffer, error))
        return false;

    glUseProgram(stage->program);
    float strength = 0.0f;
    if (inputs->bloom)
        strength = kiln_scene_value(scene, &post->bloom_strength, inputs->time_s);
    glUniform1f(stage->locations.bloom_strength, strength);
    glUniform1f(stage->locations.bloom_scale, inputs->bloom_scale);
    glUniform1i(stage->locations.scene_alone, inputs->particles == NULL);
    glUniform1i(stage->locations.separate_fire, inputs->fire != NULL);
    glUniform1f(stage->locations.exposure,
                exact_exp2(kiln_scene_value(scene, &post->exposure, inputs->time_s)));
    glUniform1i(stage->locations.tonemap, (GLint)post->tonemap);
    glUniform1f(stage->locations.levels, stage->bits == 16 ? 65535.0f : 255.0f);
    glUniform1i(stage->locations.dither, post->dither);
    glUniform1ui(stage->locations.frame, inputs->frame);
    glUniform1i(stage->locations.texture, stage->texture);

    glDisable(GL_BLEND);
    kiln_framebuffer_fill(stage->vertex_array);
    return kiln_device_check(stage->device, "composite", error);
}

bool kiln_composite_gl_read_display(struct kiln_composite_gl *stage, void *pixels,
                                    struct kiln_error *error)
{
    glBindFramebuffer(GL_FRAMEBUFFER, stage->framebuffer.gl);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, (GLsizei)stage->scene->width, (GLsizei)stage->scene->height, GL_RGBA,
                 stage->bits == 16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, pixels);
    stage->device->traffic.to_host +=
        (uint64_t)stage->scene->width * stage->scene->height * stage->bits / 2;
    return kiln_device_check(stage->device, "readback", error);
}

bool kiln_composite_gl_read_beauty(struct kiln_composite_gl *stage, float *pixels,
                                   struct kiln_error *error)
{
    const float *host = kiln_image_host(&stage->beauty, KILN_READ, error);
    if (!host)
        return false;
    memcpy(pixels, host, sizeof(float) * 4 * stage->scene->width * stage->scene->height);
    return true;
}
