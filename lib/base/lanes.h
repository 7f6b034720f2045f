/* This header defines vectors of floats for code on the host, by the level that a file is compiled
 * for (base/simd.h). Level plain uses SSE2 on x86-64, and on other processors only what C has.
 * Every operation gives the same bits at all levels; a port to another processor starts from level
 * plain.
 */
#ifndef KILN_BASE_LANES_H
#define KILN_BASE_LANES_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined KILN_LEVEL_AVX512
#define LANES 16
#elif defined KILN_LEVEL_AVX2
#define LANES 8
#else
#define LANES 4
#endif
#ifdef KILN_LEVEL_NEON
#include <arm_neon.h>
#elif defined KILN_LEVEL_AVX2 || defined KILN_LEVEL_AVX512
#include <immintrin.h>
#elif defined __SSE2__
#include <emmintrin.h>
#endif

#define SIMD static inline __attribute__((always_inline))
/* For large functions that are called seldom or from several places. Their code exists once, so
 * that it compiles faster. Not every file that includes their header calls them. */
#define SIMD_ONCE static __attribute__((noinline, unused))

typedef float vf __attribute__((vector_size(4 * LANES)));
typedef int32_t vi __attribute__((vector_size(4 * LANES)));
typedef uint32_t vu __attribute__((vector_size(4 * LANES))); /* for sums that may wrap */
typedef float vf_unaligned __attribute__((vector_size(4 * LANES), aligned(4), may_alias));

SIMD vf vf_all(float x)
{
    return x - (vf){0};
}

SIMD vf vf_load(const float *from)
{
    return *(const vf_unaligned *)from;
}

SIMD vi vi_load(const int32_t *from)
{
    vi x;
    memcpy(&x, from, sizeof x);
    return x;
}

SIMD void vf_store(float *to, vf x)
{
    *(vf_unaligned *)to = x;
}

/* Returns 0, 1, 2... in the lanes. */
SIMD vf vf_count(void)
{
    static const float numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return vf_load(numbers);
}

/* Returns x in the lanes where the mask is set, 0 elsewhere. A lane of a mask has all bits set, or
 * none. */
SIMD vf vf_where(vi mask, vf x)
{
    return (vf)((vi)x & mask);
}

SIMD vf vf_abs(vf x)
{
    return (vf)((vi)x & 0x7fffffff);
}

#if defined KILN_LEVEL_AVX512
SIMD vf vf_min(vf a, vf b)
{
    return (vf)_mm512_min_ps((__m512)a, (__m512)b);
}
SIMD vf vf_max(vf a, vf b)
{
    return (vf)_mm512_max_ps((__m512)a, (__m512)b);
}
SIMD vf vf_sqrt(vf a)
{
    return (vf)_mm512_sqrt_ps((__m512)a);
}
#elif defined KILN_LEVEL_AVX2
SIMD vf vf_min(vf a, vf b)
{
    return (vf)_mm256_min_ps((__m256)a, (__m256)b);
}
SIMD vf vf_max(vf a, vf b)
{
    return (vf)_mm256_max_ps((__m256)a, (__m256)b);
}
SIMD vf vf_sqrt(vf a)
{
    return (vf)_mm256_sqrt_ps((__m256)a);
}
#elif defined __SSE2__
SIMD vf vf_min(vf a, vf b)
{
    return (vf)_mm_min_ps((__m128)a, (__m128)b);
}
SIMD vf vf_max(vf a, vf b)
{
    return (vf)_mm_max_ps((__m128)a, (__m128)b);
}
SIMD vf vf_sqrt(vf a)
{
    return (vf)_mm_sqrt_ps((__m128)a);
}
#else
/* Returns the second operand where the two are equal or one is NaN, as x86 does; NEON's own minimum
 * and maximum would be NaN where either operand is. */
SIMD vf vf_min(vf a, vf b)
{
    vi less = a < b;
    return (vf)(((vi)a & less) | ((vi)b & ~less));
}

SIMD vf vf_max(vf a, vf b)
{
    vi more = a > b;
    return (vf)(((vi)a & more) | ((vi)b & ~more));
}

SIMD vf vf_sqrt(vf a)
{
#ifdef KILN_LEVEL_NEON
    return (vf)vsqrtq_f32((float32x4_t)a);
#else
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
#endif
}
#endif

/* Converts to integers, rounding towards zero. NaN and values beyond 2^31 become the least integer,
 * as on x86; other processors would give the nearest integer, and 0 for NaN. */
SIMD vi vi_of(vf x)
{
#ifdef __x86_64__
    return __builtin_convertvector(x, vi);
#else
    vi within = vf_abs(x) < 0x1p31f;
    return (__builtin_convertvector(vf_where(within, x), vi) & within) | (INT32_MIN & ~within);
#endif
}

/* Returns a bit for each lane of a mask, lane 0 in the lowest. */
SIMD uint32_t vi_bits(vi mask)
{
#if defined KILN_LEVEL_AVX512
    return _mm512_movepi32_mask((__m512i)mask);
#elif defined KILN_LEVEL_AVX2
    return (uint32_t)_mm256_movemask_ps((__m256)mask);
#elif defined __SSE2__
    return (uint32_t)_mm_movemask_ps((__m128)mask);
#elif defined KILN_LEVEL_NEON
    const uint32x4_t bits = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32((uint32x4_t)mask, bits));
#else
    return ((uint32_t)mask[0] & 1) | ((uint32_t)mask[1] & 2) | ((uint32_t)mask[2] & 4) |
           ((uint32_t)mask[3] & 8);
#endif
}

SIMD vf vf_clamp01(vf x)
{
    return vf_min(vf_max(x, vf_all(0.0f)), vf_all(1.0f));
}

/* A unit is 8 pixels side by side in a row. A vector holds UNITS whole units, which may lie apart,
 * or one of the UNIT_PARTS parts of a unit. */
enum {
    UNIT = 8,
    UNITS = LANES > UNIT ? LANES / UNIT : 1,
    UNIT_PARTS = UNIT > LANES ? UNIT / LANES : 1
};

/* Returns the number, 0 to 7, of each lane's pixel in its unit. part: number of the unit's part. */
SIMD vf vf_units_count(int part)
{
    static const float numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
    return vf_load(numbers + (size_t)part * LANES);
}

/* Returns the number of each lane's unit in the vector: 0 or 1. */
SIMD vf vf_units_number(void)
{
    static const float numbers[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    return vf_load(numbers);
}

#if defined KILN_LEVEL_AVX512

/* Returns a vector with one value for each unit, the same in all of its lanes. */
SIMD vf vf_units(const float *from)
{
    return (vf)_mm512_insertf32x8(_mm512_set1_ps(from[0]), _mm256_set1_ps(from[1]), 1);
}

/* Loads each unit from its place. at: offsets of the units from `from`, in floats. */
SIMD vf vf_load_units(const float *from, const int32_t *at)
{
    return (vf)_mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(from + at[0])),
                                  _mm256_loadu_ps(from + at[1]), 1);
}

SIMD void vf_store_units(float *to, const int32_t *at, vf x)
{
    _mm256_storeu_ps(to + at[0], _mm512_castps512_ps256((__m512)x));
    _mm256_storeu_ps(to + at[1], _mm512_extractf32x8_ps((__m512)x, 1));
}

#else

SIMD vf vf_units(const float *from)
{
    return vf_all(from[0]);
}

SIMD vf vf_load_units(const float *from, const int32_t *at)
{
    return vf_load(from + at[0]);
}

SIMD void vf_store_units(float *to, const int32_t *at, vf x)
{
    vf_store(to + at[0], x);
}

#endif

#endif
