/* Names the types and operations of arithmetic that is written once for the two devices that draw:
 * light, surfaces and shapes. A file that is written in these names compiles as GLSL for
 * one point, as C for one point, and as C for a vector of points where base/real.h was
 * included first. Unlike the arithmetic of exact.h it need not give the same bits in GLSL and in C:
 * pictures of the two agree within a tolerance. C gives the same bits at every width of vectors.
 *
 * The subset is that of platform.h for structs and literals, with these types:
 *   REAL_FN    before every function
 *   real       a number of each point; + - * / and comparisons are operators
 *   real3      three of them; operations are functions
 *   truth      whether something holds at each point; truth_and, truth_or and truth_not combine it
 *   float      a number that all points share; real_all(x) makes a real of it
 *   real_some(truth)  whether a vector needs what follows: it holds at some point of it. For one
 *              point it is true, so that GLSL has no branch there
 *   REAL_INT   a signed integer of each point; real_bits and real_of_bits reinterpret, real_of and
 *              real_int convert
 * Both sides of a choice are computed: real_select(truth, yes, no) takes the place of ?: and if. */
#ifndef KILN_SHARED_REAL_H
#define KILN_SHARED_REAL_H

#include "shared/platform.h"

#ifdef GL_core_profile

#define REAL_FN
#define real                        float
#define real3                       vec3
#define truth                       bool
#define truth_and(a, b)             ((a) && (b))
#define truth_or(a, b)              ((a) || (b))
#define truth_not(a)                (!(a))
#define real_all(x)                 (x)
#define real_abs(x)                 abs(x)
#define real_min(a, b)              min(a, b)
#define real_max(a, b)              max(a, b)
#define real_clamp(x, low, high)    clamp(x, low, high)
#define real_floor(x)               floor(x)
#define real_sqrt(x)                sqrt(x)
#define real_rsqrt(x)               inversesqrt(x)
#define real_exp(x)                 exp(x)
#define real_log2(x)                log2(x)
#define real_pow(x, y)              pow(max(x, 0.0f), y)
#define real_sin(x)                 sin(x)
#define real_cos(x)                 cos(x)
#define real_atan2(y, x)            atan(y, x)
#define real_select(holds, yes, no) ((holds) ? (yes) : (no))
#define real_where(holds, x)        ((holds) ? (x) : 0.0f)
#define real_some(holds)            true
#define real_sign_one(x)            ((x) < 0.0f ? -1.0f : 1.0f)
#define REAL_INT                    int
#define real_bits(x)                floatBitsToInt(x)
#define real_of_bits(x)             intBitsToFloat(x)
#define real_of(x)                  float(x)
#define real_int(x)                 int(x)

#define REAL3(x, y, z)               vec3(x, y, z)
#define real3_all(v)                 ((v).xyz)
#define real3_add(a, b)              ((a) + (b))
#define real3_sub(a, b)              ((a) - (b))
#define real3_scale(a, x)            ((a) * (x))
#define real3_add_scaled(a, b, x)    ((a) + (b) * (x))
#define real3_dot(a, b)              dot(a, b)
#define real3_dot_all(a, b)          dot(a, (b).xyz)
#define real3_towards(to, from)      ((to).xyz - (from))
#define real3_length(a)              length(a)
#define real3_normalize(a)           normalize(a)
#define real3_mix_all(a, b, x)       mix((a).xyz, (b).xyz, x)
#define real3_select(holds, yes, no) ((holds) ? (yes) : (no))

#elif !defined(KILN_BASE_REAL_H)

#include "shared/exact.h"

#define REAL_FN                     static inline
#define real                        float
#define real3                       float3
#define truth                       bool
#define truth_and(a, b)             ((int)(a) & (int)(b))
#define truth_or(a, b)              ((int)(a) | (int)(b))
#define truth_not(a)                (!(a))
#define real_all(x)                 (x)
#define real_abs(x)                 fabsf(x)
#define real_min(a, b)              exact_min(a, b)
#define real_max(a, b)              exact_max(a, b)
#define real_clamp(x, low, high)    exact_clamp(x, low, high)
#define real_floor(x)               floorf(x)
#define real_sqrt(x)                sqrtf(x)
#define real_rsqrt(x)               (1.0f / sqrtf(x))
#define real_exp(x)                 exact_exp(x)
#define real_log2(x)                exact_log2(x)
#define real_pow(x, y)              exact_pow(x, y)
#define real_sin(x)                 exact_sincos(x).sine
#define real_cos(x)                 exact_sincos(x).cosine
#define real_select(holds, yes, no) ((holds) ? (yes) : (no))
#define real_where(holds, x)        ((holds) ? (x) : 0.0f)
#define real_some(holds)            truth_or(holds, true)
#define real_sign_one(x)            ((x) < 0.0f ? -1.0f : 1.0f)
#define REAL_INT                    int32_t
#define real_bits(x)                ((int32_t)FLOAT_BITS(x))
#define real_of_bits(x)             BITS_FLOAT((uint32_t)(x))
#define real_of(x)                  ((float)(x))
#define real_int(x)                 ((int32_t)(x))

#define REAL3(x, y, z)            FLOAT3(x, y, z)
#define real3_all(v)              FLOAT3((v).x, (v).y, (v).z)
#define real3_add(a, b)           float3_add(a, b)
#define real3_sub(a, b)           float3_sub(a, b)
#define real3_scale(a, x)         float3_scale(a, x)
#define real3_add_scaled(a, b, x) float3_add_scaled(a, b, x)
#define real3_dot(a, b)           float3_dot(a, b)
#define real3_dot_all(a, b)       float3_dot(a, real3_all(b))
#define real3_towards(to, from)   float3_sub(real3_all(to), from)
#define real3_length(a)           sqrtf(float3_dot(a, a))
#define real3_normalize(a)        float3_scale(a, 1.0f / real3_length(a))
#define real3_mix_all(a, b, x)                                                                     \
    real3_add_scaled(real3_all(a), float3_sub(real3_all(b), real3_all(a)), x)
#define real3_select(holds, yes, no) ((holds) ? (yes) : (no))

#endif

REAL_FN real real_clamp01(real x)
{
    return real_clamp(x, 0.0f, 1.0f);
}

/* Interpolates linearly from a at part 0 to b at part 1. */
REAL_FN real real_mix(real a, real b, real part)
{
    return a + (b - a) * part;
}

/* Returns 0 up to `from`, 1 from `to` on, and Hermite's cubic between. */
REAL_FN real real_smoothstep(float from, float to, real x)
{
    real t = real_clamp01((x - from) * (1.0f / (to - from)));
    return t * t * (3.0f - 2.0f * t);
}

REAL_FN real3 real3_cross(real3 a, real3 b)
{
    return REAL3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

#endif
