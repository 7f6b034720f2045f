/* Gradient noise over the lattice of the wind field's curl noise. */
#include "asset/turbulence.h"

#include "base/vector.h"
#include "shared/noise.h"

#include <math.h>

KILN_WIDE_VECTORS
float kiln_noise(float x, float y, float z, uint32_t seed)
{
    enum { CORNERS = 8 };
    float3 p = {x, y, z};
    float3 cell = {floorf(x), floorf(y), floorf(z)};
    float3 f = float3_sub(p, cell);
    float wx[2], wy[2], wz[2];
    wx[1] = noise_fade_at(f.x).weight;
    wy[1] = noise_fade_at(f.y).weight;
    wz[1] = noise_fade_at(f.z).weight;
    wx[0] = 1.0f - wx[1];
    wy[0] = 1.0f - wy[1];
    wz[0] = 1.0f - wz[1];
    /* All corners at once: tables instead of branches, so that the loop becomes vectors. */
    static const uint32_t I[CORNERS] = {0, 1, 0, 1, 0, 1, 0, 1};
    static const uint32_t J[CORNERS] = {0, 0, 1, 1, 0, 0, 1, 1};
    static const uint32_t K[CORNERS] = {0, 0, 0, 0, 1, 1, 1, 1};
    uint32_t cx = (uint32_t)(int)cell.x, cy = (uint32_t)(int)cell.y, cz = (uint32_t)(int)cell.z;
    float parts[CORNERS];
#pragma GCC unroll 1
    for (int c = 0; c < CORNERS; c++) {
        float i = (float)(int)I[c], j = (float)(int)J[c], k = (float)(int)K[c];
        uint32_t at = (cx + I[c]) * NOISE_X ^ (cy + J[c]) * NOISE_Y ^ (cz + K[c]) * NOISE_Z ^ seed;
        float3 gradient = noise_gradient(random_mix(at));
        float3 away = {f.x - i, f.y - j, f.z - k};
        /* Exact, since i, j and k are 0 or 1. */
        float weight = ((1.0f - i) * wx[0] + i * wx[1]) * ((1.0f - j) * wy[0] + j * wy[1]) *
                       ((1.0f - k) * wz[0] + k * wz[1]);
        parts[c] = weight * float3_dot(gradient, away);
    }
    float sum = 0.0f;
    for (int corner = 0; corner < CORNERS; corner++)
        sum += parts[corner];
    return 0.32f * sum;
}

float kiln_noise_octaves(float x, float y, float z, int count, uint32_t seed)
{
    float sum = 0.0f, total = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < count; i++) {
        sum += amplitude * kiln_noise(x, y, z, seed + (uint32_t)i);
        total += amplitude;
        amplitude *= 0.5f;
        x = 2.03f * x + 1.7f;
        y = 2.03f * y - 3.1f;
        z = 1.6f * z + 0.7f;
    }
    return sum / total;
}

float kiln_noise_ridges(float x, float y, float z, int count, uint32_t seed)
{
    float sum = 0.0f, total = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < count; i++) {
        float ridge = exact_max(0.0f, 1.0f - 1.9f * fabsf(kiln_noise(x, y, z, seed + (uint32_t)i)));
        sum += amplitude * ridge * ridge;
        total += amplitude;
        amplitude *= 0.55f;
        x = 2.07f * x + 1.7f;
        y = 2.07f * y - 3.1f;
        z = 1.5f * z + 0.7f;
    }
    return sum / total;
}
