/* This file runs the bloom in GL: the bright pass if the scene has one, then the Gaussian or the
 * pyramid over the source. It also holds the GL functions that the Gaussian and the pyramid
 * share. */
#include "post/bloom_gl.h"

#include <stdlib.h>

#include "base/error.h"
#include "gpu/program.h"
#include "post/bloom_blur.h"
#include "shared/exact.h"

struct kiln_bloom_gl {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    struct kiln_image *source;
    struct kiln_bloom_plan plan;
    struct kiln_bloom_gaussian *gaussian; /* exactly one of the two is not NULL */
    struct kiln_bloom_pyramid *pyramid;
    GLuint bright; /* program of the bright pass; 0 if the source is drawn with the particles */
    GLint exposure, threshold, separate_fire, scene_alone;
    struct kiln_framebuffer source_framebuffer; /* of the bright pass */
    GLuint vertex_array;
};

/* ---- shared by the Gaussian and the pyramid -------------------------------------------------- */

bool kiln_bloom_target_init(struct kiln_bloom_target *target, struct kiln_device *device,
                            uint32_t width, uint32_t height, GLenum format,
                            struct kiln_error *error)
{
    kiln_image_init(&target->image, device, width, height, format, "bloom");
    struct kiln_image *image = &target->image;
    return kiln_framebuffer_init(&target->framebuffer, device, &image, 1, error);
}

void kiln_bloom_target_finish(struct kiln_bloom_target *target)
{
    kiln_framebuffer_finish(&target->framebuffer);
    kiln_image_finish(&target->image);
}

static bool bind_image(GLuint unit, struct kiln_image *image, struct kiln_error *error)
{
    GLuint texture = image ? kiln_image_gl(image, KILN_READ, error) : 0;
    if (image && !texture)
        return false;
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    return true;
}

bool kiln_bloom_pass(struct kiln_framebuffer *target, struct kiln_image *first,
                     struct kiln_image *second, GLuint vertex_array, struct kiln_error *error)
{
    if (!bind_image(0, first, error) || !bind_image(1, second, error) ||
        !kiln_framebuffer_bind(target, error))
        return false;
    kiln_framebuffer_fill(vertex_array);
    return true;
}

GLuint kiln_bloom_program(struct kiln_device *device, const char *fragment,
                          struct kiln_error *error)
{
    return kiln_program_create(
        device,
        &(struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert", .fragment = fragment},
        error);
}

/* ---- the stage ------------------------------------------------------------------------------- */

static bool init_bright(struct kiln_bloom_gl *stage, struct kiln_error *error)
{
    stage->bright = kiln_bloom_program(stage->device, "post/bloom_bright.frag", error);
    if (!stage->bright)
        return false;
    stage->exposure = glGetUniformLocation(stage->bright, "exposure");
    stage->threshold = glGetUniformLocation(stage->bright, "threshold");
    stage->scene_alone = glGetUniformLocation(stage->bright, "scene_alone");
    stage->separate_fire = glGetUniformLocation(stage->bright, "separate_fire");
    return kiln_framebuffer_init(&stage->source_framebuffer, stage->device, &stage->source, 1,
                                 error);
}

static bool init_blur(struct kiln_bloom_gl *stage, GLenum format, struct kiln_error *error)
{
    const struct kiln_bloom_plan *plan = &stage->plan;
    kiln_bloom_plan_init(&stage->plan, stage->scene, stage->source->width, stage->source->height);
    if (plan->kind == KILN_BLOOM_PYRAMID)
        stage->pyramid = kiln_bloom_pyramid_create(stage->device, plan, format, error);
    else
        stage->gaussian = kiln_bloom_gaussian_create(stage->device, plan, format, error);
    return stage->pyramid || stage->gaussian;
}

struct kiln_bloom_gl *kiln_bloom_gl_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_bloom_params *params,
                                           struct kiln_error *error)
{
    struct kiln_bloom_gl *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the bloom");
        return NULL;
    }
    *stage = (struct kiln_bloom_gl){.device = device, .scene = scene, .source = params->source};
    bool bright = scene->post.bloom_source == KILN_BLOOM_BRIGHT;
    if (!init_blur(stage, params->format, error) || (bright && !init_bright(stage, error))) {
        kiln_bloom_gl_destroy(&stage);
        return NULL;
    }
    glGenVertexArrays(1, &stage->vertex_array);
    return stage;
}

void kiln_bloom_gl_destroy(struct kiln_bloom_gl **stage)
{
    struct kiln_bloom_gl *s = *stage;
    if (!s)
        return;
    kiln_bloom_gaussian_destroy(&s->gaussian);
    kiln_bloom_pyramid_destroy(&s->pyramid);
    kiln_framebuffer_finish(&s->source_framebuffer);
    glDeleteProgram(s->bright); /* GL ignores 0 */
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *stage = NULL;
}

static bool pass_bright(struct kiln_bloom_gl *stage, const struct kiln_bloom_inputs *inputs,
                        struct kiln_error *error)
{
    const struct kiln_post *post = &stage->scene->post;
    float exposure = kiln_scene_value(stage->scene, &post->exposure, inputs->time_s);
    float threshold = kiln_scene_value(stage->scene, &post->bloom_threshold, inputs->time_s);
    glUseProgram(stage->bright);
    glUniform1f(stage->exposure, exact_exp2(exposure));
    glUniform1f(stage->threshold, threshold);
    glUniform1i(stage->scene_alone, inputs->particles == NULL);
    glUniform1i(stage->separate_fire, inputs->fire != NULL);
    return bind_image(2, inputs->fire, error) &&
           kiln_bloom_pass(&stage->source_framebuffer, inputs->scene, inputs->particles,
                           stage->vertex_array, error);
}

struct kiln_image *kiln_bloom_gl_run(struct kiln_bloom_gl *stage,
                                     const struct kiln_bloom_inputs *inputs, float *scale,
                                     struct kiln_error *error)
{
    const struct kiln_post *post = &stage->scene->post;
    glDisable(GL_BLEND);
    if (stage->bright && !pass_bright(stage, inputs, error))
        return NULL;
    struct kiln_image *result;
    *scale = stage->plan.scale;
    if (stage->pyramid) {
        float radius = kiln_scene_value(stage->scene, &post->bloom_radius, inputs->time_s);
        result = kiln_bloom_pyramid_run(stage->pyramid, stage->source, radius, stage->vertex_array,
                                        error);
    } else {
        result =
            kiln_bloom_gaussian_run(stage->gaussian, stage->source, stage->vertex_array, error);
    }
    return result && kiln_device_check(stage->device, "bloom", error) ? result : NULL;
}
