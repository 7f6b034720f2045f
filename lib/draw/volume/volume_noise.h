/* This header computes gradient noise for vectors of points (Perlin, "Improving Noise", 2002), by
 * which gas is drawn finer than it is simulated. */
#ifndef KILN_DRAW_VOLUME_VOLUME_NOISE_H
#define KILN_DRAW_VOLUME_VOLUME_NOISE_H

#include "base/lane_math.h"
#include "shared/gas_detail.h"

/* The factors by which the coordinates of a point of the lattice are summed. */
#define NOISE_X 0x8da6b343u
#define NOISE_Y 0xd8163841u
#define NOISE_Z 0xcb1ab31fu

/* Returns random bits for points of the lattice. sum: of the coordinates times their factors. */
SIMD vu noise_bits(vu sum)
{
    vu h = (sum ^ sum >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

/* Returns a component of a gradient by the lowest three of some bits: -3.5, -2.5 .. 3.5. */
SIMD vf noise_component(vu bits)
{
#ifdef KILN_LEVEL_AVX2
    const __m256 components = _mm256_setr_ps(-3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f);
    return (vf)_mm256_permutevar8x32_ps(components, (__m256i)bits);
#else
    return vf_of((vi)(bits & 7)) - 3.5f;
#endif
}

/* Returns the product of the gradient at a point of the lattice and the way from there. */
SIMD vf noise_slope(vu bits, vf x, vf y, vf z)
{
    return noise_component(bits) * x + noise_component(bits >> 3) * y +
           noise_component(bits >> 6) * z;
}

SIMD vf noise_fade_of(vf t)
{
    return t * t * t * (10.0f + t * (6.0f * t - 15.0f));
}

/* Returns noise with mean 0 and mean square 1 at a place, in cells of its lattice. */
SIMD_ONCE vf noise_at(struct vf3 place)
{
    const vf low[3] = {vf_floor(place.x), vf_floor(place.y), vf_floor(place.z)};
    const vf x = place.x - low[0], y = place.y - low[1], z = place.z - low[2];
    const vu at =
        (vu)vi_of(low[0]) * NOISE_X + (vu)vi_of(low[1]) * NOISE_Y + (vu)vi_of(low[2]) * NOISE_Z;
    const vf u = noise_fade_of(x), v = noise_fade_of(y), w = noise_fade_of(z);
    vf planes[2];
    for (uint32_t k = 0; k < 2; k++) {
        vf rows[2];
        for (uint32_t j = 0; j < 2; j++) {
            const vu corner = at + (j * NOISE_Y + k * NOISE_Z);
            const vf from_y = y - (float)j, from_z = z - (float)k;
            const vf a = noise_slope(noise_bits(corner), x, from_y, from_z);
            const vf b = noise_slope(noise_bits(corner + NOISE_X), x - 1.0f, from_y, from_z);
            rows[j] = a + (b - a) * u;
        }
        planes[k] = rows[0] + (rows[1] - rows[0]) * v;
    }
    return GAS_NOISE_UNIT * (planes[0] + (planes[1] - planes[0]) * w);
}

#endif
