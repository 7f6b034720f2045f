/* This file runs the passes of the blooms on the host: the bright pass, the Gaussian and the
 * pyramid. Each pass is a loop over rows (bloom_rows.h), divided among threads. */
#include "post/bloom_cpu.h"

#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_rows.h"

enum { ROWS_AT_A_TIME = 4 };

struct kiln_bloom_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_image *source;
    struct kiln_image small[2 * KILN_BLOOM_MAX_LEVELS];
    uint32_t levels; /* of the pyramid; `small` holds the halved pictures, then the joined
                      * pictures */
    const struct kiln_bloom_rows *rows;
    struct kiln_bloom_pass pass; /* parameters; each pass sets those that it needs */
};

/* ---- create, destroy ------------------------------------------------------------------------- */

/* Initialises the images of the Gaussian: two of a third of the source's size and two of a
 * sixth. */
static void init_gaussian(struct kiln_bloom_cpu *stage, struct kiln_device *device, GLenum format)
{
    kiln_bloom_gaussian_weights(stage->pass.weights);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t factor = i < 2 ? 3 : 6;
        uint32_t width = (stage->source->width + factor - 1) / factor;
        uint32_t height = (stage->source->height + factor - 1) / factor;
        kiln_image_init(&stage->small[i], device, width, height, format, "bloom");
    }
}

static void init_pyramid(struct kiln_bloom_cpu *stage, struct kiln_device *device, GLenum format)
{
    uint32_t width = stage->source->width, height = stage->source->height;
    do {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        uint32_t i = stage->levels++;
        kiln_image_init(&stage->small[i], device, width, height, format, "bloom");
        kiln_image_init(&stage->small[KILN_BLOOM_MAX_LEVELS + i], device, width, height, format,
                        "bloom");
    } while (stage->levels < KILN_BLOOM_MAX_LEVELS && width >= 2 * KILN_BLOOM_LEAST_EDGE &&
             height >= 2 * KILN_BLOOM_LEAST_EDGE);
}

struct kiln_bloom_cpu *kiln_bloom_cpu_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_bloom_params *params,
                                             struct kiln_error *error)
{
    struct kiln_bloom_cpu *stage = calloc(1, sizeof *stage);
    if (stage) {
        *stage = (struct kiln_bloom_cpu){
            .scene = scene, .threads = params->threads, .source = params->source};
        stage->pass.row_length = (size_t)params->source->width + (size_t)(2 * KILN_BLOOM_EDGE);
        size_t quads = kiln_threads_count(params->threads) * stage->pass.row_length;
        stage->pass.rows = aligned_alloc(64, (quads * sizeof(kiln_quad) / 64 + 1) * 64);
    }
    if (!stage || !stage->pass.rows) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "bloom: out of memory");
        kiln_bloom_cpu_destroy(&stage);
        return NULL;
    }
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error)) {
        kiln_bloom_cpu_destroy(&stage);
        return NULL;
    }
    stage->rows = KILN_SIMD_PICK(kiln_bloom_rows, simd);
    if (scene->post.bloom == KILN_BLOOM_PYRAMID)
        init_pyramid(stage, device, params->format);
    else
        init_gaussian(stage, device, params->format);
    return stage;
}

void kiln_bloom_cpu_destroy(struct kiln_bloom_cpu **stage)
{
    if (!*stage)
        return;
    for (size_t i = 0; i < sizeof(*stage)->small / sizeof *(*stage)->small; i++)
        kiln_image_finish(&(*stage)->small[i]);
    free((*stage)->pass.rows);
    free(*stage);
    *stage = NULL;
}

/* ---- passes ---------------------------------------------------------------------------------- */

static bool open_view(struct kiln_bloom_view *view, struct kiln_image *image,
                      struct kiln_error *error)
{
    *view = (struct kiln_bloom_view){kiln_image_host(image, KILN_READ, error), image->width,
                                     image->height};
    return view->pixels != NULL;
}

static bool run_pass(struct kiln_bloom_cpu *stage, struct kiln_image *from, struct kiln_image *to,
                     kiln_bloom_rows_run *rows, struct kiln_error *error)
{
    struct kiln_bloom_pass *pass = &stage->pass;
    if (from && !open_view(&pass->from, from, error))
        return false;
    pass->to = kiln_image_host(to, KILN_OVERWRITE, error);
    if (!pass->to)
        return false;
    pass->to_width = to->width;
    return kiln_threads_try(stage->threads, to->height, ROWS_AT_A_TIME, rows, pass, error);
}

static bool find_bright(struct kiln_bloom_cpu *stage, const struct kiln_bloom_inputs *inputs,
                        struct kiln_error *error)
{
    const struct kiln_post *post = &stage->scene->post;
    struct kiln_bloom_pass *pass = &stage->pass;
    pass->exposure = exact_exp2(kiln_scene_value(stage->scene, &post->exposure, inputs->time_s));
    pass->threshold = kiln_scene_value(stage->scene, &post->bloom_threshold, inputs->time_s);
    return kiln_compose_open(&pass->light, inputs->scene, inputs->particles, inputs->fire, error) &&
           run_pass(stage, NULL, stage->source, stage->rows->bright, error);
}

static struct kiln_image *run_gaussian(struct kiln_bloom_cpu *stage, struct kiln_error *error)
{
    struct kiln_image *small = stage->small;
    const struct kiln_bloom_rows *rows = stage->rows;
    stage->pass.factor = 3;
    bool third = run_pass(stage, stage->source, &small[0], rows->shrink, error) &&
                 run_pass(stage, &small[0], &small[1], rows->blur, error);
    stage->pass.factor = 2;
    bool sixth = third && run_pass(stage, &small[1], &small[2], rows->shrink, error) &&
                 run_pass(stage, &small[2], &small[3], rows->blur, error);
    return sixth ? &small[3] : NULL;
}

static struct kiln_image *run_pyramid(struct kiln_bloom_cpu *stage, float radius,
                                      struct kiln_error *error)
{
    struct kiln_image *down = stage->small, *up = stage->small + KILN_BLOOM_MAX_LEVELS;
    for (uint32_t i = 0; i < stage->levels; i++) {
        struct kiln_image *from = i == 0 ? stage->source : &down[i - 1];
        if (!run_pass(stage, from, &down[i], stage->rows->halve, error))
            return NULL;
    }
    stage->pass.radius = radius;
    struct kiln_image *below = &down[stage->levels - 1];
    for (uint32_t i = stage->levels - 1; i-- > 0;) {
        if (!open_view(&stage->pass.level, &down[i], error) ||
            !run_pass(stage, below, &up[i], stage->rows->join, error))
            return NULL;
        below = &up[i];
    }
    return below;
}

struct kiln_image *kiln_bloom_cpu_run(struct kiln_bloom_cpu *stage,
                                      const struct kiln_bloom_inputs *inputs, float *scale,
                                      struct kiln_error *error)
{
    const struct kiln_post *post = &stage->scene->post;
    if (post->bloom_source == KILN_BLOOM_BRIGHT && !find_bright(stage, inputs, error))
        return NULL;
    if (post->bloom == KILN_BLOOM_PYRAMID) {
        *scale = 1.0f / 2.0f;
        float radius = kiln_scene_value(stage->scene, &post->bloom_radius, inputs->time_s);
        return run_pyramid(stage, radius, error);
    }
    *scale = 1.0f / 6.0f;
    return run_gaussian(stage, error);
}
