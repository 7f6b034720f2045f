/* This header computes gradient noise for vectors of points (Perlin, "Improving Noise", 2002), by
 * which gas is drawn finer than it is simulated. */
#ifndef KILN_DRAW_VOLUME_VOLUME_NOISE_H
#define KILN_DRAW_VOLUME_VOLUME_NOISE_H

#include "base/lane_math.h"
#include "shared/gas_detail.h"

/* Returns random bits for points of the lattice. */
SIMD vu noise_bits(vu x, vu y, vu z)
{
    vu h = x * 0x8da6b343u + y * 0xd8163841u + z * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

/* Returns the product of the gradient at a point of the lattice and the way from there. Each
 * component of the gradient is one of -3.5, -2.5 .. 3.5. */
SIMD vf noise_slope(vu bits, vf x, vf y, vf z)
{
    const vf a = __builtin_convertvector((vi)(bits & 7), vf) - 3.5f;
    const vf b = __builtin_convertvector((vi)(bits >> 3 & 7), vf) - 3.5f;
    const vf c = __builtin_convertvector((vi)(bits >> 6 & 7), vf) - 3.5f;
    return a * x + b * y + c * z;
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
    const vu ix = (vu)vi_of(low[0]), iy = (vu)vi_of(low[1]), iz = (vu)vi_of(low[2]);
    const vf u = noise_fade_of(x), v = noise_fade_of(y), w = noise_fade_of(z);
    vf planes[2];
    for (uint32_t k = 0; k < 2; k++) {
        vf rows[2];
        for (uint32_t j = 0; j < 2; j++) {
            const vf a = noise_slope(noise_bits(ix, iy + j, iz + k), x, y - (float)j, z - (float)k);
            const vf b = noise_slope(noise_bits(ix + 1, iy + j, iz + k), x - 1.0f, y - (float)j,
                                     z - (float)k);
            rows[j] = a + (b - a) * u;
        }
        planes[k] = rows[0] + (rows[1] - rows[0]) * v;
    }
    return GAS_NOISE_UNIT * (planes[0] + (planes[1] - planes[0]) * w);
}

#endif
