/* Vectors of floats for the tiles of the CPU rasteriser, by what a file is compiled for:
 * KILN_SIMD_LEVEL is 0 (any machine), 1 (SSE4.1), 2 (AVX2) or 3 (AVX-512 with BW). Every operation
 * rounds the same at all levels; a port to another processor starts from level 0.
 */
#ifndef KILN_DRAW_SIMD_H
#define KILN_DRAW_SIMD_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if KILN_SIMD_LEVEL == 3
#define LANES 16
#elif KILN_SIMD_LEVEL == 2
#define LANES 8
#else
#define LANES 4
#endif
#if KILN_SIMD_LEVEL > 0
#include <immintrin.h>
#endif

#define SIMD static inline __attribute__((always_inline))

typedef float vf __attribute__((vector_size(4 * LANES)));
typedef int32_t vi __attribute__((vector_size(4 * LANES)));
typedef float vf_unaligned __attribute__((vector_size(4 * LANES), aligned(4), may_alias));

SIMD vf vf_all(float x)
{
    return x - (vf){0};
}

SIMD vf vf_load(const float *from)
{
    return *(const vf_unaligned *)from;
}

SIMD void vf_store(float *to, vf x)
{
    *(vf_unaligned *)to = x;
}

/* 0, 1, 2... */
SIMD vf vf_count(void)
{
    static const float numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return vf_load(numbers);
}

/* x where the mask (all bits or none) is set, 0 elsewhere. */
SIMD vf vf_where(vi mask, vf x)
{
    return (vf)((vi)x & mask);
}

SIMD vf vf_abs(vf x)
{
    return (vf)((vi)x & 0x7fffffff);
}

#if KILN_SIMD_LEVEL == 3
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
#elif KILN_SIMD_LEVEL == 2
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
#elif KILN_SIMD_LEVEL == 1
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
/* The second operand where neither is less, as x86 has it. */
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
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
}
#endif

SIMD vf vf_clamp01(vf x)
{
    return vf_min(vf_max(x, vf_all(0.0f)), vf_all(1.0f));
}

/* Four channels. */
struct vf4 {
    vf c[4];
};

/* What a fetched channel of 1 is. */
#define FETCHED_ONE (127.0f * 255.0f)

/* Bilinear samples of an RGBA8 cell. offset: in texels, of the upper left one of four; right,
 * down: the weights of the right and the lower ones, 0 to 127 and 0 to 32767. The arithmetic is
 * that of integers: sums of bytes times 7 bits, then a product rounded from 15 bits.
 */
#if KILN_SIMD_LEVEL == 3

/* The texels of 8 pixels, left and right interleaved by channel. */
SIMD __m512i fetch_pairs(const uint8_t *cell, __m256i offset)
{
    const __m512i interleave = _mm512_set4_epi32(0x0f0b0e0a, 0x0d090c08, 0x07030602, 0x05010400);
    return _mm512_shuffle_epi8(_mm512_i32gather_epi64(offset, cell, 4), interleave);
}

/* 16-bit channels of 8 pixels. */
SIMD __m512i fetch_half(const uint8_t *cell, uint32_t pitch, __m256i offset, __m256i right,
                        __m256i down)
{
    const __m512i spread = _mm512_set4_epi32(0x09080908, 0x09080908, 0x01000100, 0x01000100);
    __m512i across = _mm512_shuffle_epi8(_mm512_cvtepu32_epi64(right), spread);
    __m512i along = _mm512_shuffle_epi8(_mm512_cvtepu32_epi64(down), spread);
    __m512i top = _mm512_maddubs_epi16(fetch_pairs(cell, offset), across);
    __m512i bottom = _mm512_maddubs_epi16(fetch_pairs(cell + 4 * (size_t)pitch, offset), across);
    return _mm512_add_epi16(top, _mm512_mulhrs_epi16(_mm512_sub_epi16(bottom, top), along));
}

