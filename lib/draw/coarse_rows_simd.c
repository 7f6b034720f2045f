/* Where the scene is smooth, a pixel of the frame is interpolated by a spline from the sixteen
 * coarse ones around it; near edges it takes those of nine that have a depth like its own, however
 * far their places.
 */
#include "draw/coarse_rows.h"

#include "shared/coarse.h"

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

/* The pixels of the frame in a coarse one. */
static inline struct range pixels_of(uint32_t coarse, float beyond, uint32_t factor, uint32_t size)
{
    uint32_t past = (uint32_t)beyond, from = coarse * factor;
    return (struct range){from > past ? from - past : 0,
                          from + factor - past < size ? from + factor - past : size};
}

/* Whether a pixel's depth and its neighbours' do not lie on a plane, along either axis. */
static inline bool is_bent(const struct kiln_coarse_images *images, const float *depth, uint32_t x,
                           uint32_t y)
{
    const float *at = depth + (size_t)y * images->width + x;
    const size_t left = x > 0, right = x + 1 < images->width;
    const size_t up = y > 0 ? images->width : 0, down = y + 1 < images->height ? images->width : 0;
    return (left && right && coarse_is_bent(at[-1], at[0], at[1])) ||
           (up && down && coarse_is_bent(*(at - up), at[0], at[down]));
}

static inline void measure_pixel(const struct kiln_coarse_rows *m, uint32_t x, uint32_t y)
{
    const struct kiln_coarse_images *images = m->images;
    const struct range columns = pixels_of(x, images->beyond_x, images->factor, images->width);
    const struct range rows = pixels_of(y, images->beyond_y, images->factor, images->height);
    const float *first = m->depth + (size_t)rows.from * images->width + columns.from;
    float farthest = *first;
    bool bent = false;
    for (uint32_t j = rows.from; j < rows.to; j++) {
        for (uint32_t i = columns.from; i < columns.to; i++) {
            float depth = m->depth[(size_t)j * images->width + i];
            farthest = depth > farthest ? depth : farthest;
            bent = bent || is_bent(images, m->depth, i, j);
        }
    }
    size_t at = (size_t)y * images->depth.width + x;
    m->coarse_depth[at] = farthest;
    m->bent[at] = bent;
}

static void measure_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_coarse_rows *m = context;
    for (size_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < m->images->depth.width; x++)
            measure_pixel(m, x, (uint32_t)y);
    }
}

static inline float edge_at(const struct kiln_coarse_rows *m, uint32_t x, uint32_t y)
{
    const uint32_t width = m->images->depth.width;
    const uint32_t height = m->images->depth.height;
    bool bent = false;
    for (uint32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; j++) {
        for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; i++)
            bent = bent || m->bent[(size_t)j * width + i];
    }
    return bent ? 1.0f : 0.0f;
}

static void find_edges(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_coarse_rows *m = context;
    const uint32_t width = m->images->depth.width;
    for (size_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < width; x++)
            m->edges[y * width + x] = edge_at(m, x, (uint32_t)y);
    }
}

/* How much of a pixel is drawn finely: 1 near an edge, falling to 0 over a coarse pixel. */
static inline float fine_part(const float *above, const float *below,
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
            float part = fine_part(above, below, &m->columns[x], row.part);
            m->fine_depth[y * images->width + x] =
                part > 0.0f ? m->depth[y * images->width + x] : 0.0f;
        }
    }
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Between the middle two of four by their spline, which must not overshoot. */
static inline quad interpolate(quad before, quad low, quad high, quad after, const float weights[4])
{
    quad sum = (before * weights[0] + low * weights[1]) + (high * weights[2] + after * weights[3]);
    return least(most(sum, least(low, high)), most(low, high));
}

