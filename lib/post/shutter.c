/* Additive blending into float targets. */
#include "post/shutter.h"

#include "base/error.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"

#include <stdlib.h>

struct sum {
    struct kiln_image image;
    struct kiln_framebuffer framebuffer;
};

struct kiln_shutter_stage {
    struct kiln_device *device;
    GLuint compose, add, vertex_array;
    GLint compose_weight, separate_fire, add_weight;
    struct sum sums[KILN_SHUTTER_SUM_COUNT];
};

static GLuint make_program(struct kiln_device *device, const char *fragment,
                           struct kiln_error *error)
{
    return kiln_program_create(
        device,
        &(struct kiln_program_params){.vertex = "draw/fullscreen.vert", .fragment = fragment},
        error);
}

static bool init_sums(struct kiln_shutter_stage *stage, uint32_t width, uint32_t height,
                      struct kiln_error *error)
{
    for (int i = 0; i < KILN_SHUTTER_SUM_COUNT; i++) {
        struct kiln_image *image = &stage->sums[i].image;
        kiln_image_init(image, stage->device, width, height, GL_RGBA32F, "shutter");
        if (!kiln_framebuffer_init(&stage->sums[i].framebuffer, stage->device, &image, 1, error))
            return false;
    }
    return true;
}

struct kiln_shutter_stage *kiln_shutter_create(struct kiln_device *device, uint32_t width,
                                               uint32_t height, struct kiln_error *error)
{
    struct kiln_shutter_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "shutter: out of memory");
        return NULL;
    }
    stage->device = device;
    stage->compose = make_program(device, "post/shutter_compose.frag", error);
    if (stage->compose)
        stage->add = make_program(device, "post/shutter_add.frag", error);
    if (!stage->add || !init_sums(stage, width, height, error)) {
        kiln_shutter_destroy(&stage);
        return NULL;
    }
    stage->compose_weight = glGetUniformLocation(stage->compose, "weight");
    stage->separate_fire = glGetUniformLocation(stage->compose, "separate_fire");
    stage->add_weight = glGetUniformLocation(stage->add, "weight");
    glGenVertexArrays(1, &stage->vertex_array);
    return stage;
}

void kiln_shutter_destroy(struct kiln_shutter_stage **stage)
{
    struct kiln_shutter_stage *s = *stage;
    if (!s)
        return;
    for (int i = 0; i < KILN_SHUTTER_SUM_COUNT; i++) {
        kiln_framebuffer_finish(&s->sums[i].framebuffer);
        kiln_image_finish(&s->sums[i].image);
    }
    glDeleteProgram(s->compose); /* 0 is ignored */
    glDeleteProgram(s->add);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *stage = NULL;
}

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

/* With the program in use and its images bound. */
static bool add_pass(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum, bool first,
                     struct kiln_error *error)
{
    if (!kiln_framebuffer_bind(&stage->sums[sum].framebuffer, error))
        return false;
    if (!first) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
    }
    kiln_framebuffer_fill(stage->vertex_array);
    glDisable(GL_BLEND);
    return kiln_device_check(stage->device, "shutter", error);
}

bool kiln_shutter_add_composed(struct kiln_shutter_stage *stage,
                               const struct kiln_composite_inputs *inputs, float weight, bool first,
                               struct kiln_error *error)
{
    struct kiln_image *const images[] = {inputs->scene, inputs->particles, inputs->fire};
    glUseProgram(stage->compose);
    glUniform1f(stage->compose_weight, weight);
    glUniform1i(stage->separate_fire, inputs->fire != NULL);
    return bind_images(images, 3, error) && add_pass(stage, KILN_SHUTTER_COMPOSED, first, error);
}

bool kiln_shutter_add(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum,
                      struct kiln_image *image, float weight, bool first, struct kiln_error *error)
{
    glUseProgram(stage->add);
    glUniform1f(stage->add_weight, weight);
    return bind_images(&image, 1, error) && add_pass(stage, sum, first, error);
}

struct kiln_image *kiln_shutter_image(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum)
{
    return &stage->sums[sum].image;
}
