/* Computes the exactness probe from one vector of bits, on the device and in C: every rule of
 * arithmetic that the simulation relies on, each result as a word. */
#ifndef KILN_SHARED_PROBE_H
#define KILN_SHARED_PROBE_H

#include "shared/noise.h"

#define PROBE_WORDS 32

/* Storage blocks, and the location of a uniform, in the compute stage. */
#define PROBE_BIND_VECTORS 0
#define PROBE_BIND_RESULTS 1
#define PROBE_AT_COUNT     0

struct probe_result {
    uint4 sums;   /* a + b, a - b, a * b, a * b + c, of numbers from probe_plain */
    uint4 orders; /* min, max, floor, comparisons */
    uint4 roots;  /* rcp, div, sqrt, rsqrt, of any bits */
    uint4 curves; /* sine, cosine, exp, canon, of any bits */
    uint4 unit;   /* normalised vector, its square */
    uint4 cross;  /* cross product, lerp */
    uint4 noise;  /* curl noise, hash */
    uint4 around; /* random direction, random number */
};

/* Returns a result as a word: denormals and -0 become 0, and all NaNs are alike. */
FN uint probe_word(float x)
{
    uint bits = FLOAT_BITS(x);
    if ((bits & EXACT_SIZE_BITS) > 0x7f800000u)
        return 0x7fc00000u;
    return exact_is_tiny(x) ? 0u : bits;
}

/* Returns a number between 2^-60 and 2^60 with the sign and the digits of the bits. The state has
 * no denormals, and a particle whose numbers overflow dies. */
FN float probe_plain(uint bits)
{
    uint exponent = 67u + ((bits >> 23u) & 255u) % 120u;
    EXACT float x = BITS_FLOAT((bits & 0x807fffffu) | (exponent << 23u));
    return x;
}

FN uint4 probe_float3(float3 v, float w)
{
    return UINT4(probe_word(v.x), probe_word(v.y), probe_word(v.z), probe_word(w));
}

FN uint probe_compare(float a, float b)
{
    return (a < b ? 1u : 0u) | (a <= b ? 2u : 0u) | (a > b ? 4u : 0u) | (a == b ? 8u : 0u);
}

FN S(probe_result) probe_run(uint4 v)
{
    S(probe_result) r;
    EXACT float a = probe_plain(v.x);
    EXACT float b = probe_plain(v.y);
    EXACT float c = probe_plain(v.z);
    EXACT float sum = a + b;
    EXACT float difference = a - b;
    EXACT float product = a * b;
    EXACT float both = a * b + c;
    r.sums = UINT4(probe_word(sum), probe_word(difference), probe_word(product), probe_word(both));

    EXACT float small = INT(v.x & 0xffffffu) == 0 ? 0.0f : random_to_unit(v.x) * 2048.0f - 1024.0f;
    EXACT float whole = FLOOR(small);
    r.orders = UINT4(probe_word(exact_min(a, b)), probe_word(exact_max(a, b)),
                     UINT(INT(whole) + 4096), probe_compare(a, b));

    EXACT float any_a = BITS_FLOAT(v.x);
    EXACT float any_b = BITS_FLOAT(v.y);
    r.roots = UINT4(probe_word(exact_rcp(any_a)), probe_word(exact_div(a, any_b)),
                    probe_word(exact_sqrt(any_a)), probe_word(exact_rsqrt(any_a)));
    EXACT S(exact_angle) angle = exact_sincos(any_a);
    r.curves = UINT4(probe_word(angle.sine), probe_word(angle.cosine), probe_word(exact_exp(any_a)),
                     probe_word(exact_canon(any_a)));

    EXACT float3 p = FLOAT3(a, b, c);
    EXACT float3 q = FLOAT3(c, a, 1.0f);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 unit = float3_normalize(p, up);
    r.unit = probe_float3(unit, float3_dot(p, p));
    EXACT float3 cross = float3_cross(p, q);
    EXACT float part = random_unit(v.x, v.y);
    r.cross = probe_float3(cross, exact_lerp(a, b, part));

    EXACT float3 at =
        FLOAT3(random_to_unit(v.x) * 64.0f - 32.0f, random_to_unit(v.y) * 64.0f - 32.0f,
               random_to_unit(v.z) * 64.0f - 32.0f);
    EXACT float3 curl = noise_curl(at, v.w, 2u);
    r.noise = probe_float3(curl, 0.0f);
    r.noise.w = random_bits(v.x, v.w);
    EXACT float cosine = part * 2.0f - 1.0f;
    EXACT float3 around = random_direction(v.z, v.w, unit, cosine);
    r.around = probe_float3(around, part);
    return r;
}

#endif
