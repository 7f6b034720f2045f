/* This file composes the picture on the host: it runs the loop over rows (composite_rows.h) on
 * threads and copies the result. */
#include "post/composite_cpu.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"
#include "post/composite_rows.h"
#include "shared/exact.h"

enum { ROWS_AT_A_TIME = 8 };

struct kiln_composite_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    uint32_t bits;
    bool texture;
    void *display; /* RGBA, `bits` bits a channel */
    float *beauty; /* NULL unless the parameters ask for it */
    struct kiln_magnifier magnifier;
    kiln_composite_rows_run *rows;
};

struct kiln_composite_cpu *kiln_composite_cpu_create(const struct kiln_scene *scene,
                                                     const struct kiln_composite_params *params,
                                                     struct kiln_error *error)
{
    struct kiln_composite_cpu *stage = calloc(1, sizeof *stage);
    size_t pixels = (size_t)scene->width * scene->height;
    if (stage) {
        *stage = (struct kiln_composite_cpu){.scene = scene,
                                             .threads = params->threads,
                                             .bits = params->bits,
                                             .texture = params->texture};
        stage->display = malloc(pixels * 4 * (params->bits / 8));
        stage->beauty = params->beauty ? kiln_alloc_pages(pixels * 4 * sizeof(float)) : NULL;
    }
    if (!stage || !stage->display || (params->beauty && !stage->beauty)) {
        kiln_error_no_memory(error, "the composite");
        kiln_composite_cpu_destroy(&stage);
        return NULL;
    }
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error)) {
        kiln_composite_cpu_destroy(&stage);
        return NULL;
    }
    stage->rows = KILN_SIMD_PICK(kiln_composite_rows_run, simd);
    return stage;
}

void kiln_composite_cpu_destroy(struct kiln_composite_cpu **stage)
{
    if (!*stage)
        return;
    kiln_magnifier_finish(&(*stage)->magnifier);
    free((*stage)->display);
    free((*stage)->beauty);
    free(*stage);
    *stage = NULL;
}

bool kiln_composite_cpu_run(struct kiln_composite_cpu *stage,
                            const struct kiln_composite_inputs *inputs, struct kiln_error *error)
{
    const struct kiln_scene *scene = stage->scene;
    const struct kiln_post *post = &scene->post;
    struct kiln_composite_rows picture = {
        .width = scene->width,
        .magnifier = &stage->magnifier,
        .exposure = exact_exp2(kiln_scene_value(scene, &post->exposure, inputs->time_s)),
        .tonemap = post->tonemap,
        .dither = post->dither,
        .texture = stage->texture,
        .frame = inputs->frame,
        .bits = stage->bits,
        .display = stage->display,
        .beauty = stage->beauty,
    };
    if (!kiln_compose_open(&picture.light, inputs->scene, inputs->particles, inputs->fire, error))
        return false;
    if (inputs->bloom)
        picture.strength = kiln_scene_value(scene, &post->bloom_strength, inputs->time_s);
    if (picture.strength > 0.0f) {
        picture.glow = kiln_image_host(inputs->bloom, KILN_READ, error);
        if (!picture.glow ||
            !kiln_magnifier_prepare(&stage->magnifier, scene->width, inputs->bloom,
                                    inputs->bloom_scale, kiln_threads_count(stage->threads), error))
            return false;
    }
    return kiln_threads_try(stage->threads, scene->height, ROWS_AT_A_TIME, stage->rows, &picture,
                            error);
}

bool kiln_composite_cpu_read_display(const struct kiln_composite_cpu *stage, void *pixels,
                                     struct kiln_error *error)
{
    size_t channels = (size_t)stage->scene->width * stage->scene->height * 4;
    return kiln_threads_copy(stage->threads, pixels, stage->display, channels * (stage->bits / 8),
                             error);
}

void kiln_composite_cpu_exchange_beauty(struct kiln_composite_cpu *stage, float **pixels)
{
    float *beauty = stage->beauty;
    stage->beauty = *pixels;
    *pixels = beauty;
}
