/* Defines groups of eight floats, such as a row of cells of a brick of gas, as one vector or two. A
 * vector has at most 8 lanes, also at level avx512. A file includes this header before all that
 * includes base/lanes.h. */
#ifndef KILN_BASE_EIGHT_H
#define KILN_BASE_EIGHT_H

#ifdef KILN_BASE_LANES_H
#error "base/lanes.h was included before base/eight.h"
#endif
#ifdef KILN_LEVEL_AVX512
#undef KILN_LEVEL_AVX512
#define KILN_LEVEL_AVX2
#endif
#include "base/transpose.h"

/* Vectors that eight floats take. */
enum { EIGHT_PARTS = 8 / LANES };

/* Holds eight floats. */
struct eight {
    vf part[EIGHT_PARTS];
};

#define EIGHT_EACH(k) for (int k = 0; k < EIGHT_PARTS; k++)

SIMD struct eight eight_load(const float *from)
{
    struct eight x;
    EIGHT_EACH(k)
    x.part[k] = vf_load(from + (ptrdiff_t)k * LANES);
    return x;
}

SIMD void eight_store(float *to, struct eight x)
{
    EIGHT_EACH(k)
    vf_store(to + (ptrdiff_t)k * LANES, x.part[k]);
}

/* Transposes 64 floats: eight floats of each of eight cells, which lie one after another, become a
 * group of eight for each float, in the order of the cells. */
SIMD void eight_columns(const float *cells, struct eight columns[8])
{
#if LANES == 8
    __m256 a[8], b[8];
    for (ptrdiff_t i = 0; i < 8; i++)
        a[i] = _mm256_loadu_ps(cells + 8 * i);
    for (ptrdiff_t i = 0; i < 8; i += 2) {
        b[i] = _mm256_unpacklo_ps(a[i], a[i + 1]);
        b[i + 1] = _mm256_unpackhi_ps(a[i], a[i + 1]);
    }
    for (ptrdiff_t i = 0; i < 8; i += 4) {
        a[i] = _mm256_shuffle_ps(b[i], b[i + 2], 0x44);
        a[i + 1] = _mm256_shuffle_ps(b[i], b[i + 2], 0xee);
        a[i + 2] = _mm256_shuffle_ps(b[i + 1], b[i + 3], 0x44);
        a[i + 3] = _mm256_shuffle_ps(b[i + 1], b[i + 3], 0xee);
    }
    for (ptrdiff_t i = 0; i < 4; i++) {
        columns[i].part[0] = (vf)_mm256_permute2f128_ps(a[i], a[i + 4], 0x20);
        columns[i + 4].part[0] = (vf)_mm256_permute2f128_ps(a[i], a[i + 4], 0x31);
    }
#else
    for (ptrdiff_t half = 0; half < 2; half++)
        EIGHT_EACH(k)
        {
            const float *at = cells + (ptrdiff_t)32 * k + 4 * half;
            const struct columns four =
                columns_transpose(vf_load(at), vf_load(at + 8), vf_load(at + 16), vf_load(at + 24));
            for (ptrdiff_t i = 0; i < 4; i++)
                columns[4 * half + i].part[k] = four.c[i];
        }
#endif
}

/* Is the inverse of eight_columns. */
SIMD void eight_rows(float *cells, const struct eight columns[8])
{
#if LANES == 8
    __m256 a[8], b[8];
    for (ptrdiff_t i = 0; i < 8; i++)
        a[i] = (__m256)columns[i].part[0];
    for (ptrdiff_t i = 0; i < 8; i += 2) {
        b[i] = _mm256_unpacklo_ps(a[i], a[i + 1]);
        b[i + 1] = _mm256_unpackhi_ps(a[i], a[i + 1]);
    }
    for (ptrdiff_t i = 0; i < 8; i += 4) {
        a[i] = _mm256_shuffle_ps(b[i], b[i + 2], 0x44);
        a[i + 1] = _mm256_shuffle_ps(b[i], b[i + 2], 0xee);
        a[i + 2] = _mm256_shuffle_ps(b[i + 1], b[i + 3], 0x44);
        a[i + 3] = _mm256_shuffle_ps(b[i + 1], b[i + 3], 0xee);
    }
    for (ptrdiff_t i = 0; i < 4; i++) {
        _mm256_storeu_ps(cells + 8 * i, _mm256_permute2f128_ps(a[i], a[i + 4], 0x20));
        _mm256_storeu_ps(cells + 8 * (i + 4), _mm256_permute2f128_ps(a[i], a[i + 4], 0x31));
    }
#else
    for (ptrdiff_t half = 0; half < 2; half++)
        EIGHT_EACH(k)
        {
            float *at = cells + (ptrdiff_t)32 * k + 4 * half;
            const struct columns four =
                columns_transpose(columns[4 * half].part[k], columns[4 * half + 1].part[k],
                                  columns[4 * half + 2].part[k], columns[4 * half + 3].part[k]);
            for (ptrdiff_t i = 0; i < 4; i++)
                vf_store(at + 8 * i, four.c[i]);
        }
#endif
}

#endif
