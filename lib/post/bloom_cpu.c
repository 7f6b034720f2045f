/* What the shaders of post/bloom_*.frag do, row by row. Where a filter has two directions, a row is
 * first put together from several, then filtered along itself.
 */
#include "post/bloom_cpu.h"

#include "base/error.h"
#include "base/vector.h"
#include "post/bloom_kernels.h"
#include "post/compose.h"

#include <stdlib.h>

enum {
    EDGE = 5, /* pixels that a filter reaches beyond a row, at most */
    ROWS_AT_A_TIME = 4,
};

static const float HALF_MAX = 65504.0f; /* what an overflow of 16 bits counts as */

struct kiln_bloom_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_image *source;
    struct kiln_image small[2 * KILN_BLOOM_MAX_LEVELS];
    uint32_t levels; /* of the pyramid; small holds those going down, then those coming up */
    kiln_quad *rows; /* one a thread, with edges */
    size_t row_length;
    float weights[KILN_BLOOM_TAPS];
};

/* ---- create, destroy ------------------------------------------------------------------------- */

/* Of the Gaussian: two pictures of a third of the size, two of a sixth. */
static void init_gaussian(struct kiln_bloom_cpu *stage, struct kiln_device *device, GLenum format)
{
    kiln_bloom_gaussian_weights(stage->weights);
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
        stage->row_length = (size_t)params->source->width + (size_t)(2 * EDGE);
        size_t size = kiln_threads_count(params->threads) * stage->row_length * sizeof(kiln_quad);
        stage->rows = aligned_alloc(64, (size / 64 + 1) * 64);
    }
    if (!stage || !stage->rows) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "bloom: out of memory");
        kiln_bloom_cpu_destroy(&stage);
        return NULL;
    }
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
    free((*stage)->rows);
    free(*stage);
    *stage = NULL;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* A picture that is read. */
struct view {
    const float *pixels;
    uint32_t width, height;
};

/* One loop over the rows of a picture that is written. */
struct pass {
    struct kiln_bloom_cpu *stage;
    struct view from, level; /* level: of the way up */
    float *to;
    uint32_t to_width, factor;
    float radius;
    struct kiln_compose_light light; /* of the bright pass */
    float exposure, threshold;
};

static inline kiln_quad limited(kiln_quad light)
{
    typedef int32_t mask __attribute__((vector_size(16)));
    const kiln_quad most = {HALF_MAX, HALF_MAX, HALF_MAX, HALF_MAX};
    mask below = light < most;
    return (kiln_quad)(((mask)light & below) | ((mask)most & ~below));
}

/* A row of a picture, the nearest one beyond its edges. */
static inline const float *row_at(const struct view *view, int64_t y)
{
    int64_t last = (int64_t)view->height - 1;
    y = y < 0 ? 0 : y > last ? last : y;
    return view->pixels + (size_t)y * view->width * 4;
}

/* Room for a row of the thread; its pixel 0. */
static inline kiln_quad *own_row(const struct pass *p, uint32_t worker)
{
    return p->stage->rows + worker * p->stage->row_length + EDGE;
}

static inline void extend(kiln_quad *row, size_t width)
{
    for (size_t k = 1; k <= EDGE; k++) {
        *(row - k) = row[0];
        row[width - 1 + k] = row[width - 1];
    }
}

/* post/bloom_shrink.frag, then post/bloom_blur.frag along the row. */
static inline void shrink_row(const struct pass *p, size_t y, uint32_t worker)
{
    kiln_quad *row = own_row(p, worker);
    const size_t factor = p->factor, last = p->from.width - 1;
    const float share = (float)(factor * factor);
    for (size_t x = 0; x < p->to_width; x++) {
        kiln_quad sum = {0};
        for (size_t dy = 0; dy < factor; dy++) {
            const float *from = row_at(&p->from, (int64_t)(y * factor + dy));
            for (size_t dx = 0; dx < factor; dx++) {
                size_t at = x * factor + dx;
                sum += limited(kiln_quad_load(from + 4 * (at < last ? at : last)));
            }
        }
        row[x] = sum / share;
    }
    extend(row, p->to_width);
    const float *weights = p->stage->weights;
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        const kiln_quad *here = row + x;
        kiln_quad sum = here[0] * weights[0];
        for (int i = 1; i < KILN_BLOOM_TAPS; i++)
            sum += (here[i] + here[-i]) * weights[i];
        kiln_quad_store(to + 4 * x, sum);
    }
}

