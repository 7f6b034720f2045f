/* This file blurs the glow in GL by Gaussians. At each level of the plan (bloom_plan.h) it reduces
 * the picture, then blurs it horizontally and vertically. The Gaussian of the thesis has two
 * levels, a third and a sixth of the size (Heinz 2019, 3.2.5), and each reduction averages whole
 * blocks of pixels; the thesis samples bilinearly instead, which may miss a spark. The other
 * Gaussian has one level, which is reduced by tents. */
#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_blur.h"

struct level {
    struct kiln_bloom_target down, across; /* down: reduced, then blurred vertically; across:
                                            * blurred horizontally */
};

struct kiln_bloom_gaussian {
    const struct kiln_bloom_plan *plan;
    GLuint reduce, blur;
    GLint ratio, direction;
    struct level levels[KILN_BLOOM_MAX_LEVELS];
};

static bool init_levels(struct kiln_bloom_gaussian *gaussian, struct kiln_device *device,
                        GLenum format, struct kiln_error *error)
{
    for (uint32_t i = 0; i < gaussian->plan->level_count; i++) {
        const struct kiln_bloom_level *size = &gaussian->plan->levels[i];
        struct level *level = &gaussian->levels[i];
        if (!kiln_bloom_target_init(&level->down, device, size->width, size->height, format,
                                    error) ||
            !kiln_bloom_target_init(&level->across, device, size->width, size->height, format,
                                    error))
            return false;
    }
    return true;
}

struct kiln_bloom_gaussian *kiln_bloom_gaussian_create(struct kiln_device *device,
                                                       const struct kiln_bloom_plan *plan,
                                                       GLenum format, struct kiln_error *error)
{
    struct kiln_bloom_gaussian *gaussian = calloc(1, sizeof *gaussian);
    if (!gaussian) {
        kiln_error_no_memory(error, "the bloom");
        return NULL;
    }
    gaussian->plan = plan;
    gaussian->reduce = kiln_bloom_program(
        device,
        plan->kind == KILN_BLOOM_THESIS ? "post/bloom_shrink.frag" : "post/bloom_reduce.frag",
        error);
    if (gaussian->reduce)
        gaussian->blur = kiln_bloom_program(device, "post/bloom_blur.frag", error);
    if (!gaussian->blur || !init_levels(gaussian, device, format, error)) {
        kiln_bloom_gaussian_destroy(&gaussian);
        return NULL;
    }
    glUseProgram(gaussian->blur);
    glUniform1i(glGetUniformLocation(gaussian->blur, "taps"), (GLint)plan->taps);
    glUniform1fv(glGetUniformLocation(gaussian->blur, "weights"), (GLsizei)plan->taps,
                 plan->weights);
    gaussian->ratio = glGetUniformLocation(gaussian->reduce, "ratio");
    gaussian->direction = glGetUniformLocation(gaussian->blur, "direction");
    return gaussian;
}

void kiln_bloom_gaussian_destroy(struct kiln_bloom_gaussian **gaussian)
{
    if (!*gaussian)
        return;
    for (uint32_t i = 0; i < KILN_BLOOM_MAX_LEVELS; i++) {
        kiln_bloom_target_finish(&(*gaussian)->levels[i].down);
        kiln_bloom_target_finish(&(*gaussian)->levels[i].across);
    }
    glDeleteProgram((*gaussian)->reduce); /* GL ignores 0 */
    glDeleteProgram((*gaussian)->blur);
    free(*gaussian);
    *gaussian = NULL;
}

static bool blur_level(struct kiln_bloom_gaussian *gaussian, struct kiln_image *source,
                       uint32_t index, GLuint vertex_array, struct kiln_error *error)
{
    struct level *level = &gaussian->levels[index];
    glUseProgram(gaussian->reduce);
    glUniform1f(gaussian->ratio, gaussian->plan->levels[index].ratio);
    if (!kiln_bloom_pass(&level->down.framebuffer, source, NULL, vertex_array, error))
        return false;
    glUseProgram(gaussian->blur);
    glUniform2i(gaussian->direction, 1, 0);
    if (!kiln_bloom_pass(&level->across.framebuffer, &level->down.image, NULL, vertex_array, error))
        return false;
    glUniform2i(gaussian->direction, 0, 1);
    return kiln_bloom_pass(&level->down.framebuffer, &level->across.image, NULL, vertex_array,
                           error);
}

struct kiln_image *kiln_bloom_gaussian_run(struct kiln_bloom_gaussian *gaussian,
                                           struct kiln_image *source, GLuint vertex_array,
                                           struct kiln_error *error)
{
    struct kiln_image *blurred = source;
    for (uint32_t i = 0; i < gaussian->plan->level_count; i++) {
        if (!blur_level(gaussian, blurred, i, vertex_array, error))
            return NULL;
        blurred = &gaussian->levels[i].down.image;
    }
    return blurred;
}
