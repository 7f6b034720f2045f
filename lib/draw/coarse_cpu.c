/* Threads over rows. Where the scene is smooth, a pixel of the frame is interpolated by a spline
 * from the sixteen coarse ones around it; near edges it takes those of nine that have a depth like
 * its own, however far their places.
 */
#include "draw/coarse_cpu.h"

#include "base/error.h"
#include "base/vector.h"
#include "shared/coarse.h"

#include <stdlib.h>
#include <string.h>

enum { ROWS_AT_A_TIME = 4 };

typedef float quad __attribute__((vector_size(16)));
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

/* What shows in one place. */
struct shown {
    quad color, bloom;
};

/* Where a row or a column of the frame lies among coarse ones. */
struct place {
    int32_t taps[4];  /* two before it, two after it; beyond the edge, the edge's */
    float weights[4]; /* of a cubic spline through them */
    float part;       /* on the way from the second to the third */
    int32_t own;      /* the one that it lies in */
    float at;         /* its place; whole numbers are the middles of coarse pixels */
};

struct kiln_coarse_cpu {
    struct kiln_coarse_images *images;
    struct kiln_threads *threads;
    struct place *columns; /* of the frame */
    uint8_t *bent;         /* 1 where a coarse pixel's depth is not that of a plane */
    struct shown *rows;    /* a coarse row for each thread */
};

static int32_t limit(int32_t index, uint32_t count)
{
    return index < 0 ? 0 : index < (int32_t)count ? index : (int32_t)count - 1;
}

static struct place find_place(uint32_t pixel, float beyond, uint32_t factor, uint32_t count)
{
    struct place place = {.at = ((float)pixel + 0.5f + beyond) / (float)factor - 0.5f};
    int32_t low = (int32_t)(place.at + 1.0f) - 1; /* floor: it is beyond -1 */
    place.part = place.at - (float)low;
    place.own = limit(place.part < 0.5f ? low : low + 1, count);
    const float4 weights = coarse_spline(place.part);
    memcpy(place.weights, &weights, sizeof place.weights);
    for (int32_t i = 0; i < 4; i++)
        place.taps[i] = limit(low - 1 + i, count);
    return place;
}

struct kiln_coarse_cpu *kiln_coarse_cpu_create(struct kiln_coarse_images *images,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    struct kiln_coarse_cpu *coarse = calloc(1, sizeof *coarse);
    const uint32_t width = images->depth.width;
    const size_t pixels = (size_t)width * images->depth.height;
    if (coarse) {
        *coarse = (struct kiln_coarse_cpu){.images = images, .threads = threads};
        coarse->columns = calloc(images->width, sizeof *coarse->columns);
        coarse->bent = calloc(pixels, sizeof *coarse->bent);
        coarse->rows =
            aligned_alloc(16, (size_t)width * kiln_threads_count(threads) * sizeof *coarse->rows);
    }
    if (!coarse || !coarse->columns || !coarse->bent || !coarse->rows) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "coarse particles: out of memory");
        kiln_coarse_cpu_destroy(&coarse);
        return NULL;
    }
    for (uint32_t x = 0; x < images->width; x++)
        coarse->columns[x] = find_place(x, images->beyond_x, images->factor, width);
    return coarse;
}

void kiln_coarse_cpu_destroy(struct kiln_coarse_cpu **coarse)
{
    struct kiln_coarse_cpu *c = *coarse;
    if (!c)
        return;
    free(c->columns);
    free(c->bent);
    free(c->rows);
    free(c);
    *coarse = NULL;
}

/* ---- depth ----------------------------------------------------------------------------------- */

struct measuring {
    struct kiln_coarse_cpu *coarse;
    const float *depth; /* of the frame */
    float *farthest, *edges, *fine;
};

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

static inline void measure_pixel(const struct measuring *m, uint32_t x, uint32_t y)
{
    const struct kiln_coarse_images *images = m->coarse->images;
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
    m->farthest[at] = farthest;
    m->coarse->bent[at] = bent;
}

KILN_WIDE_VECTORS
static void measure_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct measuring *m = context;
    for (size_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < m->coarse->images->depth.width; x++)
            measure_pixel(m, x, (uint32_t)y);
    }
}