/* post/bloom_blur.frag down the columns. */
static inline void blur_row(const struct pass *p, size_t y)
{
    const float *rows[2 * KILN_BLOOM_TAPS - 1];
    for (int i = 0; i < 2 * KILN_BLOOM_TAPS - 1; i++)
        rows[i] = row_at(&p->from, (int64_t)y + i - (KILN_BLOOM_TAPS - 1));
    const float *weights = p->stage->weights;
    const int middle = KILN_BLOOM_TAPS - 1;
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < 4 * (size_t)p->to_width; x += 4) {
        kiln_quad sum = kiln_quad_load(rows[middle] + x) * weights[0];
        for (int i = 1; i < KILN_BLOOM_TAPS; i++)
            sum += (kiln_quad_load(rows[middle + i] + x) + kiln_quad_load(rows[middle - i] + x)) *
                   weights[i];
        kiln_quad_store(to + x, sum);
    }
}

/* post/bloom_down.frag. */
static inline void halve_row(const struct pass *p, size_t y, uint32_t worker)
{
    const float *rows[4];
    for (int i = 0; i < 4; i++)
        rows[i] = row_at(&p->from, 2 * (int64_t)y - 1 + i);
    kiln_quad *row = own_row(p, worker);
    for (size_t x = 0; x < p->from.width; x++) {
        kiln_quad outer =
            limited(kiln_quad_load(rows[0] + 4 * x)) + limited(kiln_quad_load(rows[3] + 4 * x));
        kiln_quad inner =
            limited(kiln_quad_load(rows[1] + 4 * x)) + limited(kiln_quad_load(rows[2] + 4 * x));
        row[x] = outer * 0.125f + inner * 0.375f;
    }
    extend(row, p->from.width);
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        const kiln_quad *here = row + 2 * x;
        kiln_quad_store(to + 4 * x, (here[-1] + here[2]) * 0.125f + (here[0] + here[1]) * 0.375f);
    }
}

/* post/bloom_up.frag: `from` is what lies below. */
static inline void join_row(const struct pass *p, size_t y, uint32_t worker)
{
    static const float weights[2][3] = {{0.28125f, 0.6875f, 0.03125f},
                                        {0.03125f, 0.6875f, 0.28125f}};
    const float *w = weights[y & 1], *rows[3];
    for (int i = 0; i < 3; i++)
        rows[i] = row_at(&p->from, (int64_t)(y / 2) - 1 + i);
    kiln_quad *row = own_row(p, worker);
    for (size_t x = 0; x < p->from.width; x++)
        row[x] = kiln_quad_load(rows[0] + 4 * x) * w[0] + kiln_quad_load(rows[1] + 4 * x) * w[1] +
                 kiln_quad_load(rows[2] + 4 * x) * w[2];
    extend(row, p->from.width);
    const float *level = row_at(&p->level, (int64_t)y);
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        const kiln_quad *here = row + x / 2;
        w = weights[x & 1];
        kiln_quad sum = here[-1] * w[0] + here[0] * w[1] + here[1] * w[2];
        kiln_quad_store(to + 4 * x,
                        kiln_quad_load(level + 4 * x) * (1.0f - p->radius) + sum * p->radius);
    }
}