/* Four coarse rows mixed. */
static inline void mix_rows(const struct kiln_coarse_rows *s, const struct kiln_coarse_place *row,
                            struct kiln_coarse_shown *mixed)
{
    const size_t width = s->images->depth.width;
    const float *colors[4], *blooms[4];
    for (int i = 0; i < 4; i++) {
        colors[i] = s->coarse_color + 4 * width * (size_t)row->taps[i];
        blooms[i] = s->coarse_bloom + 4 * width * (size_t)row->taps[i];
    }
    for (size_t x = 0; x < width; x++) {
        mixed[x].color =
            interpolate(load(colors[0] + 4 * x), load(colors[1] + 4 * x), load(colors[2] + 4 * x),
                        load(colors[3] + 4 * x), row->weights);
        mixed[x].bloom =
            interpolate(load(blooms[0] + 4 * x), load(blooms[1] + 4 * x), load(blooms[2] + 4 * x),
                        load(blooms[3] + 4 * x), row->weights);
    }
}

/* By depth: of the coarse pixel that it lies in and those around. */
static inline struct kiln_coarse_shown choose(const struct kiln_coarse_rows *s,
                                              const struct kiln_coarse_place *x,
                                              const struct kiln_coarse_place *y, float depth)
{
    const int32_t width = (int32_t)s->images->depth.width;
    const int32_t height = (int32_t)s->images->depth.height;
    struct kiln_coarse_shown sum = {{0}, {0}};
    float weights = 0.0f;
    for (int32_t j = -1; j <= 1; j++) {
        int32_t row = y->own + j;
        if (row < 0 || row >= height)
            continue;
        float down = coarse_near(y->at - (float)row);
        for (int32_t i = -1; i <= 1; i++) {
            int32_t column = x->own + i;
            if (column < 0 || column >= width)
                continue;
            size_t at = (size_t)row * (size_t)width + (size_t)column;
            float weight = down * coarse_near(x->at - (float)column) *
                           coarse_alike(depth, s->coarse_depth[at]);
            sum.color += load(s->coarse_color + 4 * at) * weight;
            sum.bloom += load(s->coarse_bloom + 4 * at) * weight;
            weights += weight;
        }
    }
    sum.color /= weights;
    sum.bloom /= weights;
    return sum;
}

static inline void spread_row(const struct kiln_coarse_rows *s, uint32_t y,
                              struct kiln_coarse_shown *mixed)
{
    const struct kiln_coarse_images *images = s->images;
    const size_t coarse_width = images->depth.width;
    const struct kiln_coarse_place row = s->rows[y];
    const float *own = s->edges + (size_t)row.own * coarse_width;
    const float *above = s->edges + (size_t)row.taps[1] * coarse_width;
    const float *below = s->edges + (size_t)row.taps[2] * coarse_width;
    mix_rows(s, &row, mixed);
    for (uint32_t x = 0; x < images->width; x++) {
        const struct kiln_coarse_place *column = &s->columns[x];
        size_t at = (size_t)y * images->width + x;
        const struct kiln_coarse_shown *taps[4];
        for (int i = 0; i < 4; i++)
            taps[i] = &mixed[column->taps[i]];
        struct kiln_coarse_shown shown = {
            interpolate(taps[0]->color, taps[1]->color, taps[2]->color, taps[3]->color,
                        column->weights),
            interpolate(taps[0]->bloom, taps[1]->bloom, taps[2]->bloom, taps[3]->bloom,
                        column->weights)};
        if (own[column->own] > 0.0f)
            shown = choose(s, column, &row, s->depth[at]);
        float fine = s->fine_color ? fine_part(above, below, column, row.part) : 0.0f;
        if (fine > 0.0f) {
            shown.color += (load(s->fine_color + 4 * at) - shown.color) * fine;
            shown.bloom += (load(s->fine_bloom + 4 * at) - shown.bloom) * fine;
        }
        store(s->color + 4 * at, shown.color);
        if (!s->bloom)
            continue;
        if (s->keep_bloom)
            shown.bloom += load(s->bloom + 4 * at) * (1.0f - shown.color[3] * s->over);
        store(s->bloom + 4 * at, shown.bloom);
    }
}

static void spread_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct kiln_coarse_rows *s = context;
    struct kiln_coarse_shown *mixed = s->mixed + worker * (size_t)s->images->depth.width;
    for (size_t y = begin; y < end; y++)
        spread_row(s, (uint32_t)y, mixed);
}

const struct kiln_coarse_loops KILN_SIMD_NAME(kiln_coarse_loops) = {
    .measure = measure_rows,
    .find_edges = find_edges,
    .mask = mask_rows,
    .spread = spread_rows,
};
