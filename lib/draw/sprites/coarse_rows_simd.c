/* This file measures rows of the coarse depth and enlarges coarse pictures to rows of the frame.
 * Where the scene is smooth, a pixel of the frame is interpolated by a spline from the sixteen
 * coarse pixels around it. Near edges it is the mean of the nine nearest coarse pixels, weighted by
 * how similar their depth is to the depth of the pixel. */
#include <string.h>

#include "draw/sprites/coarse_rows.h"
#include "shared/coarse.h"
#include "shared/exact.h"

typedef kiln_coarse_quad quad;
typedef int32_t mask __attribute__((vector_size(16)));
typedef float quad_unaligned __attribute__((vector_size(16), aligned(4), may_alias));

static inline quad load(const float *from)
{
    return *(const quad_unaligned *)from;
}

static inline quad least(quad a, quad b)
{
    mask less = a < b;
    return (quad)(((mask)a & less) | ((mask)b & ~less));
}

static inline quad most(quad a, quad b)
{
    mask more = a > b;
    return (quad)(((mask)a & more) | ((mask)b & ~more));
}

static inline void store(float *to, quad value)
{
    *(quad_unaligned *)to = value;
}

/* ---- depth ----------------------------------------------------------------------------------- */

struct range {
    uint32_t from, to;
};

/* Returns the range of the frame's columns or rows that lie in a coarse one. */
static inline struct range pixels_of(uint32_t coarse, float margin, uint32_t factor, uint32_t size)
{
    uint32_t past = exact_uint(margin), from = coarse * factor;
    return (struct range){from > past ? from - past : 0,
                          from + factor - past < size ? from + factor - past : size};
}

/* Adds a row of the frame to the measurements of its coarse row: the farthest depth, and whether
 * the depths of a pixel and its two neighbours along either axis do not lie on a plane. */
static inline void add_row(const struct kiln_coarse_images *images, const float *depth, uint32_t y,
                           struct kiln_coarse_columns *columns)
{
    const size_t width = images->width;
    const float *at = depth + y * width;
    float *restrict farthest = columns->farthest;
    uint32_t *restrict nonplanar = columns->nonplanar;
    for (size_t x = 0; x < width; x++)
        farthest[x] = at[x] > farthest[x] ? at[x] : farthest[x];
    for (size_t x = 1; x + 1 < width; x++)
        nonplanar[x] |= coarse_is_nonplanar(at[x - 1], at[x], at[x + 1]);
    if (y == 0 || y + 1 == images->height)
        return;
    for (size_t x = 0; x < width; x++)
        nonplanar[x] |= coarse_is_nonplanar(at[x - width], at[x], at[x + width]);
}

static inline void measure_row(const struct kiln_coarse_rows *m, uint32_t y,
                               struct kiln_coarse_columns *columns)
{
    const struct kiln_coarse_images *images = m->images;
    const struct range rows = pixels_of(y, images->margin_y, images->factor, images->height);
    for (uint32_t x = 0; x < images->width; x++) {
        columns->farthest[x] = m->depth[(size_t)rows.from * images->width + x];
        columns->nonplanar[x] = 0;
    }
    for (uint32_t j = rows.from; j < rows.to; j++)
        add_row(images, m->depth, j, columns);
    for (uint32_t x = 0; x < images->depth.width; x++) {
        const struct range in = pixels_of(x, images->margin_x, images->factor, images->width);
        float farthest = columns->farthest[in.from];
        uint32_t nonplanar = 0;
        for (uint32_t i = in.from; i < in.to; i++) {
            farthest = columns->farthest[i] > farthest ? columns->farthest[i] : farthest;
            nonplanar |= columns->nonplanar[i];
        }
        const size_t at = (size_t)y * images->depth.width + x;
        m->coarse_depth[at] = farthest;
        m->nonplanar[at] = (uint8_t)nonplanar;
    }
}

static void measure_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct kiln_coarse_rows *m = context;
    for (size_t y = begin; y < end; y++)
        measure_row(m, (uint32_t)y, &m->measured[worker]);
}