/* post/bloom_bright.frag. */
static inline void bright_row(const struct pass *p, size_t y)
{
    for (size_t x = 0; x < p->to_width; x++) {
        size_t at = 4 * (y * p->to_width + x);
        kiln_quad color = limited(kiln_compose(&p->light, at));
        float strongest = exact_max(exact_max(color[0], color[1]), color[2]) * p->exposure;
        float beyond = exact_max(strongest - p->threshold, 0.0f) / exact_max(strongest, 1e-6f);
        color *= beyond;
        color[3] = 0.0f;
        kiln_quad_store(p->to + at, color);
    }
}

KILN_WIDE_VECTORS
static void shrink_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        shrink_row(context, y, worker);
}

KILN_WIDE_VECTORS
static void blur_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++)
        blur_row(context, y);
}

KILN_WIDE_VECTORS
static void halve_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        halve_row(context, y, worker);
}

KILN_WIDE_VECTORS
static void join_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        join_row(context, y, worker);
}

KILN_WIDE_VECTORS
static void bright_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++)
        bright_row(context, y);
}

/* ---- passes ---------------------------------------------------------------------------------- */

typedef void kiln_bloom_rows(void *context, size_t begin, size_t end, uint32_t worker);

static bool open_view(struct view *view, struct kiln_image *image, struct kiln_error *error)
{
    *view = (struct view){kiln_image_host(image, KILN_READ, error), image->width, image->height};
    return view->pixels != NULL;
}

static bool run_pass(struct pass *pass, struct kiln_image *from, struct kiln_image *to,
                     kiln_bloom_rows *rows, struct kiln_error *error)
{
    if (from && !open_view(&pass->from, from, error))
        return false;
    pass->to = kiln_image_host(to, KILN_OVERWRITE, error);
    if (!pass->to)
        return false;
    pass->to_width = to->width;
    kiln_threads_for(pass->stage->threads, to->height, ROWS_AT_A_TIME, rows, pass);
    return true;
}

static bool find_bright(struct kiln_bloom_cpu *stage, const struct kiln_bloom_inputs *inputs,
                        struct kiln_error *error)
{
    const struct kiln_post *post = &stage->scene->post;
    struct pass pass = {
        .stage = stage,
        .exposure = exact_exp2(kiln_scene_value(stage->scene, &post->exposure, inputs->time_s)),
        .threshold = kiln_scene_value(stage->scene, &post->bloom_threshold, inputs->time_s),
    };
    return kiln_compose_open(&pass.light, inputs->scene, inputs->particles, inputs->fire, error) &&
           run_pass(&pass, NULL, stage->source, bright_rows, error);
}

static struct kiln_image *run_gaussian(struct kiln_bloom_cpu *stage, struct kiln_error *error)
{
    struct kiln_image *small = stage->small;
    struct pass pass = {.stage = stage, .factor = 3};
    bool third = run_pass(&pass, stage->source, &small[0], shrink_rows, error) &&
                 run_pass(&pass, &small[0], &small[1], blur_rows, error);
    pass.factor = 2;
    bool sixth = third && run_pass(&pass, &small[1], &small[2], shrink_rows, error) &&
                 run_pass(&pass, &small[2], &small[3], blur_rows, error);
    return sixth ? &small[3] : NULL;
}

static struct kiln_image *run_pyramid(struct kiln_bloom_cpu *stage, float radius,
                                      struct kiln_error *error)
{
    struct kiln_image *down = stage->small, *up = stage->small + KILN_BLOOM_MAX_LEVELS;
    struct pass pass = {.stage = stage, .radius = radius};
    for (uint32_t i = 0; i < stage->levels; i++) {
        if (!run_pass(&pass, i == 0 ? stage->source : &down[i - 1], &down[i], halve_rows, error))
            return NULL;
    }
    struct kiln_image *below = &down[stage->levels - 1];
    for (uint32_t i = stage->levels - 1; i-- > 0;) {
        if (!open_view(&pass.level, &down[i], error) ||
            !run_pass(&pass, below, &up[i], join_rows, error))
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
