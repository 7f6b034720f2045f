/* This header defines functions and 3D vectors of vectors of floats, on top of base/lanes.h.
 * They use operations that IEEE 754 rounds in one way, not libm's approximations, so results are
 * the same bits at every level. shaders/shared/exact.h has such functions for single numbers. */
#ifndef KILN_BASE_LANE_MATH_H
#define KILN_BASE_LANE_MATH_H

#include "base/lanes.h"
#include "shared/exact.h"

#define RAY_PI 3.14159265f

SIMD vi vi_all(int32_t x)
{
    return x - (vi){0};
}

/* Returns 0, 1, 2... in the lanes. */
SIMD vi vi_count(void)
{
    return __builtin_convertvector(vf_count(), vi);
}

SIMD vf vf_of(vi x)
{
    return __builtin_convertvector(x, vf);
}

SIMD vf vf_select(vi mask, vf yes, vf no)
{
    return (vf)(((vi)yes & mask) | ((vi)no & ~mask));
}

SIMD vi vi_select(vi mask, vi yes, vi no)
{
    return (yes & mask) | (no & ~mask);
}

/* Returns 1 with the sign of x. */
SIMD vf vf_sign_one(vf x)
{
    return (vf)(((vi)x & INT32_MIN) | 0x3f800000);
}

SIMD vf vf_clamp(vf x, float low, float high)
{
    return vf_min(vf_max(x, vf_all(low)), vf_all(high));
}

/* Holds two numbers for each lane. vi_gather_pair gathers two that are neighbours in memory. */
struct vi_pair {
    vi first, second;
};

#if defined KILN_LEVEL_AVX512

SIMD bool any(vi mask)
{
    return _mm512_movepi32_mask((__m512i)mask) != 0;
}

