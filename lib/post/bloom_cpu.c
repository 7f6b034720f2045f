/* This file runs the passes of the blooms on the host: the bright pass, the Gaussians and the
 * pyramid, at the sizes of bloom_plan.h. Each pass is a loop over rows (bloom_rows.h), divided
 * among threads. */
#include "post/bloom_cpu.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_rows.h"
#include "shared/exact.h"
#include "shared/tent.h"

enum { ROWS_AT_A_TIME = 4 };

struct kiln_bloom_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_image *source;
    struct kiln_bloom_plan plan;
    /* Two pictures for each level of the plan. One holds the reduced picture, and the blurred one
     * in the end. The other holds what is blurred along rows, or the pyramid's joined levels. */
    struct kiln_image small[KILN_BLOOM_MAX_LEVELS][2];
    struct kiln_bloom_column *columns; /* of the reduction of the source; NULL for the thesis */
    float *column_weights;
    const struct kiln_bloom_rows *rows;
    struct kiln_bloom_pass pass; /* parameters; each pass sets those that it needs */
};

/* ---- create, destroy ------------------------------------------------------------------------- */

/* Computes which pixels of a row of the source make a pixel of the first level. Pixels beyond the
 * ends of the row repeat the pixel at the end, so their weights are added to its weight. */
static bool fill_columns(struct kiln_bloom_cpu *stage)
{
    const struct kiln_bloom_level *level = &stage->plan.levels[0];
    const float reach = level->ratio + 0.5f;
    const size_t most = 2 * (size_t)exact_uint(ceilf(reach)) + 1;
    const int64_t end = (int64_t)stage->source->width - 1;
    stage->columns = calloc(level->width, sizeof *stage->columns);
    stage->column_weights = calloc(level->width * most, sizeof *stage->column_weights);
    if (!stage->columns || !stage->column_weights)
        return false;
    for (uint32_t x = 0; x < level->width; x++) {
        const float center = tent_center((float)x, level->ratio);
        const int64_t first = (int64_t)exact_int(floorf(center - reach)) + 1;
        const int64_t last = (int64_t)exact_int(ceilf(center + reach)) - 1;
        const int64_t least = first < 0 ? 0 : first > end ? end : first;
        float *weights = stage->column_weights + x * most;
        for (int64_t from = first; from <= last; from++) {
            int64_t inside = from < 0 ? 0 : from > end ? end : from;
            weights[inside - least] += tent_weight((float)from - center, level->ratio);
        }
        const int64_t greatest = last < end ? last : end;
        stage->columns[x] =
            (struct kiln_bloom_column){(uint32_t)least, (uint32_t)(greatest - least + 1), weights};
    }
    return true;
}

static size_t row_length_of(uint32_t width)
{
    return (size_t)width + (size_t)(2 * KILN_BLOOM_EDGE);
}

static bool init(struct kiln_bloom_cpu *stage, struct kiln_device *device, GLenum format)
{
    const struct kiln_image *source = stage->source;
    kiln_bloom_plan_init(&stage->plan, stage->scene, source->width, source->height);
    stage->pass.plan = &stage->plan;
    for (uint32_t i = 0; i < stage->plan.level_count; i++) {
        const struct kiln_bloom_level *level = &stage->plan.levels[i];
        for (int k = 0; k < 2; k++)
            kiln_image_init(&stage->small[i][k], device, level->width, level->height, format,
                            "bloom");
    }
    stage->pass.row_length = row_length_of(source->width);
    size_t quads = kiln_threads_count(stage->threads) * stage->pass.row_length;
    stage->pass.rows = aligned_alloc(64, (quads * sizeof(kiln_quad) / 64 + 1) * 64);
    return stage->pass.rows && (stage->plan.kind == KILN_BLOOM_THESIS || fill_columns(stage));
}