SIMD struct vf4 vf_fetch(const uint8_t *cell, uint32_t pitch, vi offset, vi right, vi down)
{
    const __m512i even =
        _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const __m512i odd =
        _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
    const __m512i low = _mm512_set1_epi32(0xffff);
    __m512i weights = (__m512i)(right * 255 + 127); /* bytes: of the left one, of the right one */
    __m512i a = fetch_half(cell, pitch, _mm512_castsi512_si256((__m512i)offset),
                           _mm512_castsi512_si256(weights), _mm512_castsi512_si256((__m512i)down));
    __m512i b = fetch_half(cell, pitch, _mm512_extracti64x4_epi64((__m512i)offset, 1),
                           _mm512_extracti64x4_epi64(weights, 1),
                           _mm512_extracti64x4_epi64((__m512i)down, 1));
    __m512i xy = _mm512_permutex2var_epi32(a, even, b), zw = _mm512_permutex2var_epi32(a, odd, b);
    return (struct vf4){{(vf)_mm512_cvtepi32_ps(_mm512_and_si512(xy, low)),
                         (vf)_mm512_cvtepi32_ps(_mm512_srli_epi32(xy, 16)),
                         (vf)_mm512_cvtepi32_ps(_mm512_and_si512(zw, low)),
                         (vf)_mm512_cvtepi32_ps(_mm512_srli_epi32(zw, 16))}};
}

#elif KILN_SIMD_LEVEL == 2

SIMD __m256i fetch_pairs(const uint8_t *cell, __m128i offset)
{
    const __m256i interleave = _mm256_setr_epi32(0x05010400, 0x07030602, 0x0d090c08, 0x0f0b0e0a,
                                                 0x05010400, 0x07030602, 0x0d090c08, 0x0f0b0e0a);
    return _mm256_shuffle_epi8(_mm256_i32gather_epi64((const long long *)cell, offset, 4),
                               interleave);
}

SIMD __m256i fetch_half(const uint8_t *cell, uint32_t pitch, __m128i offset, __m128i right,
                        __m128i down)
{
    const __m256i spread = _mm256_setr_epi32(0x01000100, 0x01000100, 0x09080908, 0x09080908,
                                             0x01000100, 0x01000100, 0x09080908, 0x09080908);
    __m256i across = _mm256_shuffle_epi8(_mm256_cvtepu32_epi64(right), spread);
    __m256i along = _mm256_shuffle_epi8(_mm256_cvtepu32_epi64(down), spread);
    __m256i top = _mm256_maddubs_epi16(fetch_pairs(cell, offset), across);
    __m256i bottom = _mm256_maddubs_epi16(fetch_pairs(cell + 4 * (size_t)pitch, offset), across);
    return _mm256_add_epi16(top, _mm256_mulhrs_epi16(_mm256_sub_epi16(bottom, top), along));
}

SIMD struct vf4 vf_fetch(const uint8_t *cell, uint32_t pitch, vi offset, vi right, vi down)
{
    const __m256i low = _mm256_set1_epi32(0xffff);
    __m256i weights = (__m256i)(right * 255 + 127);
    __m256i a = fetch_half(cell, pitch, _mm256_castsi256_si128((__m256i)offset),
                           _mm256_castsi256_si128(weights), _mm256_castsi256_si128((__m256i)down));
    __m256i b = fetch_half(cell, pitch, _mm256_extracti128_si256((__m256i)offset, 1),
                           _mm256_extracti128_si256(weights, 1),
                           _mm256_extracti128_si256((__m256i)down, 1));
    /* Channels x, y of pixels 0 1 4 5 2 3 6 7, then put in order. */
    __m256i xy = (__m256i)_mm256_shuffle_ps((__m256)a, (__m256)b, 0x88);
    __m256i zw = (__m256i)_mm256_shuffle_ps((__m256)a, (__m256)b, 0xdd);
    xy = _mm256_permute4x64_epi64(xy, 0xd8);
    zw = _mm256_permute4x64_epi64(zw, 0xd8);
    return (struct vf4){{(vf)_mm256_cvtepi32_ps(_mm256_and_si256(xy, low)),
                         (vf)_mm256_cvtepi32_ps(_mm256_srli_epi32(xy, 16)),
                         (vf)_mm256_cvtepi32_ps(_mm256_and_si256(zw, low)),
                         (vf)_mm256_cvtepi32_ps(_mm256_srli_epi32(zw, 16))}};
}

