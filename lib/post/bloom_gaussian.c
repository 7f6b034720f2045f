/* This file blurs the glow in GL by four Gaussian blurs: horizontal and vertical at a third of the
 * size, then at a sixth (Heinz 2019, 3.2.5). Each reduction averages whole blocks of pixels. The
 * thesis samples bilinearly instead, which may miss a spark. */
#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_blur.h"
#include "post/bloom_kernels.h"

struct level {
    struct kiln_bloom_target down, across; /* down: shrunk, then blurred vertically; across: blurred
                                            * horizontally */
};

struct kiln_bloom_gaussian {
    GLuint shrink, blur;
    GLint factor, direction;
    struct level third, sixth;
};

static bool init_level(struct kiln_device *device, struct level *level, uint32_t width,
                       uint32_t height, GLenum format, struct kiln_error *error)
{
    return kiln_bloom_target_init(&level->down, device, width, height, format, error) &&
           kiln_bloom_target_init(&level->across, device, width, height, format, error);
}

static void finish_level(struct level *level)
{
    kiln_bloom_target_finish(&level->down);
    kiln_bloom_target_finish(&level->across);
}

static void set_weights(GLuint program)
{
    float weights[KILN_BLOOM_TAPS];
    kiln_bloom_gaussian_weights(weights);
    glUseProgram(program);
    glUniform1fv(glGetUniformLocation(program, "weights"), KILN_BLOOM_TAPS, weights);
}

struct kiln_bloom_gaussian *kiln_bloom_gaussian_create(struct kiln_device *device, uint32_t width,
                                                       uint32_t height, GLenum format,
                                                       struct kiln_error *error)
{
    struct kiln_bloom_gaussian *gaussian = calloc(1, sizeof *gaussian);
    if (!gaussian) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "bloom: out of memory");
        return NULL;
    }
    gaussian->shrink = kiln_bloom_program(device, "post/bloom_shrink.frag", error);
    if (gaussian->shrink)
        gaussian->blur = kiln_bloom_program(device, "post/bloom_blur.frag", error);
    if (!gaussian->blur ||
        !init_level(device, &gaussian->third, (width + 2) / 3, (height + 2) / 3, format, error) ||
        !init_level(device, &gaussian->sixth, (width + 5) / 6, (height + 5) / 6, format, error)) {
        kiln_bloom_gaussian_destroy(&gaussian);
        return NULL;
    }
    set_weights(gaussian->blur);
    gaussian->factor = glGetUniformLocation(gaussian->shrink, "factor");
    gaussian->direction = glGetUniformLocation(gaussian->blur, "direction");
    return gaussian;
}

void kiln_bloom_gaussian_destroy(struct kiln_bloom_gaussian **gaussian)
{
    if (!*gaussian)
        return;
    finish_level(&(*gaussian)->third);
    finish_level(&(*gaussian)->sixth);
    glDeleteProgram((*gaussian)->shrink); /* GL ignores 0 */
    glDeleteProgram((*gaussian)->blur);
    free(*gaussian);
    *gaussian = NULL;
}

static bool blur_level(struct kiln_bloom_gaussian *gaussian, struct kiln_image *source, int factor,
                       struct level *level, GLuint vertex_array, struct kiln_error *error)
{
    glUseProgram(gaussian->shrink);
    glUniform1i(gaussian->factor, factor);
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
    if (!blur_level(gaussian, source, 3, &gaussian->third, vertex_array, error) ||
        !blur_level(gaussian, &gaussian->third.down.image, 2, &gaussian->sixth, vertex_array,
                    error))
        return NULL;
    return &gaussian->sixth.down.image;
}
