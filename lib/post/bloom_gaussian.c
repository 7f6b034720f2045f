/* This file blurs the glow in GL for bloom_gl.c, as the thesis of Heinz (2019, 3.2.5) does. The
 * glow is shrunk to a third of its width and height and blurred by a Gaussian, horizontally and
 * then vertically. The result is shrunk to a sixth and blurred again, and that is what the caller
 * gets. bloom_cpu.c does the same on the host. Each reduction averages whole blocks of pixels; the
 * thesis samples bilinearly instead, which may miss a spark. */
#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_blur.h"
#include "post/bloom_kernels.h"

struct level {
    struct kiln_bloom_target result;  /* first the shrunk image, in the end the blurred one */
    struct kiln_bloom_target between; /* the shrunk image, blurred horizontally */
};

struct kiln_bloom_gaussian {
    GLuint shrink, blur;
    GLint factor_location, direction_location; /* of uniforms */
    struct level third_size, sixth_size;
};

static bool init_level(struct kiln_device *device, struct level *level, uint32_t width,
                       uint32_t height, GLenum format, struct kiln_error *error)
{
    return kiln_bloom_target_init(&level->result, device, width, height, format, error) &&
           kiln_bloom_target_init(&level->between, device, width, height, format, error);
}

static void finish_level(struct level *level)
{
    kiln_bloom_target_finish(&level->result);
    kiln_bloom_target_finish(&level->between);
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
        !init_level(device, &gaussian->third_size, (width + 2) / 3, (height + 2) / 3, format,
                    error) ||
        !init_level(device, &gaussian->sixth_size, (width + 5) / 6, (height + 5) / 6, format,
                    error)) {
        kiln_bloom_gaussian_destroy(&gaussian);
        return NULL;
    }
    set_weights(gaussian->blur);
    gaussian->factor_location = glGetUniformLocation(gaussian->shrink, "factor");
    gaussian->direction_location = glGetUniformLocation(gaussian->blur, "direction");
    return gaussian;
}

void kiln_bloom_gaussian_destroy(struct kiln_bloom_gaussian **gaussian)
{
    if (!*gaussian)
        return;
    finish_level(&(*gaussian)->third_size);
    finish_level(&(*gaussian)->sixth_size);
    glDeleteProgram((*gaussian)->shrink); /* GL ignores 0 */
    glDeleteProgram((*gaussian)->blur);
    free(*gaussian);
    *gaussian = NULL;
}

static bool blur_level(struct kiln_bloom_gaussian *gaussian, struct kiln_image *source, int factor,
                       struct level *level, GLuint vertex_array, struct kiln_error *error)
{
    glUseProgram(gaussian->shrink);
    glUniform1i(gaussian->factor_location, factor);
    if (!kiln_bloom_pass(&level->result.framebuffer, source, NULL, vertex_array, error))
        return false;
    glUseProgram(gaussian->blur);
    glUniform2i(gaussian->direction_location, 1, 0);
    if (!kiln_bloom_pass(&level->between.framebuffer, &level->result.image, NULL, vertex_array,
                         error))
        return false;
    glUniform2i(gaussian->direction_location, 0, 1);
    return kiln_bloom_pass(&level->result.framebuffer, &level->between.image, NULL, vertex_array,
                           error);
}

struct kiln_image *kiln_bloom_gaussian_run(struct kiln_bloom_gaussian *gaussian,
                                           struct kiln_image *source, GLuint vertex_array,
                                           struct kiln_error *error)
{
    if (!blur_level(gaussian, source, 3, &gaussian->third_size, vertex_array, error) ||
        !blur_level(gaussian, &gaussian->third_size.result.image, 2, &gaussian->sixth_size,
                    vertex_array, error))
        return NULL;
    return &gaussian->sixth_size.result.image;
}