static inline float edge_at(const struct measuring *m, uint32_t x, uint32_t y)
{
    const uint32_t width = m->coarse->images->depth.width;
    const uint32_t height = m->coarse->images->depth.height;
    bool bent = false;
    for (uint32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; j++) {
        for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; i++)
            bent = bent || m->coarse->bent[(size_t)j * width + i];
    }
    return bent ? 1.0f : 0.0f;
}

KILN_WIDE_VECTORS
static void find_edges(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct measuring *m = context;
    const uint32_t width = m->coarse->images->depth.width;
    for (size_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < width; x++)
            m->edges[y * width + x] = edge_at(m, x, (uint32_t)y);
    }
}

/* How much of a pixel is drawn finely: 1 near an edge, falling to 0 over a coarse pixel. */
static inline float fine_part(const float *above, const float *below, const struct place *x,
                              float down)
{
    float left = above[x->taps[1]] + (below[x->taps[1]] - above[x->taps[1]]) * down;
    float right = above[x->taps[2]] + (below[x->taps[2]] - above[x->taps[2]]) * down;
    return left + (right - left) * x->part;
}

KILN_WIDE_VECTORS
static void mask_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct measuring *m = context;
    const struct kiln_coarse_images *images = m->coarse->images;
    for (size_t y = begin; y < end; y++) {
        const struct place row =
            find_place((uint32_t)y, images->beyond_y, images->factor, images->depth.height);
        const float *above = m->edges + (size_t)row.taps[1] * images->depth.width;
        const float *below = m->edges + (size_t)row.taps[2] * images->depth.width;
        for (size_t x = 0; x < images->width; x++) {
            float part = fine_part(above, below, &m->coarse->columns[x], row.part);
            m->fine[y * images->width + x] = part > 0.0f ? m->depth[y * images->width + x] : 0.0f;
        }
    }
}

bool kiln_coarse_cpu_measure(struct kiln_coarse_cpu *coarse, struct kiln_image *depth,
                             struct kiln_error *error)
{
    struct kiln_coarse_images *images = coarse->images;
    struct measuring m = {.coarse = coarse, .depth = kiln_image_host(depth, KILN_READ, error)};
    m.farthest = m.depth ? kiln_image_host(&images->depth, KILN_OVERWRITE, error) : NULL;
    m.edges = m.farthest ? kiln_image_host(&images->edges, KILN_OVERWRITE, error) : NULL;
    if (!m.edges)
        return false;
    kiln_threads_for(coarse->threads, images->depth.height, ROWS_AT_A_TIME, measure_rows, &m);
    kiln_threads_for(coarse->threads, images->depth.height, ROWS_AT_A_TIME, find_edges, &m);
    if (!images->mixed)
        return true;
    m.fine = kiln_image_host(&images->fine_depth, KILN_OVERWRITE, error);
    if (m.fine)
        kiln_threads_for(coarse->threads, images->height, ROWS_AT_A_TIME, mask_rows, &m);
    return m.fine != NULL;
}

/* ---- pictures -------------------------------------------------------------------------------- */

struct spreading {
    struct kiln_coarse_cpu *coarse;
    const float *depth, *coarse_depth, *edges; /* m; m; 0 or 1 */
    const float *coarse_color, *coarse_bloom, *fine_color, *fine_bloom;
    float *color, *bloom;
    bool keep_bloom;
    float over; /* 1: what covers hides an earlier pass's bloom; 0: it is added to */
};

/* Between the middle two of four by their spline, which must not overshoot. */
static inline quad interpolate(quad before, quad low, quad high, quad after, const float weights[4])
{
    quad sum = (before * weights[0] + low * weights[1]) + (high * weights[2] + after * weights[3]);
    return least(most(sum, least(low, high)), most(low, high));
}