#elif KILN_SIMD_LEVEL == 1

SIMD __m128i fetch_pairs(const uint8_t *cell, int32_t first, int32_t second)
{
    const __m128i interleave = _mm_setr_epi32(0x05010400, 0x07030602, 0x0d090c08, 0x0f0b0e0a);
    __m128i a = _mm_loadl_epi64((const __m128i *)(const void *)(cell + 4 * (ptrdiff_t)first));
    __m128i b = _mm_loadl_epi64((const __m128i *)(const void *)(cell + 4 * (ptrdiff_t)second));
    return _mm_shuffle_epi8(_mm_unpacklo_epi64(a, b), interleave);
}

SIMD __m128i fetch_half(const uint8_t *cell, uint32_t pitch, int32_t first, int32_t second,
                        __m128i right, __m128i down)
{
    const __m128i spread = _mm_setr_epi32(0x01000100, 0x01000100, 0x09080908, 0x09080908);
    __m128i across = _mm_shuffle_epi8(_mm_cvtepu32_epi64(right), spread);
    __m128i along = _mm_shuffle_epi8(_mm_cvtepu32_epi64(down), spread);
    __m128i top = _mm_maddubs_epi16(fetch_pairs(cell, first, second), across);
    __m128i bottom =
        _mm_maddubs_epi16(fetch_pairs(cell + 4 * (size_t)pitch, first, second), across);
    return _mm_add_epi16(top, _mm_mulhrs_epi16(_mm_sub_epi16(bottom, top), along));
}

SIMD struct vf4 vf_fetch(const uint8_t *cell, uint32_t pitch, vi offset, vi right, vi down)
{
    const __m128i low = _mm_set1_epi32(0xffff);
    __m128i weights = (__m128i)(right * 255 + 127);
    __m128i a = fetch_half(cell, pitch, offset[0], offset[1], weights, (__m128i)down);
    __m128i b = fetch_half(cell, pitch, offset[2], offset[3], _mm_srli_si128(weights, 8),
                           _mm_srli_si128((__m128i)down, 8));
    __m128i xy = (__m128i)_mm_shuffle_ps((__m128)a, (__m128)b, 0x88);
    __m128i zw = (__m128i)_mm_shuffle_ps((__m128)a, (__m128)b, 0xdd);
    return (struct vf4){
        {(vf)_mm_cvtepi32_ps(_mm_and_si128(xy, low)), (vf)_mm_cvtepi32_ps(_mm_srli_epi32(xy, 16)),
         (vf)_mm_cvtepi32_ps(_mm_and_si128(zw, low)), (vf)_mm_cvtepi32_ps(_mm_srli_epi32(zw, 16))}};
}

#else

SIMD struct vf4 vf_fetch(const uint8_t *cell, uint32_t pitch, vi offset, vi right, vi down)
{
    struct vf4 fetched;
    for (int i = 0; i < LANES; i++) {
        const uint8_t *top = cell + 4 * (ptrdiff_t)offset[i], *bottom = top + 4 * (size_t)pitch;
        for (int c = 0; c < 4; c++) {
            int32_t upper = top[c] * (127 - right[i]) + top[c + 4] * right[i];
            int32_t lower = bottom[c] * (127 - right[i]) + bottom[c + 4] * right[i];
            fetched.c[c][i] = (float)(upper + (((lower - upper) * down[i] + 0x4000) >> 15));
        }
    }
    return fetched;
}

#endif
#endif
