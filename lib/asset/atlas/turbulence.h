/* Computes gradient noise for the procedural flipbooks at many points at once, over the lattice of
 * the wind field's curl noise. It is for files *_simd.c. The bits are the same at every level of
 * vectors. */
#ifndef KILN_ASSET_ATLAS_TURBULENCE_H
#define KILN_ASSET_ATLAS_TURBULENCE_H

#include <stddef.h>
#include <stdint.h>

#include "asset/atlas/fluid.h"
#include "shared/noise.h"

/* Points come in rows, filled up to a multiple of TURBULENCE_BLOCK with any finite numbers. */
enum { TURBULENCE_BLOCK = 16, TURBULENCE_ROW = 128 };

/* Hashes and weights of the two lattice points around a point along one axis, and the distances
 * from them. */
struct noise_place {
    uint32_t hash[2];
    float weight[2], away[2];
};

static inline int32_t noise_floor(float x)
{
    int32_t cell = (int32_t)x;
    return (float)cell > x ? cell - 1 : cell;
}

static inline struct noise_place noise_place_at(float x, uint32_t spread)
{
    int32_t cell = noise_floor(x);
    uint32_t low = (uint32_t)cell * spread;
    float part = x - (float)cell, upper = noise_fade_at(part).weight;
    return (struct noise_place){{low, low + spread}, {1.0f - upper, upper}, {part, part - 1.0f}};
}

/* Returns a component of noise_gradient, from the lowest bits of a hash. */
static inline float noise_slope(uint32_t bits)
{
    return (float)(int32_t)(bits & 7u) - 3.5f;
}

static inline float noise_corner(const struct noise_place *x, const struct noise_place *y,
                                 const struct noise_place *z, int i, int j, int k)
{
    uint32_t bits = random_mix(x->hash[i] ^ y->hash[j] ^ z->hash[k]);
    float weight = x->weight[i] * y->weight[j] * z->weight[k];
    return weight * (noise_slope(bits) * x->away[i] + noise_slope(bits >> 3) * y->away[j] +
                     noise_slope(bits >> 6) * z->away[k]);
}

/* Computes noise at (x, y, z) with lattice points one unit apart. It lies within about -1 and 1, 0
 * on average. Points may be up to 2^24 away. */
static inline void turbulence(const float *restrict x, const float *restrict y, float z,
                              uint32_t seed, size_t count, float *restrict out)
{
    struct noise_place pz = noise_place_at(z, NOISE_Z);
    pz.hash[0] ^= seed;
    pz.hash[1] ^= seed;
    for (size_t i = 0; i < count; i++) {
        struct noise_place px = noise_place_at(x[i], NOISE_X), py = noise_place_at(y[i], NOISE_Y);
        float sum = 0.0f;
        sum += noise_corner(&px, &py, &pz, 0, 0, 0);
        sum += noise_corner(&px, &py, &pz, 1, 0, 0);
        sum += noise_corner(&px, &py, &pz, 0, 1, 0);
        sum += noise_corner(&px, &py, &pz, 1, 1, 0);
        sum += noise_corner(&px, &py, &pz, 0, 0, 1);
        sum += noise_corner(&px, &py, &pz, 1, 0, 1);
        sum += noise_corner(&px, &py, &pz, 0, 1, 1);
        sum += noise_corner(&px, &py, &pz, 1, 1, 1);
        out[i] = 0.32f * sum;
    }
}

static inline float turbulence_at(float x, float y, float z, uint32_t seed)
{
    float row_x[TURBULENCE_BLOCK] = {x}, row_y[TURBULENCE_BLOCK] = {y}, out[TURBULENCE_BLOCK];
    turbulence(row_x, row_y, z, seed, TURBULENCE_BLOCK, out);
    return out[0];
}

/* Holds one octave and the sum of octaves so far. */
struct turbulence_sum {
    float x[TURBULENCE_ROW], y[TURBULENCE_ROW], z;
    float noise[TURBULENCE_ROW];
    float total, amplitude;
};

static inline void turbulence_begin(struct turbulence_sum *sum, const float *x, const float *y,
                                    float z, size_t count, float *out)
{
    sum->z = z;
    sum->total = 0.0f;
    sum->amplitude = 1.0f;
    for (size_t i = 0; i < count; i++) {
        sum->x[i] = x[i];
        sum->y[i] = y[i];
        out[i] = 0.0f;
    }
}

static inline void turbulence_next(struct turbulence_sum *sum, float finer, float deeper,
                                   float weaker, size_t count)
{
    sum->total += sum->amplitude;
    sum->amplitude *= weaker;
    sum->z = deeper * sum->z + 0.7f;
    for (size_t i = 0; i < count; i++) {
        sum->x[i] = finer * sum->x[i] + 1.7f;
        sum->y[i] = finer * sum->y[i] - 3.1f;
    }
}

/* Computes the mean of octaves of noise, each half as large and half as strong as the one before. z
 * grows more slowly than x and y, so that small detail does not boil when z is time. */
