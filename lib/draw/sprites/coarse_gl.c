/* This file converts between the frame and its coarse picture in GL: it measures depths and edges,
 * and enlarges the pictures, by full-screen passes. */
#include "draw/sprites/coarse_gl.h"

#include <stdlib.h>

#include "base/error.h"
#include "gpu/program.h"

enum program { DEPTH, EDGES, MASK, ENLARGE, PROGRAM_COUNT };

static const char *const FRAGMENTS[PROGRAM_COUNT] = {
    [DEPTH] = "draw/sprites/coarse_depth.frag",
    [EDGES] = "draw/sprites/coarse_edges.frag",
    [MASK] = "draw/sprites/coarse_mask.frag",
    [ENLARGE] = "draw/sprites/coarse_enlarge.frag",
};

struct kiln_coarse_gl {
    struct kiln_device *device;
    struct kiln_coarse_images *images;
    GLuint programs[PROGRAM_COUNT];
    GLint has_fine; /* uniform of ENLARGE */
    GLuint vertex_array;
    struct kiln_image
        nonplanar; /* 1 where depths in a coarse pixel do not lie on a plane; else 0 */
    struct kiln_framebuffer depth_target, edges_target, mask_target;
};

static bool create_programs(struct kiln_coarse_gl *coarse, struct kiln_error *error)
{
    const struct kiln_coarse_images *images = coarse->images;
    for (int i = 0; i < PROGRAM_COUNT; i++) {
        coarse->programs[i] =
            kiln_program_create(coarse->device,
                                &(struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert",
                                                              .fragment = FRAGMENTS[i]},
                                error);
        GLuint program = coarse->programs[i];
        if (!program)
            return false;
        glUseProgram(program);
        glUniform1f(glGetUniformLocation(program, "coarse_edge_px"), (float)images->factor);
        glUniform2f(glGetUniformLocation(program, "margin_px"), images->margin_x, images->margin_y);
    }
    coarse->has_fine = glGetUniformLocation(coarse->programs[ENLARGE], "has_fine");
    return true;
}

static bool create_targets(struct kiln_coarse_gl *coarse, struct kiln_error *error)
{
    struct kiln_coarse_images *images = coarse->images;
    kiln_image_init(&coarse->nonplanar, coarse->device, images->depth.width, images->depth.height,
                    GL_R32F, "bent depth");
    struct kiln_image *depth[] = {&images->depth, &coarse->nonplanar}, *edges[] = {&images->edges};
    if (!kiln_framebuffer_init(&coarse->depth_target, coarse->device, depth, 2, error) ||
        !kiln_framebuffer_init(&coarse->edges_target, coarse->device, edges, 1, error))
        return false;
    if (!images->mixed)
        return true;
    struct kiln_image *mask[] = {&images->fine_depth};
    return kiln_framebuffer_init(&coarse->mask_target, coarse->device, mask, 1, error);
}

struct kiln_coarse_gl *kiln_coarse_gl_create(struct kiln_device *device,
                                             struct kiln_coarse_images *images,
                                             struct kiln_error *error)
{
    struct kiln_coarse_gl *coarse = calloc(1, sizeof *coarse);
    if (!coarse) {
        kiln_error_no_memory(error, "coarse particles");
        return NULL;
    }
    *coarse = (struct kiln_coarse_gl){.device = device, .images = images};
    glGenVertexArrays(1, &coarse->vertex_array);
    if (!create_programs(coarse, error) || !create_targets(coarse, error))
        kiln_coarse_gl_destroy(&coarse);
    return coarse;
}

void kiln_coarse_gl_destroy(struct kiln_coarse_gl **coarse)
{
    struct kiln_coarse_gl *c = *coarse;
    if (!c)
        return;
    for (int i = 0; i < PROGRAM_COUNT; i++)
        glDeleteProgram(c->programs[i]); /* 0 is ignored */
    kiln_framebuffer_finish(&c->depth_target);
    kiln_framebuffer_finish(&c->edges_target);
    kiln_framebuffer_finish(&c->mask_target);
    kiln_image_finish(&c->nonplanar);
    glDeleteVertexArrays(1, &c->vertex_array);
    free(c);
    *coarse = NULL;
}

/* Runs a full-screen pass of a program into `target`. Binds images to texture units from 0 on. */
static bool run_pass(struct kiln_coarse_gl *coarse, enum program program,
                     struct kiln_framebuffer *target, struct kiln_image *const *images,
                     GLuint count, struct kiln_error *error)
{
    for (GLuint unit = 0; unit < count; unit++) {
        GLuint texture = kiln_image_gl(images[unit], KILN_READ, error);
        if (!texture)
            return false;
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture);
    }
    if (!kiln_framebuffer_bind(target, error))
        return false;
    glUseProgram(coarse->programs[program]);
    kiln_framebuffer_fill(coarse->vertex_array);
    return kiln_device_check(coarse->device, "coarse particles", error);
}

bool kiln_coarse_gl_measure(struct kiln_coarse_gl *coarse, struct kiln_image *depth,
                            struct kiln_error *error)
{
    struct kiln_coarse_images *images = coarse->images;
    struct kiln_image *nonplanar[] = {&coarse->nonplanar}, *mask[] = {depth, &images->edges};
    glDisable(GL_BLEND);
    return run_pass(coarse, DEPTH, &coarse->depth_target, &depth, 1, error) &&
           run_pass(coarse, EDGES, &coarse->edges_target, nonplanar, 1, error) &&
           (!images->mixed || run_pass(coarse, MASK, &coarse->mask_target, mask, 2, error));
}

bool kiln_coarse_gl_enlarge(struct kiln_coarse_gl *coarse, const struct kiln_coarse_blend *blend,
                            struct kiln_image *depth, struct kiln_error *error)
{
    struct kiln_coarse_images *images = coarse->images;
    struct kiln_image *from[] = {
        depth,          &images->depth,      &images->edges,     &images->color,
        &images->bloom, &images->fine_color, &images->fine_bloom};
    glUseProgram(coarse->programs[ENLARGE]);
    glUniform1i(coarse->has_fine, images->mixed);
    if (blend->keep_bloom) {
        glEnablei(GL_BLEND, 1);
        glBlendFunci(1, GL_ONE, blend->sum_alpha ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    }
    bool ok = run_pass(coarse, ENLARGE, blend->target, from, images->mixed ? 7 : 5, error);
    glDisable(GL_BLEND);
    return ok;
}
