/* This file computes rows of the bloom's passes on the host, as the shaders post/bloom_*.frag do in
 * GL. A filter in two directions first filters several rows into one row vertically, then that row
 * horizontally. */
#include <math.h>
#include <string.h>

#include "post/bloom_rows.h"
#include "shared/exact.h"
#include "shared/tent.h"

static const float HALF_MAX = 65504.0f; /* the greatest 16-bit float; greater values are clamped to
                                         * it */

static inline kiln_quad clamp_to_half(kiln_quad light)
{
    typedef int32_t mask __attribute__((vector_size(16)));
    const kiln_quad most = {HALF_MAX, HALF_MAX, HALF_MAX, HALF_MAX};
    mask below = light < most;
    return (kiln_quad)(((mask)light & below) | ((mask)most & ~below));
}

/* Returns row y of a picture, or the nearest one if y is outside. */
static inline const float *row_at(const struct kiln_bloom_view *view, int64_t y)
{
    int64_t last = (int64_t)view->height - 1;
    y = y < 0 ? 0 : y > last ? last : y;
    return view->pixels + (size_t)y * view->width * 4;
}

/* Returns pixel 0 of the thread's own row. */
static inline kiln_quad *worker_row(const struct kiln_bloom_pass *p, uint32_t worker)
{
    return p->rows + worker * p->row_length + KILN_BLOOM_EDGE;
}

static inline void repeat_edges(kiln_quad *row, size_t width)
{
    for (size_t k = 1; k <= KILN_BLOOM_EDGE; k++) {
        *(row - k) = row[0];
        row[width - 1 + k] = row[width - 1];
    }
}

static inline void shrink_row(const struct kiln_bloom_pass *p, size_t y)
{
    const size_t factor = (size_t)exact_uint(p->ratio), last = p->from.width - 1;
    const float pixel_count = (float)(factor * factor);
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        kiln_quad sum = {0};
        for (size_t dy = 0; dy < factor; dy++) {
            const float *from = row_at(&p->from, (int64_t)(y * factor + dy));
            for (size_t dx = 0; dx < factor; dx++) {
                size_t at = x * factor + dx;
                sum += clamp_to_half(kiln_quad_load(from + 4 * (at < last ? at : last)));
            }
        }
        kiln_quad_store(to + 4 * x, sum / pixel_count);
    }
}

static inline float clamp_channel(float light)
{
    return light < HALF_MAX ? light : HALF_MAX;
}

/* Adds two rows times their weights to sums, channel by channel, which compilers vectorise. */
static inline void add_rows(float *sums, const float *rows[2], const float weights[2], size_t count)
{
    const float *first = rows[0], *second = rows[1];
    const float w0 = weights[0], w1 = weights[1];
    for (size_t i = 0; i < count; i++)
        sums[i] += clamp_channel(first[i]) * w0 + clamp_channel(second[i]) * w1;
}

static inline void reduce_row(const struct kiln_bloom_pass *p, size_t y, uint32_t worker)
{
    const float center = tent_center((float)y, p->ratio), reach = p->ratio + 0.5f;
    const int64_t first = (int64_t)exact_int(floorf(center - reach)) + 1;
    const int64_t last = (int64_t)exact_int(ceilf(center + reach)) - 1;
    const size_t count = 4 * (size_t)p->from.width;
    float *sums = (float *)worker_row(p, worker);
    memset(sums, 0, count * sizeof *sums);
    for (int64_t from = first; from <= last; from += 2) {
        const float *rows[2] = {row_at(&p->from, from), row_at(&p->from, from + 1)};
        const float weights[2] = {tent_weight((float)from - center, p->ratio),
                                  tent_weight((float)(from + 1) - center, p->ratio)};
        add_rows(sums, rows, weights, count);
    }
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        const struct kiln_bloom_column *column = &p->columns[x];
        kiln_quad sum = {0};
        for (uint32_t i = 0; i < column->count; i++)
            sum += kiln_quad_load(sums + 4 * (column->first + (size_t)i)) * column->weights[i];
        kiln_quad_store(to + 4 * x, sum);
    }
}

static inline void blur_across(const struct kiln_bloom_pass *p, size_t y, uint32_t worker)
{
    const float *weights = p->plan->weights, *from = row_at(&p->from, (int64_t)y);
    const uint32_t taps = p->plan->taps;
    kiln_quad *row = worker_row(p, worker);
    for (size_t x = 0; x < p->to_width; x++)
        row[x] = kiln_quad_load(from + 4 * x);
    repeat_edges(row, p->to_width);
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        const kiln_quad *here = row + x;
        kiln_quad sum = here[0] * weights[0];
        for (uint32_t i = 1; i < taps; i++)
            sum += (here[i] + *(here - i)) * weights[i];
        kiln_quad_store(to + 4 * x, sum);
    }
}

