/* Maps scene-linear Rec. 709 to display-linear Rec. 709 and to sRGB, both 0 to 1. It has no
 * branches. Polynomials are summed in pairs, whose halves do not wait for each other. */
#ifndef KILN_SHARED_TONEMAP_H
#define KILN_SHARED_TONEMAP_H

#include "shared/real.h"

/* Returns the product of a matrix's row (x, y, z) and a colour. */
REAL_FN real tonemap_row(float x, float y, float z, real3 color)
{
    return x * color.x + y * color.y + z * color.z;
}

/* A number above 0 as 2^exponent (1 + f), with 1 + f from 0.707 to 1.414. */
struct tonemap_parts {
    real exponent, f;
};

REAL_FN S(tonemap_parts) tonemap_parts_of(real x)
{
    REAL_INT bits = real_bits(x), exponent = (bits - 0x3f3504f3) >> 23;
    S(tonemap_parts) parts;
    parts.exponent = real_of(exponent);
    parts.f = real_of_bits(bits - exponent * 8388608) - 1.0f;
    return parts;
}

/* ---- AgX ------------------------------------------------------------------------------------- */

/* AgX by Troy Sobotka: colours are desaturated into a smaller gamut, a sigmoid acts on their
 * logarithm, and the gamut is opened again. The matrices and the polynomial that stands for the
 * sigmoid are Benjamin Wrensch's fit ("Minimal AgX implementation", 2023; mean error 1e-6), whose
 * result is encoded with gamma 2.2. */
REAL_FN real tonemap_agx_channel(real light)
{
    /* v is log2(light) from -12.47393 to 4.026069 stops, as 0 to 1. */
    S(tonemap_parts) parts = tonemap_parts_of(real_clamp(light, 1.757814e-4f, 16.29174f));
    real f = parts.f;
    real stops = (0.0873794407f - 0.043933589f * f) + (f * f) * (0.0313642062f - 0.0199775659f * f);
    real v = parts.exponent * 0.0606060643f + (0.755995803f + f * stops);
    real v2 = v * v, v4 = v2 * v2;
    return ((0.1191f * v - 0.00232f) + v2 * (0.4298f - 6.868f * v)) +
           v4 * (31.96f + (15.5f * v2 - 40.14f * v));
}

/* Returns the display's light to the power of 1 / 2.2, for tonemap_encode_root. Taking the power
 * only to encode it again would cost two logarithms and exponentials instead of one. */
REAL_FN real3 tonemap_agx_root(real3 color)
{
    real3 v;
    v.x = tonemap_agx_channel(
        tonemap_row(0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f, color));
    v.y = tonemap_agx_channel(
        tonemap_row(0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f, color));
    v.z = tonemap_agx_channel(
        tonemap_row(0.0423756549057051f, 0.0784336f, 0.879142973793104f, color));
    real3 root;
    root.x = tonemap_row(1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f, v);
    root.y = tonemap_row(-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f, v);
    root.z = tonemap_row(-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f, v);
    return root;
}

/* ---- ACES ------------------------------------------------------------------------------------ */

REAL_FN real tonemap_aces_channel(real v)
{
    real above = v * (v + 0.0245786f) - 0.000090537f;
    real below = v * (0.983729f * v + 0.4329510f) + 0.238081f;
    return above / below;
}

/* ACES: Stephen Hill's fit of the RRT and the Rec. 709 ODT, in its own primaries. */
REAL_FN real3 tonemap_aces(real3 color)
{
    real3 v;
    v.x = tonemap_aces_channel(tonemap_row(0.59719f, 0.35458f, 0.04823f, color));
    v.y = tonemap_aces_channel(tonemap_row(0.07600f, 0.90834f, 0.01566f, color));
    v.z = tonemap_aces_channel(tonemap_row(0.02840f, 0.13383f, 0.83777f, color));
    real3 light;
    light.x = real_clamp01(tonemap_row(1.60475f, -0.53108f, -0.07367f, v));
    light.y = real_clamp01(tonemap_row(-0.10208f, 1.10813f, -0.00605f, v));
    light.z = real_clamp01(tonemap_row(-0.00327f, -0.07276f, 1.07602f, v));
    return light;
}