/* Four coarse rows mixed. */
static inline void mix_rows(const struct spreading *s, const struct place *row, struct shown *mixed)
{
    const size_t width = s->coarse->images->depth.width;
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
static inline struct shown choose(const struct spreading *s, const struct place *x,
                                  const struct place *y, float depth)
{
    const int32_t width = (int32_t)s->coarse->images->depth.width;
    const int32_t height = (int32_t)s->coarse->images->depth.height;
    struct shown sum = {{0}, {0}};
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

static inline void spread_row(const struct spreading *s, uint32_t y, struct shown *mixed)
{
    const struct kiln_coarse_images *images = s->coarse->images;
    const size_t coarse_width = images->depth.width;
    const struct place row = find_place(y, images->beyond_y, images->factor, images->depth.height);
    const float *own = s->edges + (size_t)row.own * coarse_width;
    const float *above = s->edges + (size_t)row.taps[1] * coarse_width;
    const float *below = s->edges + (size_t)row.taps[2] * coarse_width;
    mix_rows(s, &row, mixed);
    for (uint32_t x = 0; x < images->width; x++) {
        const struct place *column = &s->coarse->columns[x];
        size_t at = (size_t)y * images->width + x;
        const struct shown *taps[4];
        for (int i = 0; i < 4; i++)
            taps[i] = &mixed[column->taps[i]];
        struct shown shown = {interpolate(taps[0]->color, taps[1]->color, taps[2]->color,
                                          taps[3]->color, column->weights),
                              interpolate(taps[0]->bloom, taps[1]->bloom, taps[2]->bloom,
                                          taps[3]->bloom, column->weights)};
        if (own[column->own] > 0.0f)
            shown = choose(s, column, &row, s->depth[at]);
        float fine = s->fine_color ? fine_part(above, below, column, row.part) : 0.0f;
        if (fine > 0.0f) {
            shown.color += (load(s->fine_color + 4 * at) - shown.color) * fine;
            shown.bloom += (load(s->fine_bloom + 4 * at) - shown.bloom) * fine;
        }
        if (s->keep_bloom)
            shown.bloom += load(s->bloom + 4 * at) * (1.0f - shown.color[3] * s->over);
        store(s->color + 4 * at, shown.color);
        store(s->bloom + 4 * at, shown.bloom);
    }
}

KILN_WIDE_VECTORS
static void spread_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct spreading *s = context;
    struct shown *mixed = s->coarse->rows + worker * (size_t)s->coarse->images->depth.width;
    for (size_t y = begin; y < end; y++)
        spread_row(s, (uint32_t)y, mixed);
}

/* False when one of the images cannot be had. */
static bool open_images(struct kiln_coarse_images *images, struct kiln_image *depth,
                        struct spreading *s, struct kiln_error *error)
{
    struct reading {
        struct kiln_image *image;
        const float **pixels;
    };
    const struct reading readings[] = {
        {depth, &s->depth},
        {&images->depth, &s->coarse_depth},
        {&images->edges, &s->edges},
        {&images->color, &s->coarse_color},
        {&images->bloom, &s->coarse_bloom},
        {&images->fine_color, &s->fine_color},
        {&images->fine_bloom, &s->fine_bloom},
    };
    size_t count = sizeof readings / sizeof *readings;
    for (size_t i = 0; i < (images->mixed ? count : count - 2); i++) {
        *readings[i].pixels = kiln_image_host(readings[i].image, KILN_READ, error);
        if (!*readings[i].pixels)
            return false;
    }
    return true;
}

bool kiln_coarse_cpu_spread(struct kiln_coarse_cpu *coarse, const struct kiln_coarse_blend *blend,
                            struct kiln_image *depth, struct kiln_error *error)
{
    struct spreading s = {
        .coarse = coarse, .keep_bloom = blend->keep_bloom, .over = blend->sum_alpha ? 0.0f : 1.0f};
    if (!open_images(coarse->images, depth, &s, error))
        return false;
    s.color = kiln_image_host(blend->target->images[0], KILN_OVERWRITE, error);
    if (s.color)
        s.bloom = kiln_image_host(blend->target->images[1],
                                  blend->keep_bloom ? KILN_READ_WRITE : KILN_OVERWRITE, error);
    if (!s.bloom)
        return false;
    kiln_threads_for(coarse->threads, coarse->images->height, ROWS_AT_A_TIME, spread_rows, &s);
    return true;
}