static void find_edges(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct kiln_coarse_rows *m = context;
    const size_t width = m->images->depth.width, height = m->images->depth.height;
    uint32_t *restrict around = m->measured[worker].nonplanar;
    for (size_t y = begin; y < end; y++) {
        const uint8_t *at = m->nonplanar + y * width;
        const uint8_t *above = y > 0 ? at - width : at, *below = y + 1 < height ? at + width : at;
        for (size_t x = 0; x < width; x++)
            around[x] = above[x] | at[x] | below[x];
        for (size_t x = 0; x < width; x++) {
            uint32_t left = around[x > 0 ? x - 1 : x], right = around[x + 1 < width ? x + 1 : x];
            m->edges[y * width + x] = (left | around[x] | right) != 0 ? 1.0f : 0.0f;
        }
    }
}

/* Returns the weight of the fine picture: 1 near an edge, falling to 0 over a coarse pixel. */
static inline float fine_weight(const float *above, const float *below,
                                const struct kiln_coarse_place *x, float down)
{
    float left = above[x->taps[1]] + (below[x->taps[1]] - above[x->taps[1]]) * down;
    float right = above[x->taps[2]] + (below[x->taps[2]] - above[x->taps[2]]) * down;
    return left + (right - left) * x->part;
}

static void mask_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_coarse_rows *m = context;
    const struct kiln_coarse_images *images = m->images;
    for (size_t y = begin; y < end; y++) {
        const struct kiln_coarse_place row = m->rows[y];
        const float *above = m->edges + (size_t)row.taps[1] * images->depth.width;
        const float *below = m->edges + (size_t)row.taps[2] * images->depth.width;
        for (size_t x = 0; x < images->width; x++) {
            float part = fine_weight(above, below, &m->columns[x], row.part);
            m->fine_depth[y * images->width + x] =
                part > 0.0f ? m->depth[y * images->width + x] : 0.0f;
        }
    }
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Interpolates between the middle two of four pixels by a cubic spline, clamped to the range of
 * these two. */
static inline quad interpolate(quad before, quad low, quad high, quad after, const float weights[4])
{
    quad sum = (before * weights[0] + low * weights[1]) + (high * weights[2] + after * weights[3]);
    return least(most(sum, least(low, high)), most(low, high));
}

/* Interpolates a row between four coarse rows. Returns the range of columns outside of which the
 * four rows are empty. */
static inline struct range mix_rows(const struct kiln_coarse_rows *s,
                                    const struct kiln_coarse_place *row,
                                    struct kiln_coarse_pixel *mixed)
{
    const size_t width = s->images->depth.width;
    const float *colors[4], *blooms[4];
    for (int i = 0; i < 4; i++) {
        colors[i] = s->coarse_color + 4 * width * (size_t)row->taps[i];
        blooms[i] = s->coarse_bloom + 4 * width * (size_t)row->taps[i];
    }
    struct range shown = {UINT32_MAX, 0};
    for (uint32_t x = 0; x < width; x++) {
        mask any = {0};
        quad color[4], bloom[4];
        for (int i = 0; i < 4; i++) {
            color[i] = load(colors[i] + 4 * (size_t)x);
            bloom[i] = load(blooms[i] + 4 * (size_t)x);
            any |= (mask)color[i] | (mask)bloom[i];
        }
        mixed[x].color = interpolate(color[0], color[1], color[2], color[3], row->weights);
        mixed[x].bloom = interpolate(bloom[0], bloom[1], bloom[2], bloom[3], row->weights);
        if ((any[0] | any[1] | any[2] | any[3]) == 0)
            continue;
        shown.from = shown.from == UINT32_MAX ? x : shown.from;
        shown.to = x + 1;
    }
    return shown;
}

/* Returns the mean of the coarse pixel in which a pixel lies and of the eight around it, weighted
 * by distance and by how similar their depth is to the pixel's. */
