/* Defines the arithmetic of the simulation, which gives the same bits on every device
 * (docs/determinism.md, 1).
 *
 * It is built from + - * on floats, comparisons, floor and integer operations, which every IEEE
 * machine rounds alike. Division, roots and other functions are defined here, since drivers round
 * theirs differently. Denormals, which some stages flush, count as zero wherever they could matter:
 * below 2^-100 a number is tiny. Every function is defined for every argument, including NaN and
 * infinities. NaN is tested by its bits, since a compiler may turn !(x < y) into x >= y. */
#ifndef KILN_SHARED_EXACT_H
#define KILN_SHARED_EXACT_H

#include "shared/platform.h"

#define EXACT_SIGN_BIT  0x80000000u
#define EXACT_SIZE_BITS 0x7fffffffu
#define EXACT_TINY_BITS 0x0d800000u /* 2^-100 */
#define EXACT_VAST_BITS 0x71800000u /* 2^100 */

#define EXACT_TWO_PI 6.28318548f

/* Returns whether |x| < 2^-100, which counts as zero. */
FN bool exact_is_tiny(float x)
{
    return (FLOAT_BITS(x) & EXACT_SIZE_BITS) < EXACT_TINY_BITS;
}

/* Returns x, or +0 for tiny numbers and for -0. Values that are stored or compared with zero go
 * through it. */
FN float exact_canon(float x)
{
    EXACT float y = exact_is_tiny(x) ? 0.0f : x;
    return y;
}

FN float exact_abs(float x)
{
    EXACT float y = BITS_FLOAT(FLOAT_BITS(x) & EXACT_SIZE_BITS);
    return y;
}

FN float exact_min(float a, float b)
{
    EXACT float y = a < b ? a : b;
    return y;
}

FN float exact_max(float a, float b)
{
    EXACT float y = a > b ? a : b;
    return y;
}

FN float exact_clamp(float x, float low, float high)
{
    EXACT float raised = exact_max(x, low);
    EXACT float y = exact_min(raised, high);
    return y;
}

/* Returns x without its fraction, and the least integer for NaN and for numbers beyond 2^31, as x86
 * and vi_of (lib/base/lanes.h) do. The conversions of C and GLSL are undefined there. lib/draw and
 * lib/post convert floats by this function and exact_uint alone, also where a value was just
 * clamped, so that no reader needs to prove its range (tests/tree/conversions.sh). */
FN int exact_int(float x)
{
    bool within = (FLOAT_BITS(x) & EXACT_SIZE_BITS) < 0x4f000000u; /* 2^31 */
    return within ? INT(x) : -2147483647 - 1;
}

/* Returns x without its fraction, and 0 for NaN and for numbers that an unsigned integer does not
 * have: 0 is a place within every array. */
FN uint exact_uint(float x)
{
    uint bits = FLOAT_BITS(x);
    bool within = bits < 0x4f800000u || (bits & EXACT_SIZE_BITS) < 0x3f800000u; /* 2^32; 1 */
    return within ? UINT(x) : 0u;
}

/* Interpolates from a at t = 0 to b at t = 1; the result is within a and b for t from 0 to 1. */
FN float exact_lerp(float a, float b, float t)
{
    EXACT float difference = b - a;
    EXACT float part = difference * t;
    EXACT float y = a + part;
    EXACT float low = exact_min(a, b);
    EXACT float high = exact_max(a, b);
    EXACT float inside = exact_clamp(y, low, high);
    return inside;
}

/* exact_NAME_within: NAME for arguments within the range where its polynomial serves. */
#define ELEMENT             float
#define ELEMENT_INT         int
#define ELEMENT_FN          FN
#define ELEMENT_BITS(x)     INT(FLOAT_BITS(x))
#define ELEMENT_OF_BITS(i)  BITS_FLOAT(UINT(i))
#define ELEMENT_TRUNCATE(x) INT(x)
#define ELEMENT_WHOLE(i)    FLOAT(i)
#define ELEMENT_FLOOR(x)    FLOOR(x)
#define ELEMENT_RCP         exact_rcp_within
#define ELEMENT_RSQRT       exact_rsqrt_within
#define ELEMENT_EXP         exact_exp_within
#define ELEMENT_LOG2        exact_log2_within
#define ELEMENT_REST        exact_rest_within
#define ELEMENT_SINE        exact_sine_within
#define ELEMENT_COSINE      exact_cosine_within
#include "shared/elementary.h"
#undef ELEMENT
#undef ELEMENT_INT
#undef ELEMENT_FN
#undef ELEMENT_BITS
#undef ELEMENT_OF_BITS
#undef ELEMENT_TRUNCATE
#undef ELEMENT_WHOLE
#undef ELEMENT_FLOOR
#undef ELEMENT_RCP
#undef ELEMENT_RSQRT
#undef ELEMENT_EXP
#undef ELEMENT_LOG2
#undef ELEMENT_REST
#undef ELEMENT_SINE
#undef ELEMENT_COSINE

