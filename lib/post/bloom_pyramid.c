/* This file blurs the glow in GL by a pyramid: it reduces the picture to the first level of the
 * plan (bloom_plan.h), halves it level by level, then joins the levels from the smallest up. Each
 * level is mixed with the next smaller level, enlarged to twice its size, so that the glow has a
 * bright core and a wide, faint skirt. */
#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_blur.h"

struct kiln_bloom_pyramid {
    const struct kiln_bloom_plan *plan;
    GLuint reduce, halve, join;
    GLint ratio, radius;
    struct kiln_bloom_target
        down[KILN_BLOOM_MAX_LEVELS];                    /* the reduced picture, a half of it, ... */
    struct kiln_bloom_target up[KILN_BLOOM_MAX_LEVELS]; /* joined pictures of all but the last
                                                         * level */
};

static bool init_targets(struct kiln_bloom_pyramid *pyramid, struct kiln_device *device,
                         GLenum format, struct kiln_error *error)
{
    for (uint32_t i = 0; i < pyramid->plan->level_count; i++) {
        const struct kiln_bloom_level *size = &pyramid->plan->levels[i];
        if (!kiln_bloom_target_init(&pyramid->down[i], device, size->width, size->height, format,
                                    error) ||
            !kiln_bloom_target_init(&pyramid->up[i], device, size->width, size->height, format,
                                    error))
            return false;
    }
    return true;
}

struct kiln_bloom_pyramid *kiln_bloom_pyramid_create(struct kiln_device *device,
                                                     const struct kiln_bloom_plan *plan,
                                                     GLenum format, struct kiln_error *error)
{
    struct kiln_bloom_pyramid *pyramid = calloc(1, sizeof *pyramid);
    if (!pyramid) {
        kiln_error_no_memory(error, "the bloom");
        return NULL;
    }
    pyramid->plan = plan;
    pyramid->reduce = kiln_bloom_program(device, "post/bloom_reduce.frag", error);
    if (pyramid->reduce)
        pyramid->halve = kiln_bloom_program(device, "post/bloom_down.frag", error);
    if (pyramid->halve)
        pyramid->join = kiln_bloom_program(device, "post/bloom_up.frag", error);
    if (!pyramid->join || !init_targets(pyramid, device, format, error)) {
        kiln_bloom_pyramid_destroy(&pyramid);
        return NULL;
    }
    pyramid->ratio = glGetUniformLocation(pyramid->reduce, "ratio");
    pyramid->radius = glGetUniformLocation(pyramid->join, "radius");
    return pyramid;
}

void kiln_bloom_pyramid_destroy(struct kiln_bloom_pyramid **pyramid)
{
    if (!*pyramid)
        return;
    for (uint32_t i = 0; i < KILN_BLOOM_MAX_LEVELS; i++) {
        kiln_bloom_target_finish(&(*pyramid)->down[i]);
        kiln_bloom_target_finish(&(*pyramid)->up[i]);
    }
    glDeleteProgram((*pyramid)->reduce); /* GL ignores 0 */
    glDeleteProgram((*pyramid)->halve);
    glDeleteProgram((*pyramid)->join);
    free(*pyramid);
    *pyramid = NULL;
}

struct kiln_image *kiln_bloom_pyramid_run(struct kiln_bloom_pyramid *pyramid,
                                          struct kiln_image *source, float radius,
                                          GLuint vertex_array, struct kiln_error *error)
{
    const uint32_t levels = pyramid->plan->level_count;
    struct kiln_image *above = source;
    for (uint32_t i = 0; i < levels; i++) {
        glUseProgram(i == 0 ? pyramid->reduce : pyramid->halve);
        if (i == 0)
            glUniform1f(pyramid->ratio, pyramid->plan->levels[0].ratio);
        if (!kiln_bloom_pass(&pyramid->down[i].framebuffer, above, NULL, vertex_array, error))
            return NULL;
        above = &pyramid->down[i].image;
    }
    glUseProgram(pyramid->join);
    struct kiln_image *below = above;
    for (uint32_t i = levels - 1; i-- > 0;) {
        glUniform1f(pyramid->radius, kiln_bloom_plan_radius(pyramid->plan, i, radius));
        if (!kiln_bloom_pass(&pyramid->up[i].framebuffer, &pyramid->down[i].image, below,
                             vertex_array, error))
            return NULL;
        below = &pyramid->up[i].image;
    }
    return below;
}
