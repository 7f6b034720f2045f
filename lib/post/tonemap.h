/* This header maps scene-linear Rec. 709 to display-linear Rec. 709 and to sRGB on the host, as
 * shaders/post/tonemap.glsl does in GL; that file explains the numbers. It has no branches, so that
 * compilers vectorise loops over pixels. */
#ifndef KILN_POST_TONEMAP_H
#define KILN_POST_TONEMAP_H

#include "shared/exact.h"

/* Returns the product of a matrix's row (x, y, z) and a colour. */
static inline float kiln_tonemap_row(float x, float y, float z, float3 color)
{
    return x * color.x + y * color.y + z * color.z;
}

static inline float kiln_tonemap_agx_channel(float x)
{
    const float min_ev = -12.47393f, max_ev = 4.026069f;
    float v = (exact_log2(exact_max(x, 1e-10f)) - min_ev) * (1.0f / (max_ev - min_ev));
    v = exact_clamp(v, 0.0f, 1.0f);
    float v2 = v * v, v4 = v2 * v2;
    return 15.5f * v4 * v2 - 40.14f * v4 * v + 31.96f * v4 - 6.868f * v2 * v + 0.4298f * v2 +
           0.1191f * v - 0.00232f;
}

/* Returns the display's light to the power of 1 / 2.2, for kiln_encode_root. Taking the power only
 * to encode it again would cost two logarithms and exponentials instead of one. */
static inline float3 kiln_tonemap_agx_root(float3 color)
{
    float3 v;
    v.x = kiln_tonemap_agx_channel(
        kiln_tonemap_row(0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f, color));
    v.y = kiln_tonemap_agx_channel(
        kiln_tonemap_row(0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f, color));
    v.z = kiln_tonemap_agx_channel(
        kiln_tonemap_row(0.0423756549057051f, 0.0784336f, 0.879142973793104f, color));
    float3 out;
    out.x = kiln_tonemap_row(1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f, v);
    out.y = kiln_tonemap_row(-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f, v);
    out.z = kiln_tonemap_row(-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f, v);
    return out;
}

static inline float kiln_tonemap_aces_channel(float v)
{
    float above = v * (v + 0.0245786f) - 0.000090537f;
    float below = v * (0.983729f * v + 0.4329510f) + 0.238081f;
    return above / below;
}

static inline float3 kiln_tonemap_aces(float3 color)
{
    float3 v;
    v.x = kiln_tonemap_aces_channel(kiln_tonemap_row(0.59719f, 0.35458f, 0.04823f, color));
    v.y = kiln_tonemap_aces_channel(kiln_tonemap_row(0.07600f, 0.90834f, 0.01566f, color));
    v.z = kiln_tonemap_aces_channel(kiln_tonemap_row(0.02840f, 0.13383f, 0.83777f, color));
    float3 out;
    out.x = exact_clamp(kiln_tonemap_row(1.60475f, -0.53108f, -0.07367f, v), 0.0f, 1.0f);
    out.y = exact_clamp(kiln_tonemap_row(-0.10208f, 1.10813f, -0.00605f, v), 0.0f, 1.0f);
    out.z = exact_clamp(kiln_tonemap_row(-0.00327f, -0.07276f, 1.07602f, v), 0.0f, 1.0f);
    return out;
}

/* Encodes linear light as sRGB (IEC 61966-2-1). */
static inline float kiln_encode_srgb(float linear)
{
    float low = linear * 12.92f;
    float high = 1.055f * exact_pow(exact_max(linear, 0.0031308f), 1.0f / 2.4f) - 0.055f;
    return linear <= 0.0031308f ? low : high;
}

/* Encodes root^2.2 as sRGB; both parts of the curve are powers of the root. */
static inline float kiln_encode_root(float root)
{
    bool is_low = root <= 0.0727213f; /* 0.0031308^(1 / 2.2) */
    float power = exact_pow(root, is_low ? 2.2f : 2.2f / 2.4f);
    return is_low ? 12.92f * power : 1.055f * power - 0.055f;
}

#endif