/* ---- sRGB (IEC 61966-2-1) -------------------------------------------------------------------- */

/* Curves are off by 2e-5 at most, AgX and encoding together: 0.005 of 255 levels. */

/* Returns x^exponent, for x from 1e-6 to 1 and exponents from 0 to 3, by logarithm and exponential.
 * 1 gives 1. */
REAL_FN real tonemap_power(real x, float exponent)
{
    S(tonemap_parts) parts = tonemap_parts_of(x);
    real f = parts.f;
    real log_high = (0.4866861f - 0.3945754f * f) + (f * f) * 0.2526603f;
    real log_f = f * ((1.442578f - 0.7202418f * f) + (f * f) * log_high);
    real power = (parts.exponent + log_f) * exponent;
    real whole = real_floor(power), g = power - whole;
    real part =
        (1.0f + 0.6930186f * g) + (g * g) * ((0.2414455f + 0.0519505f * g) + (g * g) * 0.0135812f);
    return part * real_of_bits((real_int(whole) + 127) * 8388608);
}

/* For light up to 1. */
REAL_FN real tonemap_encode(real linear)
{
    real power = tonemap_power(real_max(linear, real_all(0.0031308f)), 1.0f / 2.4f);
    return real_select(linear <= 0.0031308f, linear * 12.92f, 1.055f * power - 0.055f);
}

/* Encodes root^2.2, for roots up to 1; both parts of the curve are powers of the root. Each is a
 * polynomial, the best of its degree. The upper one is exact at 1, the lower one at 0. */
REAL_FN real tonemap_encode_root(real root)
{
    real x = real_max(root, real_all(0.0f)), z = 1.0f - x;
    real x2 = x * x, z2 = z * z;
    real low = (5.59140015f * x - 0.00840468146f) + x2 * (41.2689133f - 156.960541f * x);
    real higher = (1.61403477f - 1.45597887f * z) + z2 * 0.528714836f;
    real high = (0.968429267f + 0.00884623732f * z) + z2 * (0.259641021f - 0.873366237f * z);
    high = high + (z2 * z2) * higher;
    low = real_max(low * x, real_all(0.0f));
    return real_select(x <= 0.0727213f, low, 1.0f - high * z); /* 0.0031308^(1 / 2.2) */
}

/* ---- alpha ----------------------------------------------------------------------------------- */

/* Colour that is not premultiplied, and its alpha. */
struct tonemap_straight {
    real3 color;
    real alpha;
};

/* Divides light by its alpha, as a renderer multiplies a texture: before the encoding. Light
 * brighter than its alpha, such as fire over nothing, has its brightness as alpha. root: what the
 * light is a power of: 2.2 for tonemap_agx_root, else 1. */
REAL_FN S(tonemap_straight) tonemap_straight_of(real3 shown, real alpha, float root)
{
    real least = real_all(1e-6f);
    real brightest = real_max(real_max(shown.x, shown.y), shown.z);
    real light = tonemap_power(real_clamp(brightest, 1e-6f, 1.0f), root);
    S(tonemap_straight) straight;
    straight.alpha = real_clamp01(real_max(alpha, real_where(brightest > 1e-6f, light)));
    real divisor = tonemap_power(real_max(straight.alpha, least), 1.0f / root);
    straight.color = real3_scale(shown, 1.0f / divisor);
    return straight;
}

/* ---- dither ---------------------------------------------------------------------------------- */

/* A display level has 64 steps. Triangular noise of -31 to 31 steps is the sum of two numbers of 5
 * bits less their mean. A word has three such sums, one for each colour, in fields of 10 bits. With
 * the noise, white stays white and black stays black. */
#define TONEMAP_STEPS        64.0f
#define TONEMAP_NOISE_FIELDS 0x01f07c1fu /* the bits of one of the two numbers of each colour */
#define TONEMAP_NOISE_NONE   0x01f07c1f  /* the sums that displace nothing */
#define TONEMAP_NOISE_BIAS   1.0f        /* half a level, less the mean of a sum */

#endif