SIMD vf round_down(vf x)
{
    return (vf)_mm512_roundscale_ps((__m512)x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}

SIMD vf vf_gather(const float *from, vi index)
{
    return (vf)_mm512_i32gather_ps((__m512i)index, from, 4);
}

SIMD struct vi_pair vi_gather_pair(const int32_t *from, vi index)
{
    const __m512i even = (__m512i)(vi){0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30};
    const __m256i upper = _mm512_extracti64x4_epi64((__m512i)index, 1);
    const __m512i a = _mm512_i32gather_epi64(_mm512_castsi512_si256((__m512i)index), from, 4);
    const __m512i b = _mm512_i32gather_epi64(upper, from, 4);
    return (struct vi_pair){(vi)_mm512_permutex2var_epi32(a, even, b),
                            (vi)_mm512_permutex2var_epi32(a, (__m512i)((vi)even + 1), b)};
}

#elif defined KILN_LEVEL_AVX2

SIMD bool any(vi mask)
{
    return _mm256_movemask_ps((__m256)mask) != 0;
}

SIMD vf round_down(vf x)
{
    return (vf)_mm256_floor_ps((__m256)x);
}

SIMD vf vf_gather(const float *from, vi index)
{
    return (vf)_mm256_i32gather_ps(from, (__m256i)index, 4);
}

SIMD struct vi_pair vi_gather_pair(const int32_t *from, vi index)
{
    const long long *at = (const long long *)(const void *)from;
    const __m128i lower = _mm256_castsi256_si128((__m256i)index);
    const __m128i upper = _mm256_extracti128_si256((__m256i)index, 1);
    const __m256 a = (__m256)_mm256_i32gather_epi64(at, lower, 4);
    const __m256 b = (__m256)_mm256_i32gather_epi64(at, upper, 4);
    /* Shuffles take the lower two of a, then of b, and then the upper ones. */
    const __m256i first = (__m256i)_mm256_shuffle_ps(a, b, 0x88);
    const __m256i second = (__m256i)_mm256_shuffle_ps(a, b, 0xdd);
    return (struct vi_pair){(vi)_mm256_permute4x64_epi64(first, 0xd8),
                            (vi)_mm256_permute4x64_epi64(second, 0xd8)};
}

#else

#ifdef KILN_LEVEL_NEON

SIMD bool any(vi mask)
{
    return vmaxvq_u32((uint32x4_t)mask) != 0;
}

SIMD vf round_down(vf x)
{
    return (vf)vrndmq_f32((float32x4_t)x);
}

#else

SIMD bool any(vi mask)
{
    return vi_bits(mask) != 0;
}

/* Truncates, and subtracts 1 where that is above x. Numbers of 2^23 or more are whole already. */
SIMD vf round_down(vf x)
{
    const vf truncated = vf_of(vi_of(x));
    const vf whole = truncated - vf_where(truncated > x, vf_all(1.0f));
    const vf signed_whole = (vf)((vi)whole | ((vi)x & INT32_MIN)); /* the floor of -0 is -0 */
    return vf_select(vf_abs(x) < 0x1p23f, signed_whole, x);
}

#endif

SIMD vf vf_gather(const float *from, vi index)
{
    vf x;
    for (int i = 0; i < LANES; i++)
        x[i] = from[index[i]];
    return x;
}

SIMD struct vi_pair vi_gather_pair(const int32_t *from, vi index)
{
    vi first, second;
    for (int i = 0; i < LANES; i++) {
        first[i] = from[index[i]];
        second[i] = from[index[i] + 1];
    }
    return (struct vi_pair){first, second};
}

#endif

/* Returns the floor of x, with +0 in place of -0. */
SIMD vf vf_floor(vf x)
{
    return round_down(x) + 0.0f;
}

SIMD vi vi_gather(const int32_t *from, vi index)
{
    return (vi)vf_gather((const float *)(const void *)from, index);
}

/* The functions have the ranges that shared/elementary.h gives: vf_rsqrt and vf_log2 take arguments
 * of 2^-100 or more. For zero, vf_rsqrt returns a large finite number. */
#define ELEMENT             vf
#define ELEMENT_INT         vi
#define ELEMENT_FN          SIMD
#define ELEMENT_BITS(x)     ((vi)(x))
#define ELEMENT_OF_BITS(i)  ((vf)(i))
#define ELEMENT_TRUNCATE(x) vi_of(x)
#define ELEMENT_WHOLE(i)    vf_of(i)
#define ELEMENT_FLOOR(x)    round_down(x)
#define ELEMENT_RCP         vf_rcp_within
#define ELEMENT_RSQRT       vf_rsqrt
#define ELEMENT_EXP         vf_exp_within
#define ELEMENT_LOG2        vf_log2
#define ELEMENT_REST        vf_rest_within
#define ELEMENT_SINE        vf_sine_within
#define ELEMENT_COSINE      vf_cosine_within
#include "shared/elementary.h"

/* Returns e^x as exact_exp does: 0 below -69, e^69 above 69. Unlike there, NaN gives 0. */
SIMD vf vf_exp(vf x)
{
    return vf_where(x >= -69.0f, vf_exp_within(vf_clamp(x, -69.0f, 69.0f)));
}

struct vf_angle {
    vf sine, cosine;
};

/* Returns sine and cosine of x radians as exact_sincos does: those of 0 for |x| > 8192. */
SIMD struct vf_angle vf_sincos(vf x)
{
    x = vf_where(vf_abs(x) <= 8192.0f, x);
    vf quarter = round_down(x * 0.636619772f + 0.5f);
    vf r = vf_rest_within(x, quarter), z = r * r;
    vf s = vf_sine_within(r, z), c = vf_cosine_within(z);
    vi q = vi_of(quarter);
    vi odd = -(q & 1), lower = (q & 2) << 30, left = ((q + 1) & 2) << 30;
    return (struct vf_angle){(vf)((vi)vf_select(odd, c, s) ^ lower),
                             (vf)((vi)vf_select(odd, s, c) ^ left)};
}

/* Returns the angle of (x, y), -pi to pi, within 3e-7; an arbitrary angle for (0, 0). */
SIMD vf vf_atan2(vf y, vf x)
{
    vf across = vf_abs(x), up = vf_abs(y);
    vi steep = up > across;
    vf less = vf_min(across, up), more = vf_max(vf_max(across, up), vf_all(1e-30f));
    /* For angles above pi / 8, the tangent of the difference to pi / 4 is used. */
    vi wide = less > 0.414213562f * more;
    vf ratio = vf_select(wide, less - more, less) / vf_select(wide, less + more, more);
    vf z = ratio * ratio;
    vf p = ((8.05374449e-2f * z - 1.38776856e-1f) * z + 1.99777106e-1f) * z - 3.33329492e-1f;
    vf angle = ratio + ratio * (z * p) + vf_where(wide, vf_all(0.25f * RAY_PI));
    angle = vf_select(steep, 0.5f * RAY_PI - angle, angle);
    angle = vf_select(x < 0.0f, RAY_PI - angle, angle);
    return vf_select(y < 0.0f, -angle, angle);
}

/* ---- vectors in space ------------------------------------------------------------------------ */

struct vf3 {
    vf x, y, z;
};

SIMD struct vf3 vf3_all(float4 v)
{
    return (struct vf3){vf_all(v.x), vf_all(v.y), vf_all(v.z)};
}

SIMD struct vf3 vf3_add(struct vf3 a, struct vf3 b)
{
    return (struct vf3){a.x + b.x, a.y + b.y, a.z + b.z};
}

SIMD struct vf3 vf3_sub(struct vf3 a, struct vf3 b)
{
    return (struct vf3){a.x - b.x, a.y - b.y, a.z - b.z};
}

SIMD struct vf3 vf3_scale(struct vf3 a, vf factor)
{
    return (struct vf3){a.x * factor, a.y * factor, a.z * factor};
}

/* Returns a + b * factor. */
SIMD struct vf3 vf3_add_scaled(struct vf3 a, struct vf3 b, vf factor)
{
    return (struct vf3){a.x + b.x * factor, a.y + b.y * factor, a.z + b.z * factor};
}

SIMD vf vf3_dot(struct vf3 a, struct vf3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

SIMD struct vf3 vf3_select(vi mask, struct vf3 yes, struct vf3 no)
{
    return (struct vf3){vf_select(mask, yes.x, no.x), vf_select(mask, yes.y, no.y),
                        vf_select(mask, yes.z, no.z)};
}

SIMD vf vf3_length(struct vf3 a)
{
    vf square = vf3_dot(a, a);
    return square * vf_rsqrt(square);
}

SIMD struct vf3 vf3_normalize(struct vf3 a)
{
    return vf3_scale(a, vf_rsqrt(vf3_dot(a, a)));
}

/* Returns a vector that all lanes share minus each lane's vector. */
SIMD struct vf3 vf3_towards(float4 to, struct vf3 from)
{
    return (struct vf3){to.x - from.x, to.y - from.y, to.z - from.z};
}

SIMD vf vf3_dot_all(struct vf3 a, float4 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Returns one coordinate of p under an affine map. row: the map's row for that coordinate. */
SIMD vf vf3_map(float4 row, struct vf3 p)
{
    return row.x * p.x + row.y * p.y + row.z * p.z + row.w;
}

/* Interpolates between two colours that all lanes share. */
SIMD struct vf3 vf3_mix(float4 from, float4 to, vf part)
{
    return (struct vf3){from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part,
                        from.z + (to.z - from.z) * part};
}

#endif