static inline struct kiln_coarse_pixel mean_of_nine(const struct kiln_coarse_rows *s,
                                                    const struct kiln_coarse_place *x,
                                                    const struct kiln_coarse_place *y, float depth)
{
    const int32_t width = (int32_t)s->images->depth.width;
    const int32_t height = (int32_t)s->images->depth.height;
    struct kiln_coarse_pixel sum = {{0}, {0}};
    float weights = 0.0f;
    for (int32_t j = -1; j <= 1; j++) {
        int32_t row = y->containing + j;
        if (row < 0 || row >= height)
            continue;
        float down = coarse_near(y->at - (float)row);
        for (int32_t i = -1; i <= 1; i++) {
            int32_t column = x->containing + i;
            if (column < 0 || column >= width)
                continue;
            size_t at = (size_t)row * (size_t)width + (size_t)column;
            float weight = down * coarse_near(x->at - (float)column) *
                           coarse_similarity(depth, s->coarse_depth[at]);
            sum.color += load(s->coarse_color + 4 * at) * weight;
            sum.bloom += load(s->coarse_bloom + 4 * at) * weight;
            weights += weight;
        }
    }
    sum.color /= weights;
    sum.bloom /= weights;
    return sum;
}

static inline void enlarge_pixel(const struct kiln_coarse_rows *s, uint32_t x, uint32_t y,
                                 const struct kiln_coarse_pixel *mixed)
{
    const struct kiln_coarse_place *column = &s->columns[x], *row = &s->rows[y];
    const size_t width = s->images->depth.width, at = (size_t)y * s->images->width + x;
    const struct kiln_coarse_pixel *taps[4];
    for (int i = 0; i < 4; i++)
        taps[i] = &mixed[column->taps[i]];
    struct kiln_coarse_pixel shown = {interpolate(taps[0]->color, taps[1]->color, taps[2]->color,
                                                  taps[3]->color, column->weights),
                                      interpolate(taps[0]->bloom, taps[1]->bloom, taps[2]->bloom,
                                                  taps[3]->bloom, column->weights)};
    if (s->edges[(size_t)row->containing * width + (size_t)column->containing] > 0.0f)
        shown = mean_of_nine(s, column, row, s->depth[at]);
    float fine = 0.0f;
    if (s->fine_color)
        fine = fine_weight(s->edges + (size_t)row->taps[1] * width,
                           s->edges + (size_t)row->taps[2] * width, column, row->part);
    if (fine > 0.0f) {
        shown.color += (load(s->fine_color + 4 * at) - shown.color) * fine;
        shown.bloom += (load(s->fine_bloom + 4 * at) - shown.bloom) * fine;
    }
    store(s->color + 4 * at, shown.color);
    if (!s->bloom)
        return;
    if (s->keep_bloom)
        shown.bloom += load(s->bloom + 4 * at) * (1.0f - shown.color[3] * s->over);
    store(s->bloom + 4 * at, shown.bloom);
}

/* Clears pixels where the coarse picture is empty. */
static void clear_pixels(const struct kiln_coarse_rows *s, uint32_t y, struct range pixels)
{
    const size_t at = (size_t)y * s->images->width + pixels.from;
    const size_t bytes = 4 * sizeof *s->color * (pixels.to - pixels.from);
    memset(s->color + 4 * at, 0, bytes);
    if (s->bloom && !s->keep_bloom)
        memset(s->bloom + 4 * at, 0, bytes);
}

static inline void enlarge_row(const struct kiln_coarse_rows *s, uint32_t y,
                               struct kiln_coarse_pixel *mixed)
{
    const uint32_t width = s->images->width;
    const struct range shown = mix_rows(s, &s->rows[y], mixed);
    struct range pixels = {0, width}; /* pixels that may not be empty */
    if (!s->fine_color) {
        while (pixels.from < width && s->columns[pixels.from].taps[3] < (int64_t)shown.from)
            pixels.from++;
        while (pixels.to > pixels.from && s->columns[pixels.to - 1].taps[0] >= (int64_t)shown.to)
            pixels.to--;
    }
    clear_pixels(s, y, (struct range){0, pixels.from});
    for (uint32_t x = pixels.from; x < pixels.to; x++)
        enlarge_pixel(s, x, y, mixed);
    clear_pixels(s, y, (struct range){pixels.to, width});
}

static void enlarge_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct kiln_coarse_rows *s = context;
    struct kiln_coarse_pixel *mixed = s->interpolated + worker * (size_t)s->images->depth.width;
    for (size_t y = begin; y < end; y++)
        enlarge_row(s, (uint32_t)y, mixed);
}

const struct kiln_coarse_loops KILN_SIMD_NAME(kiln_coarse_loops) = {
    .measure = measure_rows,
    .find_edges = find_edges,
    .mask = mask_rows,
    .enlarge = enlarge_rows,
};
