/* This file draws particles at half or a quarter of the frame's resolution with any rasteriser. It
 * draws each pass small, against a small depth of the scene, then enlarges the result to the frame.
 * With mixed resolution it also draws the pass at full resolution, against a depth of the scene
 * that is 0 away from edges, so that rasterisers skip particles there as hidden. */
#include "draw/sprites/coarse.h"

#include <stdlib.h>

#include "base/error.h"
#include "draw/sprites/coarse_cpu.h"
#include "draw/sprites/coarse_gl.h"

struct kiln_coarse_stage {
    struct kiln_device *device;
    struct kiln_particles_stage *particles;
    struct kiln_coarse_images images;
    struct kiln_coarse_cpu *cpu; /* exactly one of cpu and gl is not NULL */
    struct kiln_coarse_gl *gl;
};

/* Returns the pixels of a frame along the edge of a pixel of the coarse picture. */
static uint32_t factor_of(const struct kiln_scene *scene)
{
    return scene->post.resolution == KILN_RESOLUTION_HALF ? 2 : 4;
}

static bool init_images(struct kiln_coarse_stage *stage, const struct kiln_scene *scene,
                        GLenum format, struct kiln_error *error)
{
    struct kiln_coarse_images *images = &stage->images;
    const uint32_t factor = factor_of(scene);
    const uint32_t width = (scene->width + factor - 1) / factor;
    const uint32_t height = (scene->height + factor - 1) / factor;
    images->factor = factor;
    images->width = scene->width;
    images->height = scene->height;
    images->margin_x = 0.5f * (float)(width * factor - scene->width);
    images->margin_y = 0.5f * (float)(height * factor - scene->height);
    images->mixed = scene->post.mixed_resolution;
    kiln_image_init(&images->depth, stage->device, width, height, GL_R32F, "coarse depth");
    kiln_image_init(&images->edges, stage->device, width, height, GL_R32F, "coarse edges");
    kiln_image_init(&images->color, stage->device, width, height, format, "coarse particles");
    kiln_image_init(&images->bloom, stage->device, width, height, format, "coarse bloom");
    struct kiln_image *coarse[] = {&images->color, &images->bloom};
    if (!kiln_framebuffer_init(&images->framebuffer, stage->device, coarse, 2, error))
        return false;
    if (!images->mixed)
        return true;
    const uint32_t w = scene->width, h = scene->height;
    kiln_image_init(&images->fine_depth, stage->device, w, h, GL_R32F, "depth at edges");
    kiln_image_init(&images->fine_color, stage->device, w, h, format, "particles at edges");
    kiln_image_init(&images->fine_bloom, stage->device, w, h, format, "bloom at edges");
    struct kiln_image *fine[] = {&images->fine_color, &images->fine_bloom};
    return kiln_framebuffer_init(&images->fine_framebuffer, stage->device, fine, 2, error);
}

struct kiln_coarse_stage *kiln_coarse_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_coarse_params *params,
                                             struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_coarse_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "coarse particles");
        return NULL;
    }
    stage->device = device;
    stage->particles = params->particles;
    bool ok = init_images(stage, scene, params->format, error);
    if (ok && params->in_gl)
        stage->gl = kiln_coarse_gl_create(device, &stage->images, error);
    else if (ok)
        stage->cpu = kiln_coarse_cpu_create(&stage->images, threads, error);
    if (!stage->gl && !stage->cpu)
        kiln_coarse_destroy(&stage);
    return stage;
}

void kiln_coarse_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    if (scene->post.resolution == KILN_RESOLUTION_FULL)
        return;
    const uint32_t factor = factor_of(scene);
    const uint64_t width = (scene->width + factor - 1) / factor;
    const uint64_t coarse = width * ((scene->height + factor - 1) / factor);
    const uint64_t fine = scene->post.mixed_resolution ? (uint64_t)scene->width * scene->height : 0;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, coarse, (4 + 4 + 1 + 1) * sizeof(float));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, coarse, sizeof(uint32_t)); /* nonplanar */
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, fine, (4 + 4 + 1) * sizeof(float));
}

void kiln_coarse_destroy(struct kiln_coarse_stage **stage)
{
    struct kiln_coarse_stage *s = *stage;
    if (!s)
        return;
    kiln_coarse_gl_destroy(&s->gl);
    kiln_coarse_cpu_destroy(&s->cpu);
    kiln_framebuffer_finish(&s->images.framebuffer);
    kiln_framebuffer_finish(&s->images.fine_framebuffer);
    struct kiln_image *images[] = {
        &s->images.depth,      &s->images.edges,      &s->images.color,     &s->images.bloom,
        &s->images.fine_depth, &s->images.fine_color, &s->images.fine_bloom};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        kiln_image_finish(images[i]);
    free(s);
    *stage = NULL;
}

bool kiln_coarse_prepare(struct kiln_coarse_stage *stage, struct kiln_image *depth,
                         struct kiln_error *error)
{
    return stage->gl ? kiln_coarse_gl_measure(stage->gl, depth, error)
                     : kiln_coarse_cpu_measure(stage->cpu, depth, error);
}

static bool draw_coarse(struct kiln_coarse_stage *stage, const struct kiln_particles_draw *draw,
                        struct kiln_error *error)
{
    const struct kiln_view view = kiln_view_coarse(draw->view, stage->images.factor);
    struct kiln_particles_draw coarse = *draw;
    coarse.view = &view;
    coarse.depth = &stage->images.depth;
    coarse.framebuffer = &stage->images.framebuffer;
    coarse.keep_bloom = false;
    struct kiln_tile_gas gas;
    if (draw->gas) {
        gas = *draw->gas;
        gas.scale = (float)stage->images.factor;
        gas.margin_x = stage->images.margin_x;
        gas.margin_y = stage->images.margin_y;
        coarse.gas = &gas;
    }
    return kiln_particles_run(stage->particles, &coarse, error);
}

static bool draw_fine(struct kiln_coarse_stage *stage, const struct kiln_particles_draw *draw,
                      struct kiln_error *error)
{
    struct kiln_particles_draw fine = *draw;
    fine.depth = &stage->images.fine_depth;
    fine.framebuffer = &stage->images.fine_framebuffer;
    fine.keep_bloom = false;
    return kiln_particles_run(stage->particles, &fine, error);
}

bool kiln_coarse_run(struct kiln_coarse_stage *stage, const struct kiln_particles_draw *draw,
                     struct kiln_error *error)
{
    const struct kiln_coarse_blend blend = {
        .target = draw->framebuffer, .keep_bloom = draw->keep_bloom, .sum_alpha = draw->sum_alpha};
    return draw_coarse(stage, draw, error) &&
           (!stage->images.mixed || draw_fine(stage, draw, error)) &&
           (stage->gl ? kiln_coarse_gl_enlarge(stage->gl, &blend, draw->depth, error)
                      : kiln_coarse_cpu_enlarge(stage->cpu, &blend, draw->depth, error));
}