static inline void turbulence_octaves(const float *x, const float *y, float z, int octaves,
                                      uint32_t seed, size_t count, float *out)
{
    struct turbulence_sum sum;
    turbulence_begin(&sum, x, y, z, count, out);
    for (int octave = 0; octave < octaves; octave++) {
        turbulence(sum.x, sum.y, sum.z, seed + (uint32_t)octave, count, sum.noise);
        for (size_t i = 0; i < count; i++)
            out[i] += sum.amplitude * sum.noise[i];
        turbulence_next(&sum, 2.03f, 1.6f, 0.5f, count);
    }
    for (size_t i = 0; i < count; i++)
        out[i] = out[i] / sum.total;
}

/* Computes octaves of ridges, 0 to 1: bright sheets where the noise crosses zero. */
static inline void turbulence_ridges(const float *x, const float *y, float z, int octaves,
                                     uint32_t seed, size_t count, float *out)
{
    struct turbulence_sum sum;
    turbulence_begin(&sum, x, y, z, count, out);
    for (int octave = 0; octave < octaves; octave++) {
        turbulence(sum.x, sum.y, sum.z, seed + (uint32_t)octave, count, sum.noise);
        for (size_t i = 0; i < count; i++) {
            float ridge = exact_max(0.0f, 1.0f - 1.9f * fabsf(sum.noise[i]));
            out[i] += sum.amplitude * ridge * ridge;
        }
        turbulence_next(&sum, 2.07f, 1.5f, 0.55f, count);
    }
    for (size_t i = 0; i < count; i++)
        out[i] = out[i] / sum.total;
}

/* ---- noise at the fluid's samples ------------------------------------------------------------ */

enum { TURBULENCE_EDGE = KILN_FLUID_EDGE };

/* Noise at the samples of the fluid. All rows of samples between two rows of lattice points share
 * the gradients there. */
struct turbulence_grid {
    float scale;
    struct noise_place z;
    uint32_t hash[2][TURBULENCE_EDGE]; /* hashes by column */
    float weight[2][TURBULENCE_EDGE], away[2][TURBULENCE_EDGE];
    int32_t lattice_row; /* the row of lattice points that the next members belong to */
    float along[8][TURBULENCE_EDGE], up[8][TURBULENCE_EDGE], deep[8][TURBULENCE_EDGE];
};

/* Starts noise at the samples' coordinates times `scale`. */
static inline void turbulence_grid_begin(struct turbulence_grid *grid, const float *x, float z,
                                         uint32_t seed)
{
    grid->z = noise_place_at(z, NOISE_Z);
    grid->z.hash[0] ^= seed;
    grid->z.hash[1] ^= seed;
    grid->lattice_row = INT32_MAX;
    for (int i = 0; i < TURBULENCE_EDGE; i++) {
        struct noise_place place = noise_place_at(x[i], NOISE_X);
        for (int side = 0; side < 2; side++) {
            grid->hash[side][i] = place.hash[side];
            grid->weight[side][i] = place.weight[side];
            grid->away[side][i] = place.away[side];
        }
    }
}

/* Computes corner (i, j, k) of all columns. Two corners may share a vector only with equal j and
 * k. */
static inline void turbulence_grid_corner(struct turbulence_grid *grid, const struct noise_place *y,
                                          int corner)
{
    const int side = corner & 1, k = corner >> 2;
    const uint32_t other = y->hash[(corner >> 1) & 1] ^ grid->z.hash[k];
    const uint32_t *hash = grid->hash[side];
    const float *away = grid->away[side], away_z = grid->z.away[k];
    float *along = grid->along[corner], *up = grid->up[corner], *deep = grid->deep[corner];
    for (int i = 0; i < TURBULENCE_EDGE; i++) {
        uint32_t bits = random_mix(hash[i] ^ other);
        along[i] = noise_slope(bits) * away[i];
        up[i] = noise_slope(bits >> 3);
        deep[i] = noise_slope(bits >> 6) * away_z;
    }
}

static inline void turbulence_grid_row(struct turbulence_grid *grid, float at, float *restrict out)
{
    const struct noise_place y = noise_place_at(at, NOISE_Y);
    int32_t lattice_row = noise_floor(at);
    if (lattice_row != grid->lattice_row) {
        grid->lattice_row = lattice_row;
        for (int corner = 0; corner < 8; corner++)
            turbulence_grid_corner(grid, &y, corner);
    }
    for (int i = 0; i < TURBULENCE_EDGE; i++)
        out[i] = 0.0f;
    for (int corner = 0; corner < 8; corner++) {
        const int j = (corner >> 1) & 1, k = corner >> 2;
        const float *weight = grid->weight[corner & 1], *along = grid->along[corner];
        const float *up = grid->up[corner], *deep = grid->deep[corner];
        for (int i = 0; i < TURBULENCE_EDGE; i++)
            out[i] += weight[i] * y.weight[j] * grid->z.weight[k] *
                      (along[i] + up[i] * y.away[j] + deep[i]);
    }
    for (int i = 0; i < TURBULENCE_EDGE; i++)
        out[i] = 0.32f * out[i];
}

#endif
