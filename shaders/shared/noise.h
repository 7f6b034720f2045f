/* Computes curl noise, a divergence-free field that looks like turbulence, for wind (Bridson et
 * al., "Curl-Noise for Procedural Fluid Flow", 2007). It is the curl of a vector potential of three
 * gradient noises. The curl is taken analytically, corner by corner, so that the three noises share
 * hashes and weights. */
#ifndef KILN_SHARED_NOISE_H
#define KILN_SHARED_NOISE_H

#include "shared/random.h"

/* Limit of coordinates: beyond it, too few bits are left between lattice points, and the field is
 * zero. */
#define NOISE_REACH_BITS 0x49800000u /* 2^20 */

/* Odd numbers that spread the lattice points over the hash's arguments. */
#define NOISE_X 0x8da6b343u
#define NOISE_Y 0xd8163841u
#define NOISE_Z 0xcb1ab31fu

/* Brings the root of the mean square speed of one octave to 1. */
#define NOISE_CURL_UNIT 0.20658f

/* The weight of the upper lattice point along one axis at fraction t, C2-continuous, and the
 * weight's slope. */
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

/* Returns a gradient from 9 bits: each component is one of -3.5, -2.5 .. 3.5. */
FN float3 noise_gradient(uint bits)
{
    EXACT float3 g = FLOAT3(FLOAT(INT(bits & 7u)) - 3.5f, FLOAT(INT((bits >> 3u) & 7u)) - 3.5f,
                            FLOAT(INT((bits >> 6u) & 7u)) - 3.5f);
    return g;
}

/* Returns one corner's part of the curl of the potential (n1, n2, n3), whose components are sums of
 * weight * (g . r). With V the three products g . r, it is weight * curl(V) + grad(weight) x V. */
FN float3 noise_curl_corner(uint bits, float3 r, float weight, float3 slope)
{
    EXACT float3 g1 = noise_gradient(bits);
    EXACT float3 g2 = noise_gradient(bits >> 9u);
    EXACT float3 g3 = noise_gradient(bits >> 18u);
    EXACT float3 v = FLOAT3(float3_dot(g1, r), float3_dot(g2, r), float3_dot(g3, r));
    EXACT float3 k = FLOAT3(g3.y - g2.z, g1.z - g3.x, g2.x - g1.y);
    EXACT float3 slope_part = float3_cross(slope, v);
    EXACT float3 y = float3_add_scaled(slope_part, k, weight);
    return y;
}

/* A point's place in its lattice cell. */
struct noise_cell {
    uint lattice; /* hash argument of the lowest corner */
    float3 part;  /* part of the way to the highest corner */
    S(noise_fade) x, y, z;
};

FN S(noise_cell) noise_cell_at(float3 p, uint seed)
{
    EXACT S(noise_cell) cell;
    EXACT float3 low = FLOAT3(FLOOR(p.x), FLOOR(p.y), FLOOR(p.z));
    cell.lattice =
        UINT(INT(low.x)) * NOISE_X + UINT(INT(low.y)) * NOISE_Y + UINT(INT(low.z)) * NOISE_Z + seed;
    cell.part = float3_sub(p, low);
    cell.x = noise_fade_at(cell.part.x);
    cell.y = noise_fade_at(cell.part.y);
    cell.z = noise_fade_at(cell.part.z);
    return cell;
}

/* Returns the fade of a corner: mirrored for a lower corner. */
FN S(noise_fade) noise_fade_of_corner(S(noise_fade) fade, bool upper)
{
    EXACT S(noise_fade) own;
    own.weight = upper ? fade.weight : 1.0f - fade.weight;
    own.slope = upper ? fade.slope : -fade.slope;
    return own;
}

/* Returns the part of corner 0 to 7: bit 0 is the upper one in x, bit 1 in y, bit 2 in z. */
FN float3 noise_curl_of_corner(S(noise_cell) cell, uint corner)
{
    uint ux = corner & 1u;
    uint uy = (corner >> 1u) & 1u;
    uint uz = corner >> 2u;
    EXACT S(noise_fade) x = noise_fade_of_corner(cell.x, ux != 0u);
    EXACT S(noise_fade) y = noise_fade_of_corner(cell.y, uy != 0u);
    EXACT S(noise_fade) z = noise_fade_of_corner(cell.z, uz != 0u);
    EXACT float3 slope = FLOAT3(x.slope * y.weight * z.weight, y.slope * x.weight * z.weight,
                                z.slope * x.weight * y.weight);
    EXACT float3 r =
        FLOAT3(cell.part.x - FLOAT(ux), cell.part.y - FLOAT(uy), cell.part.z - FLOAT(uz));
    EXACT float weight = x.weight * y.weight * z.weight;
    uint lattice = cell.lattice + ux * NOISE_X + uy * NOISE_Y + uz * NOISE_Z;
    return noise_curl_corner(random_mix(lattice), r, weight, slope);
}

FN bool noise_reaches(float3 p)
{
    return (FLOAT_BITS(p.x) & EXACT_SIZE_BITS) <= NOISE_REACH_BITS &&
           (FLOAT_BITS(p.y) & EXACT_SIZE_BITS) <= NOISE_REACH_BITS &&
           (FLOAT_BITS(p.z) & EXACT_SIZE_BITS) <= NOISE_REACH_BITS;
}

/* Sums up all corners. The sum is written out, so that in C a loop over particles becomes vectors
 * of particles. */
FN float3 noise_curl_of_corners(S(noise_cell) cell)
{
    EXACT float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float3 part = noise_curl_of_corner(cell, 0u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 1u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 2u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 3u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 4u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 5u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 6u);
    sum = float3_add(sum, part);
    part = noise_curl_of_corner(cell, 7u);
    sum = float3_add(sum, part);
    return sum;
}

/* Returns one octave with lattice points one unit apart; the root of its mean square speed is about
 * 1. */
FN float3 noise_curl_octave(float3 p, uint seed)
{
    bool reached = noise_reaches(p);
    EXACT float3 near = FLOAT3(reached ? p.x : 0.0f, reached ? p.y : 0.0f, reached ? p.z : 0.0f);
    EXACT S(noise_cell) cell = noise_cell_at(near, seed);
    EXACT float3 sum = noise_curl_of_corners(cell);
    EXACT float3 scaled = float3_scale(sum, NOISE_CURL_UNIT);
    EXACT float3 y =
        FLOAT3(reached ? scaled.x : 0.0f, reached ? scaled.y : 0.0f, reached ? scaled.z : 0.0f);
    return y;
}

#define NOISE_OCTAVES 4u

/* Adds an octave, 0 to NOISE_OCTAVES - 1: each of half the size and half the speed of the one
 * before. */
FN float3 noise_curl_add(float3 sum, float3 p, uint seed, uint octave)
{
    EXACT float frequency = FLOAT(1u << octave);
    EXACT float speed = BITS_FLOAT((127u - octave) << 23u);
    EXACT float3 q = float3_scale(p, frequency);
    EXACT float3 part = noise_curl_octave(q, random_mix(seed + octave));
    EXACT float3 y = float3_add_scaled(sum, part, speed);
    return y;
}

FN float3 noise_curl(float3 p, uint seed, uint octaves)
{
    EXACT float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
    for (uint octave = 0u; octave < octaves && octave < NOISE_OCTAVES; octave++)
        sum = noise_curl_add(sum, p, seed, octave);
    return sum;
}

#endif
