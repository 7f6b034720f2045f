/* This header enlarges rows of the glow by a cubic B-spline, for files *_simd.c: it filters the
 * columns of the small picture once for each row of the frame, then filters along that row. */
#ifndef KILN_POST_MAGNIFY_ROW_H
#define KILN_POST_MAGNIFY_ROW_H

#include "base/transpose.h"
#include "post/magnify.h"

/* Describes the rows of the glow around a row of the frame. */
struct magnified_rows {
    const float *from[4]; /* RGBA */
    float weights[4], strength;
};

/* Returns the glow of a vector of floats of the small picture, from float i of its rows on. */
SIMD vf magnify_floats(const struct magnified_rows *rows, size_t i)
{
    const float *w = rows->weights;
    const vf sum = (vf_load(rows->from[0] + i) * w[0] + vf_load(rows->from[1] + i) * w[1]) +
                   (vf_load(rows->from[2] + i) * w[2] + vf_load(rows->from[3] + i) * w[3]);
    return sum * rows->strength;
}

static inline float magnify_float(const struct magnified_rows *rows, size_t i)
{
    const float *const *from = rows->from, *w = rows->weights;
    return ((from[0][i] * w[0] + from[1][i] * w[1]) + (from[2][i] * w[2] + from[3][i] * w[3])) *
           rows->strength;
}

/* Returns the glow filtered vertically for row y of the frame, times a strength: a plane for each
 * colour, valid until the next call with the same worker. */
static const float *magnify_row(const struct kiln_magnifier *m, const float *glow, uint32_t y,
                                float strength, uint32_t worker)
{
    struct magnified_rows rows = {.strength = strength};
    const int32_t first = kiln_magnify_taps(y, m->scale, rows.weights);
    const int32_t last = (int32_t)m->small_height - 1;
    for (int k = 0; k < 4; k++) {
        const int32_t line = first + k < 0 ? 0 : first + k > last ? last : first + k;
        rows.from[k] = glow + (size_t)line * m->small_width * 4;
    }
    const size_t width = m->small_width, whole = width - width % LANES;
    float *const planes = m->planes + 3 * m->plane_floats * worker;
    for (size_t x = 0; x < whole; x += LANES) {
        const size_t at = 4 * x, lanes = LANES;
        const struct columns c = columns_transpose(
            magnify_floats(&rows, at), magnify_floats(&rows, at + lanes),
            magnify_floats(&rows, at + 2 * lanes), magnify_floats(&rows, at + 3 * lanes));
        for (size_t k = 0; k < 3; k++)
            vf_store(planes + k * m->plane_floats + KILN_MAGNIFY_EDGE + x, row_order(c.c[k]));
    }
    for (size_t k = 0; k < 3; k++) {
        float *plane = planes + k * m->plane_floats + KILN_MAGNIFY_EDGE;
        for (size_t x = whole; x < width; x++)
            plane[x] = magnify_float(&rows, 4 * x + k);
        for (int i = 1; i <= KILN_MAGNIFY_EDGE; i++) {
            plane[-i] = plane[0];
            plane[width - 1 + (size_t)i] = plane[width - 1];
        }
    }
    return planes;
}

/* Returns from[index] of each lane, for 0 <= index; where `near` is true, index < LANES. */
SIMD vf magnify_pick(const float *from, vi index, bool near)
{
#if defined KILN_LEVEL_AVX512
    if (near)
        return (vf)_mm512_permutexvar_ps((__m512i)index, (__m512)vf_load(from));
#elif defined KILN_LEVEL_AVX2
    if (near)
        return (vf)_mm256_permutevar8x32_ps((__m256)vf_load(from), (__m256i)index);
#endif
    (void)near;
    return vf_gather(from, index);
}

/* Returns the glow at a vector of pixels from column x on. planes: of
 * magnify_row. */
SIMD struct vf3 magnified(const struct kiln_magnifier *m, const float *planes, uint32_t x)
{
    const int32_t base = m->first[x];
    const float *from[3];
    for (size_t c = 0; c < 3; c++)
        from[c] = planes + c * m->plane_floats + base;
    const vi index = (vi)vf_load((const float *)(const void *)(m->first + x)) - base;
    vf sums[2][3];
    for (int pair = 0; pair < 2; pair++) {
        const int k = 2 * pair;
        const vf a = vf_load(m->weights[k] + x), b = vf_load(m->weights[k + 1] + x);
        for (int c = 0; c < 3; c++)
            sums[pair][c] = magnify_pick(from[c], index + k, m->near) * a +
                            magnify_pick(from[c], index + (k + 1), m->near) * b;
    }
    return (struct vf3){sums[0][0] + sums[1][0], sums[0][1] + sums[1][1], sums[0][2] + sums[1][2]};
}

#endif
