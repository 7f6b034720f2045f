/* Maps scene-linear Rec. 709 to display-linear Rec. 709 and to sRGB, both 0 to 1. It has no
 * branches, so that compilers vectorise loops over pixels. */
#ifndef KILN_SHARED_TONEMAP_H
#define KILN_SHARED_TONEMAP_H

#include "shared/real.h"

/* Returns the product of a matrix's row (x, y, z) and a colour. */
REAL_FN real tonemap_row(float x, float y, float z, real3 color)
{
    return x * color.x + y * color.y + z * color.z;
}

/* ---- AgX ------------------------------------------------------------------------------------- */

/* AgX by Troy Sobotka: colours are desaturated into a smaller gamut, a sigmoid acts on their
 * logarithm, and the gamut is opened again. The matrices and the polynomial that stands for the
 * sigmoid are Benjamin Wrensch's fit ("Minimal AgX implementation", 2023; mean error 1e-6), whose
 * result is encoded with gamma 2.2. */
REAL_FN real tonemap_agx_channel(real x)
{
    const float min_ev = -12.47393f, max_ev = 4.026069f;
    real v = (real_log2(real_max(x, real_all(1e-10f))) - min_ev) * (1.0f / (max_ev - min_ev));
    v = real_clamp01(v);
    real v2 = v * v, v4 = v2 * v2;
    return 15.5f * v4 * v2 - 40.14f * v4 * v + 31.96f * v4 - 6.868f * v2 * v + 0.4298f * v2 +
           0.1191f * v - 0.00232f;
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

REAL_FN real tonemap_encode(real linear)
{
    real low = linear * 12.92f;
    real high =
        1.055f * real_pow(real_max(linear, real_all(0.0031308f)), real_all(1.0f / 2.4f)) - 0.055f;
    return real_select(linear <= 0.0031308f, low, high);
}

/* Encodes root^2.2; both parts of the curve are powers of the root. */
REAL_FN real tonemap_encode_root(real root)
{
    truth is_low = root <= 0.0727213f; /* 0.0031308^(1 / 2.2) */
    real power = real_pow(root, real_select(is_low, real_all(2.2f), real_all(2.2f / 2.4f)));
    return real_select(is_low, 12.92f * power, 1.055f * power - 0.055f);
}

#endif