/* Returns 1 / x within 1.5 ulp for 2^-100 <= |x| <= 2^100; 0 for any other x, including zero. */
FN float exact_rcp(float x)
{
    uint bits = FLOAT_BITS(x);
    uint size = bits & EXACT_SIZE_BITS;
    if (size < EXACT_TINY_BITS || size > EXACT_VAST_BITS)
        return 0.0f;
    EXACT float a = BITS_FLOAT(size);
    EXACT float y = exact_rcp_within(a);
    EXACT float signed_y = BITS_FLOAT(FLOAT_BITS(y) | (bits & EXACT_SIGN_BIT));
    return signed_y;
}

/* Returns a / b within 2 ulp while the result is no denormal; 0 where exact_rcp(b) is 0. */
FN float exact_div(float a, float b)
{
    EXACT float r = exact_rcp(b);
    EXACT float y = a * r;
    return y;
}

/* Returns 1 / sqrt(x) within 1.5 ulp for 2^-100 <= x <= 2^100; 0 for any other x, including
 * zero. */
FN float exact_rsqrt(float x)
{
    uint bits = FLOAT_BITS(x);
    if (bits < EXACT_TINY_BITS || bits > EXACT_VAST_BITS) /* as an unsigned number, a negative x is
                                                           * beyond the range, too */
        return 0.0f;
    EXACT float y = exact_rsqrt_within(x);
    return y;
}

/* Returns sqrt(x) within 2 ulp for 2^-100 <= x <= 2^100; 0 for any other x. */
FN float exact_sqrt(float x)
{
    EXACT float r = exact_rsqrt(x);
    if (r == 0.0f)
        return 0.0f;
    EXACT float y = x * r;
    return y;
}

struct exact_angle {
    float sine, cosine;
};

/* Returns sine and cosine of x radians, each within 1e-7 for |x| <= 8192; those of 0 for any other
 * x. x is brought to [-pi/4, pi/4] by subtracting quarter turns in three parts, so short that the
 * first two products are exact. There a minimax polynomial is evaluated. */
FN S(exact_angle) exact_sincos(float x)
{
    EXACT S(exact_angle) result;
    result.sine = 0.0f;
    result.cosine = 1.0f;
    if ((FLOAT_BITS(x) & EXACT_SIZE_BITS) > 0x46000000u) /* 8192 */
        return result;
    EXACT float turns = x * 0.636619772f + 0.5f;
    EXACT float quarter = FLOOR(turns);
    EXACT float r = exact_rest_within(x, quarter);
    EXACT float z = exact_canon(r * r);
    EXACT float s = exact_sine_within(r, z);
    EXACT float c = exact_cosine_within(z);
    uint q = UINT(INT(quarter)) & 3u;
    EXACT float sine = (q & 1u) != 0u ? c : s;
    EXACT float cosine = (q & 1u) != 0u ? s : c;
    result.sine = (q & 2u) != 0u ? -sine : sine;
    result.cosine = (q == 1u || q == 2u) ? -cosine : cosine;
    return result;
}

/* Returns e^x with a relative error of 1e-7 for |x| <= 69; 0 below, e^69 above; 1 for NaN. */
FN float exact_exp(float x)
{
    uint bits = FLOAT_BITS(x);
    uint size = bits & EXACT_SIZE_BITS;
    if (size > 0x7f800000u) /* NaN */
        return 1.0f;
    bool far = size > 0x428a0000u; /* 69 */
    if (far && bits != size)
        return 0.0f;
    EXACT float limited = far ? 69.0f : x;
    EXACT float scaled = exact_exp_within(limited);
    return scaled;
}