static inline void blur_down(const struct kiln_bloom_pass *p, size_t y)
{
    const float *weights = p->plan->weights;
    const uint32_t taps = p->plan->taps;
    const float *above[KILN_BLOOM_MAX_TAPS], *below[KILN_BLOOM_MAX_TAPS];
    for (uint32_t i = 0; i < taps; i++) {
        above[i] = row_at(&p->from, (int64_t)y - i);
        below[i] = row_at(&p->from, (int64_t)y + i);
    }
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < 4 * (size_t)p->to_width; x += 4) {
        kiln_quad sum = kiln_quad_load(above[0] + x) * weights[0];
        for (uint32_t i = 1; i < taps; i++)
            sum += (kiln_quad_load(below[i] + x) + kiln_quad_load(above[i] + x)) * weights[i];
        kiln_quad_store(to + x, sum);
    }
}

static inline void halve_row(const struct kiln_bloom_pass *p, size_t y, uint32_t worker)
{
    const float *rows[4];
    for (int i = 0; i < 4; i++)
        rows[i] = row_at(&p->from, 2 * (int64_t)y - 1 + i);
    kiln_quad *row = worker_row(p, worker);
    for (size_t x = 0; x < p->from.width; x++) {
        kiln_quad outer = clamp_to_half(kiln_quad_load(rows[0] + 4 * x)) +
                          clamp_to_half(kiln_quad_load(rows[3] + 4 * x));
        kiln_quad inner = clamp_to_half(kiln_quad_load(rows[1] + 4 * x)) +
                          clamp_to_half(kiln_quad_load(rows[2] + 4 * x));
        row[x] = outer * 0.125f + inner * 0.375f;
    }
    repeat_edges(row, p->from.width);
    float *to = p->to + y * p->to_width * 4;
    for (size_t x = 0; x < p->to_width; x++) {
        const kiln_quad *here = row + 2 * x;
        kiln_quad_store(to + 4 * x, (here[-1] + here[2]) * 0.125f + (here[0] + here[1]) * 0.375f);
    }
}

static inline void join_row(const struct kiln_bloom_pass *p, size_t y, uint32_t worker)
{
    static const float weights[2][3] = {{0.28125f, 0.6875f, 0.03125f},
                                        {0.03125f, 0.6875f, 0.28125f}};
    const float *w = weights[y & 1], *rows[3];
    for (int i = 0; i < 3; i++)
        rows[i] = row_at(&p->from, (int64_t)(y / 2) - 1 + i);
    kiln_quad *row = worker_row(p, worker);
    for (size_t x = 0; x < p->from.width; x++)
        row[x] = kiln_quad_load(rows[0] + 4 * x) * w[0] + kiln_quad_load(rows[1] + 4 * x) * w[1] +
                 kiln_quad_load(rows[2] + 4 * x) * w[2];
    repeat_edges(row, p->from.width);
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

static inline void bright_row(const struct kiln_bloom_pass *p, size_t y)
{
    for (size_t x = 0; x < p->to_width; x++) {
        size_t at = 4 * (y * p->to_width + x);
        kiln_quad color = clamp_to_half(kiln_compose(&p->light, at));
        float strongest = exact_max(exact_max(color[0], color[1]), color[2]) * p->exposure;
        float beyond = exact_max(strongest - p->threshold, 0.0f) / exact_max(strongest, 1e-6f);
        color *= beyond;
        color[3] = 0.0f;
        kiln_quad_store(p->to + at, color);
    }
}

static void shrink_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++)
        shrink_row(context, y);
}

static void reduce_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        reduce_row(context, y, worker);
}

static void across_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        blur_across(context, y, worker);
}

static void down_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++)
        blur_down(context, y);
}

static void halve_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        halve_row(context, y, worker);
}

static void join_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        join_row(context, y, worker);
}

static void bright_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++)
        bright_row(context, y);
}

const struct kiln_bloom_rows KILN_SIMD_NAME(kiln_bloom_rows) = {
    .bright = bright_rows,
    .shrink = shrink_rows,
    .reduce = reduce_rows,
    .across = across_rows,
    .down = down_rows,
    .halve = halve_rows,
    .join = join_rows,
};
