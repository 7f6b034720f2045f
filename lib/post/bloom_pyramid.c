/* This file blurs the glow in GL by a pyramid: it halves the picture level by level, then joins the
 * levels from the smallest up. Each level is mixed with the next smaller level, enlarged to twice
 * its size, so that the glow has a bright core and a wide, faint skirt. Larger pictures get more
 * levels, so the glow covers the same part of a picture of any size. */
#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_blur.h"
#include "post/bloom_kernels.h"

struct kiln_bloom_pyramid {
    GLuint halve, join;
    GLint radius;
    uint32_t levels;
    struct kiln_bloom_target down[KILN_BLOOM_MAX_LEVELS]; /* a half, a quarter, ... */
    struct kiln_bloom_target up[KILN_BLOOM_MAX_LEVELS];   /* joined pictures of all but the last
                                                           * level */
};

static bool init_targets(struct kiln_bloom_pyramid *pyramid, struct kiln_device *device,
                         uint32_t width, uint32_t height, GLenum format, struct kiln_error *error)
{
    do {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        uint32_t i = pyramid->levels++;
        if (!kiln_bloom_target_init(&pyramid->down[i], device, width, height, format, error) ||
            !kiln_bloom_target_init(&pyramid->up[i], device, width, height, format, error))
            return false;
    } while (pyramid->levels < KILN_BLOOM_MAX_LEVELS && width >= 2 * KILN_BLOOM_LEAST_EDGE &&
             height >= 2 * KILN_BLOOM_LEAST_EDGE);
    return true;
}

struct kiln_bloom_pyramid *kiln_bloom_pyramid_create(struct kiln_device *device, uint32_t width,
                                                     uint32_t height, GLenum format,
                                                     struct kiln_error *error)
{
    struct kiln_bloom_pyramid *pyramid = calloc(1, sizeof *pyramid);
    if (!pyramid) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "bloom: out of memory");
        return NULL;
    }
    pyramid->halve = kiln_bloom_program(device, "post/bloom_down.frag", error);
    if (pyramid->halve)
        pyramid->join = kiln_bloom_program(device, "post/bloom_up.frag", error);
    if (!pyramid->join || !init_targets(pyramid, device, width, height, format, error)) {
        kiln_bloom_pyramid_destroy(&pyramid);
        return NULL;
    }
    pyramid->radius = glGetUniformLocation(pyramid->join, "radius");
    return pyramid;
}

void kiln_bloom_pyramid_destroy(struct kiln_bloom_pyramid **pyramid)
{
    if (!*pyramid)
        return;
    for (uint32_t i = 0; i < (*pyramid)->levels; i++) {
        kiln_bloom_target_finish(&(*pyramid)->down[i]);
        kiln_bloom_target_finish(&(*pyramid)->up[i]);
    }
    glDeleteProgram((*pyramid)->halve); /* GL ignores 0 */
    glDeleteProgram((*pyramid)->join);
    free(*pyramid);
    *pyramid = NULL;
}

struct kiln_image *kiln_bloom_pyramid_run(struct kiln_bloom_pyramid *pyramid,
                                          struct kiln_image *source, float radius,
                                          GLuint vertex_array, struct kiln_error *error)
{
    glUseProgram(pyramid->halve);
    struct kiln_image *above = source;
    for (uint32_t i = 0; i < pyramid->levels; i++) {
        if (!kiln_bloom_pass(&pyramid->down[i].framebuffer, above, NULL, vertex_array, error))
            return NULL;
        above = &pyramid->down[i].image;
    }
    glUseProgram(pyramid->join);
    glUniform1f(pyramid->radius, radius);
    struct kiln_image *below = above;
    for (uint32_t i = pyramid->levels - 1; i-- > 0;) {
        if (!kiln_bloom_pass(&pyramid->up[i].framebuffer, &pyramid->down[i].image, below,
                             vertex_array, error))
            return NULL;
        below = &pyramid->up[i].image;
    }
    return below;
}