/* Returns log2(x) within 2e-7 of the greater of 1 and its size for 2^-100 <= x <= 2^100. Beyond
 * that range, including infinity, it returns the value at the nearer end; -100 for negative numbers
 * and NaN. */
FN float exact_log2(float x)
{
    uint bits = FLOAT_BITS(x);
    bits = bits > 0x7f800000u || bits < EXACT_TINY_BITS ? EXACT_TINY_BITS : bits;
    bits = bits > EXACT_VAST_BITS ? EXACT_VAST_BITS : bits;
    /* so that the remaining factor is 0.707 to 1.414 */
    EXACT float limited = BITS_FLOAT(bits);
    EXACT float y = exact_log2_within(limited);
    return y;
}

/* Returns 2^x with a relative error of 2e-7 for |x| <= 100; 0 below, 2^100 above; 1 for NaN. */
FN float exact_exp2(float x)
{
    uint size = FLOAT_BITS(x) & EXACT_SIZE_BITS;
    EXACT float number = size > 0x7f800000u ? 0.0f : x;
    EXACT float limited = exact_clamp(number, -100.0f, 100.0f);
    EXACT float n = FLOOR(limited + 0.5f);
    EXACT float r = limited - n;
    EXACT float high = 0.00961808256f + r * (0.00133908634f + r * 0.000154531629f);
    EXACT float p = 0.693147188f + r * (0.240226508f + r * (0.0555035711f + r * high));
    EXACT float y = 1.0f + r * p;
    uint exponent = UINT(INT(n) + 127);
    EXACT float power = BITS_FLOAT(exponent << 23);
    EXACT float scaled = number < -100.0f ? 0.0f : y * power;
    return scaled;
}

/* Returns x^y, as 2^(y log2 x), with a relative error of 2e-7 times the greater of 1 and |y log2
 * x|, within the limits of exact_log2 and exact_exp2; 0 if x is not positive and y > 1. */
FN float exact_pow(float x, float y)
{
    EXACT float exponent = y * exact_log2(x);
    EXACT float power = exact_exp2(exponent);
    return power;
}

/* ---- vectors -------------------------------------------------------------------------------- */

FN float3 float3_add(float3 a, float3 b)
{
    EXACT float3 y = FLOAT3(a.x + b.x, a.y + b.y, a.z + b.z);
    return y;
}

FN float3 float3_sub(float3 a, float3 b)
{
    EXACT float3 y = FLOAT3(a.x - b.x, a.y - b.y, a.z - b.z);
    return y;
}

FN float3 float3_scale(float3 a, float factor)
{
    EXACT float3 y = FLOAT3(a.x * factor, a.y * factor, a.z * factor);
    return y;
}

/* Returns a + b * factor. */
FN float3 float3_add_scaled(float3 a, float3 b, float factor)
{
    EXACT float3 part = float3_scale(b, factor);
    EXACT float3 y = float3_add(a, part);
    return y;
}

FN float float3_dot(float3 a, float3 b)
{
    EXACT float y = a.x * b.x + a.y * b.y + a.z * b.z;
    return y;
}

FN float3 float3_cross(float3 a, float3 b)
{
    EXACT float3 y = FLOAT3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return y;
}

FN float3 float3_canon(float3 a)
{
    EXACT float3 y = FLOAT3(exact_canon(a.x), exact_canon(a.y), exact_canon(a.z));
    return y;
}

FN float float3_length(float3 a)
{
    EXACT float square = float3_dot(a, a);
    EXACT float y = exact_sqrt(square);
    return y;
}

/* Returns a with length 1; `otherwise` when a is shorter than 2^-50. */
FN float3 float3_normalize(float3 a, float3 otherwise)
{
    EXACT float square = float3_dot(a, a);
    EXACT float r = exact_rsqrt(square);
    if (r == 0.0f)
        return otherwise;
    EXACT float3 y = float3_scale(a, r);
    return y;
}

/* Returns v rotated by a unit quaternion. */
FN_WITHIN float3 float3_turn(float4 pose, float3 v)
{
    EXACT float3 u = FLOAT3(pose.x, pose.y, pose.z);
    EXACT float3 across = float3_cross(u, v);
    EXACT float3 twice = float3_scale(across, 2.0f);
    EXACT float3 more = float3_cross(u, twice);
    EXACT float3 y = float3_add_scaled(v, twice, pose.w);
    y = float3_add(y, more);
    return y;
}

#endif
