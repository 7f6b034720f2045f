/* This header holds mathematics for vectors of rays, beyond draw/vector/simd.h. Results are the
 * same bits at every level, from operations that IEEE 754 rounds, with no function of libm (the
 * scalar ones are in shaders/shared/exact.h). */
#ifndef KILN_DRAW_VECTOR_RAY_MATH_H
#define KILN_DRAW_VECTOR_RAY_MATH_H

#include "draw/vector/simd.h"
#include "shared/exact.h"

#define RAY_PI 3.14159265f

typedef uint32_t vu __attribute__((vector_size(4 * LANES)));

SIMD vi vi_all(int32_t x)
{
    return x - (vi){0};
}

/* 0, 1, 2... */
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

#if KILN_SIMD_LEVEL == 3

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

#elif KILN_SIMD_LEVEL == 2

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

#else

#if KILN_SIMD_LEVEL == 1

SIMD bool any(vi mask)
{
    return _mm_movemask_ps((__m128)mask) != 0;
}

SIMD vf round_down(vf x)
{
    return (vf)_mm_floor_ps((__m128)x);
}

#elif KILN_SIMD_LEVEL == 4

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
    int32_t bits = 0;
    for (int i = 0; i < LANES; i++)
        bits |= mask[i];
    return bits != 0;
}

SIMD vf round_down(vf x)
{
    for (int i = 0; i < LANES; i++)
        x[i] = floorf(x[i]);
    return x;
}

#endif

SIMD vf vf_gather(const float *from, vi index)
{
    vf x;
    for (int i = 0; i < LANES; i++)
        x[i] = from[index[i]];
    return x;
}

#endif

/* Without a zero that is negative. */
SIMD vf vf_floor(vf x)
{
    return round_down(x) + 0.0f;
}

SIMD vi vi_gather(const int32_t *from, vi index)
{
    return (vi)vf_gather((const float *)(const void *)from, index);
}

/* 1 / sqrt(x) within 1.5 ulp, as exact_rsqrt has it, for x >= 2^-100; of zero, a large number. */
SIMD vf vf_rsqrt(vf x)
{
    vf y = (vf)(0x5f375a86 - ((vi)x >> 1));
    vf h = 0.5f * x;
    y = y * (1.5f - (h * y) * y);
    y = y * (1.5f - (h * y) * y);
    return y + y * (0.5f - (h * y) * y);
}

/* e^x as exact_exp has it; below -69 it is 0. */
SIMD vf vf_exp(vf x)
{
    vf limited = vf_clamp(x, -69.0f, 69.0f);
    vf n = round_down(limited * 1.44269504f + 0.5f);
    vf r = limited - n * 0.693115234375f;
    r = r - n * 3.19461833e-5f;
    vf high = 0.0416665501f + r * (0.00836377387f + r * 0.00139269266f);
    vf p = 0.5f + r * (0.166665734f + r * high);
    vf y = 1.0f + (r + (r * r) * p);
    vf power = (vf)((vi_of(n) + 127) << 23);
    return vf_where(x >= -69.0f, y * power);
}

/* log2(x) as exact_log2 has it, for 2^-100 <= x <= 2^100. */
SIMD vf vf_log2(vf x)
{
    vi bits = (vi)x;
    vi exponent = (bits - 0x3f3504f3) >> 23;
    vf f = (vf)(bits - (vi)((vu)exponent << 23)) - 1.0f;
    vf high = -0.239169881f + f * (0.216078226f + f * (-0.205861881f + f * 0.123109685f));
    vf middle = 0.480910753f + f * (-0.360693268f + f * (0.287903261f + f * high));
    vf p = f * (1.44269502f + f * (-0.721347468f + f * middle));
    return vf_of(exponent) + p;
}

struct vf_angle {
    vf sine, cosine;
};

/* As exact_sincos has it: those of 0 beyond 8192. */
SIMD struct vf_angle vf_sincos(vf x)
{
    x = vf_where(vf_abs(x) <= 8192.0f, x);
    vf quarter = round_down(x * 0.636619772f + 0.5f);
    vf r = x - quarter * 1.5703125f;
    r = r - quarter * 0.000483751297f;
    r = r - quarter * 7.54978995e-8f;
    vf z = r * r;
    vf ps = -0.166666646f + z * (0.00833273656f + z * -0.000195853732f);
    vf s = r + r * (z * ps);
    vf pc = 0.0416666646f + z * (-0.00138882913f + z * 2.45454191e-5f);
    vf c = (1.0f - 0.5f * z) + (z * z) * pc;
    vi q = vi_of(quarter);
    vi odd = -(q & 1), lower = (q & 2) << 30, left = ((q + 1) & 2) << 30;
    return (struct vf_angle){(vf)((vi)vf_select(odd, c, s) ^ lower),
                             (vf)((vi)vf_select(odd, s, c) ^ left)};
}

/* The angle of (x, y) within 3e-7, -pi to pi; any for (0, 0). */
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

/* a + b * factor */
SIMD struct vf3 vf3_along(struct vf3 a, struct vf3 b, vf factor)
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

/* Returns a uniform vector less each lane's vector. */
SIMD struct vf3 vf3_towards(float4 to, struct vf3 from)
{
    return (struct vf3){to.x - from.x, to.y - from.y, to.z - from.z};
}

SIMD vf vf3_dot_all(struct vf3 a, float4 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* A row of an affine map. */
SIMD vf vf3_map(float4 row, struct vf3 p)
{
    return row.x * p.x + row.y * p.y + row.z * p.z + row.w;
}

/* Between two uniform colours. */
SIMD struct vf3 vf3_mix(float4 from, float4 to, vf part)
{
    return (struct vf3){from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part,
                        from.z + (to.z - from.z) * part};
}

#endif
