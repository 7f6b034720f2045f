/* Curl noise: a divergence-free field that looks like turbulence, for wind (Bridson et al., "Curl-
 * Noise for Procedural Fluid Flow", 2007). It is the curl of a vector potential whose three parts
 * are gradient noises; here the curl is taken analytically, corner by corner, so that the three
 * share hashes and weights.
 */
#ifndef KILN_SHARED_NOISE_H
#define KILN_SHARED_NOISE_H

#include "shared/random.h"

/* Coordinates beyond this have too few bits left between lattice points: the field is zero there.
 */
#define NOISE_REACH_BITS 0x49800000u /* 2^20 */

/* Brings the root of the mean square speed of one octave to 1. */
#define NOISE_CURL_UNIT 0.20658f

/* The weight of the upper lattice point along one axis at fraction t, C2-continuous, and its slope.
 */
struct noise_fade {
    float weight, slope;
};

FN S(noise_fade) noise_fade_at(float t)
{
    EXACT S(noise_fade) fade;
    EXACT float square = t * t;
    fade.weight = square * t * (10.0f + t * (6.0f * t - 15.0f));
    fade.slope = 30.0f * square * (1.0f + t * (t - 2.0f));
    return fade;
}

/* A gradient from 9 bits: each component one of -3.5, -2.5 .. 3.5. */
FN float3 noise_gradient(uint bits)
{
    EXACT float3 g = FLOAT3(FLOAT(bits & 7u) - 3.5f, FLOAT((bits >> 3u) & 7u) - 3.5f,
                            FLOAT((bits >> 6u) & 7u) - 3.5f);
    return g;
}

/* One corner's part of the curl of the potential (n1, n2, n3), each a sum of weight * (g . r): with
 * V the three products g . r it is weight * curl(V) + grad(weight) x V. */
FN float3 noise_curl_corner(uint bits, float3 r, float weight, float3 slope)
{
    EXACT float3 g1 = noise_gradient(bits);
    EXACT float3 g2 = noise_gradient(bits >> 9u);
    EXACT float3 g3 = noise_gradient(bits >> 18u);
    EXACT float3 v = FLOAT3(float3_dot(g1, r), float3_dot(g2, r), float3_dot(g3, r));
    EXACT float3 k = FLOAT3(g3.y - g2.z, g1.z - g3.x, g2.x - g1.y);
    EXACT float3 turned = float3_cross(slope, v);
    EXACT float3 y = float3_add_scaled(turned, k, weight);
    return y;
}

/* One octave with lattice points one unit apart, root of mean square speed about 1. */
FN float3 noise_curl_octave(float3 p, uint seed)
{
    EXACT float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
    if ((FLOAT_BITS(p.x) & EXACT_SIZE_BITS) > NOISE_REACH_BITS ||
        (FLOAT_BITS(p.y) & EXACT_SIZE_BITS) > NOISE_REACH_BITS ||
        (FLOAT_BITS(p.z) & EXACT_SIZE_BITS) > NOISE_REACH_BITS)
        return sum;
    EXACT float3 cell = FLOAT3(FLOOR(p.x), FLOOR(p.y), FLOOR(p.z));
    EXACT float3 f = float3_sub(p, cell);
    EXACT S(noise_fade) fx = noise_fade_at(f.x);
    EXACT S(noise_fade) fy = noise_fade_at(f.y);
    EXACT S(noise_fade) fz = noise_fade_at(f.z);
    uint base = UINT(INT(cell.x)) * 0x8da6b343u + UINT(INT(cell.y)) * 0xd8163841u +
                UINT(INT(cell.z)) * 0xcb1ab31fu + seed;
    for (uint corner = 0u; corner < 8u; corner++) {
        bool ux = (corner & 1u) != 0u;
        bool uy = (corner & 2u) != 0u;
        bool uz = (corner & 4u) != 0u;
        EXACT float wx = ux ? fx.weight : 1.0f - fx.weight;
        EXACT float wy = uy ? fy.weight : 1.0f - fy.weight;
        EXACT float wz = uz ? fz.weight : 1.0f - fz.weight;
        EXACT float sx = ux ? fx.slope : -fx.slope;
        EXACT float sy = uy ? fy.slope : -fy.slope;
        EXACT float sz = uz ? fz.slope : -fz.slope;
        EXACT float3 slope = FLOAT3(sx * wy * wz, sy * wx * wz, sz * wx * wy);
        EXACT float3 r =
            FLOAT3(f.x - (ux ? 1.0f : 0.0f), f.y - (uy ? 1.0f : 0.0f), f.z - (uz ? 1.0f : 0.0f));
        EXACT float weight = wx * wy * wz;
        uint at =
            base + (ux ? 0x8da6b343u : 0u) + (uy ? 0xd8163841u : 0u) + (uz ? 0xcb1ab31fu : 0u);
        EXACT float3 part = noise_curl_corner(random_mix(at), r, weight, slope);
        sum = float3_add(sum, part);
    }
    EXACT float3 y = float3_scale(sum, NOISE_CURL_UNIT);
    return y;
}

/* Up to 4 octaves, each of half the size and half the speed of the one before. */
FN float3 noise_curl(float3 p, uint seed, uint octaves)
{
    EXACT float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float frequency = 1.0f;
    EXACT float speed = 1.0f;
    for (uint octave = 0u; octave < octaves && octave < 4u; octave++) {
        EXACT float3 q = float3_scale(p, frequency);
        EXACT float3 part = noise_curl_octave(q, random_mix(seed + octave));
        sum = float3_add_scaled(sum, part, speed);
        frequency = frequency * 2.0f;
        speed = speed * 0.5f;
    }
    return sum;
}

#endif