struct kiln_bloom_cpu *kiln_bloom_cpu_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_bloom_params *params,
                                             struct kiln_error *error)
{
    struct kiln_bloom_cpu *stage = calloc(1, sizeof *stage);
    if (stage)
        *stage = (struct kiln_bloom_cpu){
            .scene = scene, .threads = params->threads, .source = params->source};
    if (!stage || !init(stage, device, params->format)) {
        kiln_error_no_memory(error, "the bloom");
        kiln_bloom_cpu_destroy(&stage);
        return NULL;
    }
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error)) {
        kiln_bloom_cpu_destroy(&stage);
        return NULL;
    }
    stage->rows = KILN_SIMD_PICK(kiln_bloom_rows, simd);
    return stage;
}

void kiln_bloom_cpu_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    struct kiln_bloom_plan plan = {0};
    kiln_bloom_plan_init(&plan, scene, scene->width, scene->height);
    for (uint32_t i = 0; i < plan.level_count; i++)
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE,
                           (uint64_t)plan.levels[i].width * plan.levels[i].height,
                           (size_t)2 * 4 * sizeof(float));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, footprint->threads,
                       row_length_of(scene->width) * sizeof(kiln_quad));
}

void kiln_bloom_cpu_destroy(struct kiln_bloom_cpu **stage)
{
    if (!*stage)
        return;
    for (size_t i = 0; i < KILN_BLOOM_MAX_LEVELS; i++) {
        kiln_image_finish(&(*stage)->small[i][0]);
        kiln_image_finish(&(*stage)->small[i][1]);
    }
    free((*stage)->columns);
    free((*stage)->column_weights);
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

/* Reduces the level above, or the source, to a level. */
static bool run_reduction(struct kiln_bloom_cpu *stage, uint32_t level, kiln_bloom_rows_run *rows,
                          struct kiln_error *error)
{
    struct kiln_image *from = level == 0 ? stage->source : &stage->small[level - 1][0];
    stage->pass.ratio = stage->plan.levels[level].ratio;
    stage->pass.columns = stage->columns;
    return run_pass(stage, from, &stage->small[level][0], rows, error);
}

static struct kiln_image *run_gaussian(struct kiln_bloom_cpu *stage, struct kiln_error *error)
{
    const struct kiln_bloom_rows *rows = stage->rows;
    struct kiln_image *blurred = NULL;
    for (uint32_t i = 0; i < stage->plan.level_count; i++) {
        struct kiln_image *small = stage->small[i];
        if (!run_reduction(stage, i, stage->columns ? rows->reduce : rows->shrink, error) ||
            !run_pass(stage, &small[0], &small[1], rows->across, error) ||
            !run_pass(stage, &small[1], &small[0], rows->down, error))
            return NULL;
        blurred = &small[0];
    }
    return blurred;
}

static struct kiln_image *run_pyramid(struct kiln_bloom_cpu *stage, float radius,
                                      struct kiln_error *error)
{
    const struct kiln_bloom_rows *rows = stage->rows;
    const uint32_t levels = stage->plan.level_count;
    for (uint32_t i = 0; i < levels; i++) {
        if (!run_reduction(stage, i, i == 0 ? rows->reduce : rows->halve, error))
            return NULL;
    }
    struct kiln_image *below = &stage->small[levels - 1][0];
    for (uint32_t i = levels - 1; i-- > 0;) {
        struct kiln_image *small = stage->small[i];
        stage->pass.radius = kiln_bloom_plan_radius(&stage->plan, i, radius);
        if (!open_view(&stage->pass.level, &small[0], error) ||
            !run_pass(stage, below, &small[1], rows->join, error))
            return NULL;
        below = &small[1];
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
    *scale = stage->plan.scale;
    if (stage->plan.kind == KILN_BLOOM_PYRAMID) {
        float radius = kiln_scene_value(stage->scene, &post->bloom_radius, inputs->time_s);
        return run_pyramid(stage, radius, error);
    }
    return run_gaussian(stage, error);
}
