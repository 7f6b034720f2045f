/* Spreads what is known at the points of a lattice, GAS_LATTICE cells apart, to the cells of a
 * brick: noise that stirs gas (Bridson et al., "Curl-Noise for Procedural Fluid Flow", 2007), and
 * the forces of a domain. Noise takes longest of all that happens in a cell, and a lattice has an
 * eighth of the points. Only advect_simd.c includes this header. */
#ifndef KILN_SIM_GAS_STIR_H
#define KILN_SIM_GAS_STIR_H

#include "shared/noise.h"
#include "sim/gas/block.h"

enum { STIR_POINTS = GAS_STIR_EDGE * GAS_STIR_EDGE * GAS_STIR_EDGE };

/* Computes the noise of points. Sixteen at a time fill every vector. */
static void noise_of_points(struct gas_points *points, uint32_t seed, uint32_t octaves)
{
    const uint32_t padded = (points->count + 15u) & ~15u;
    for (int c = 0; c < 3; c++) {
        memset(points->noise[c], 0, padded * sizeof(float));
        for (uint32_t i = points->count; i < padded; i++)
            points->place[c][i] = 0.0f;
    }
    for (uint32_t octave = 0; octave < octaves && octave < NOISE_OCTAVES; octave++)
        for (uint32_t i = 0; i < padded; i++) {
            const float3 before = {points->noise[0][i], points->noise[1][i], points->noise[2][i]};
            const float3 p = {points->place[0][i], points->place[1][i], points->place[2][i]};
            const float3 after = noise_curl_add(before, p, seed, octave);
            points->noise[0][i] = after.x;
            points->noise[1][i] = after.y;
            points->noise[2][i] = after.z;
        }
}

/* Computes the noise at a brick's points of the lattice. at: of the brick in the domain. */
static void find_noise(const struct gas_stir *stir, struct kiln_gas_place at,
                       struct gas_workspace *space)
{
    struct gas_points points;
    points.count = STIR_POINTS;
    for (int32_t i = 0; i < STIR_POINTS; i++) {
        const int32_t x = i % GAS_STIR_EDGE, y = i / GAS_STIR_EDGE % GAS_STIR_EDGE;
        const int32_t z = i / (GAS_STIR_EDGE * GAS_STIR_EDGE);
        points.place[0][i] = (float)(at.x + x * GAS_LATTICE) * stir->scale;
        points.place[1][i] = (float)(at.y + y * GAS_LATTICE) * stir->scale - stir->rise;
        points.place[2][i] = (float)(at.z + z * GAS_LATTICE) * stir->scale;
    }
    noise_of_points(&points, stir->seed, stir->octaves);
    for (int c = 0; c < 3; c++)
        for (int32_t i = 0; i < STIR_POINTS; i++)
            space->noise[c][i / (GAS_STIR_EDGE * GAS_STIR_EDGE)][i / GAS_STIR_EDGE % GAS_STIR_EDGE]
                        [i % GAS_STIR_EDGE] = points.noise[c][i];
}

/* Mixes the values at the five points of a row of a lattice for the eight cells between them. Two
 * cells lie between points, a quarter of the way from one and from the other. */
SIMD struct eight between_points(const float *points)
{
    struct eight y;
#if LANES == 8
    const vf a = vf_load(points), b = vf_load(points + 1);
    const vf even = 0.75f * a + 0.25f * b, odd = 0.25f * a + 0.75f * b;
    y.part[0] = __builtin_shufflevector(even, odd, 0, 8, 1, 9, 2, 10, 3, 11);
#else
    const vf a = vf_load(points), b = vf_load(points + 1);
    const vf even = 0.75f * a + 0.25f * b, odd = 0.25f * a + 0.75f * b;
    y.part[0] = __builtin_shufflevector(even, odd, 0, 4, 1, 5);
    y.part[1] = __builtin_shufflevector(even, odd, 2, 6, 3, 7);
#endif
    return y;
}

/* Returns the noise of a row of a brick's cells, along an axis. */
SIMD struct eight noise_of_row(const struct gas_workspace *space, int axis, int32_t y, int32_t z)
{
    const float(*noise)[GAS_STIR_EDGE][GAS_STIR_ROW] = space->noise[axis];
    const float up = y & 1 ? 0.75f : 0.25f, on = z & 1 ? 0.75f : 0.25f;
    _Alignas(32) float row[GAS_STIR_ROW + LANES];
    for (int32_t i = 0; i < GAS_STIR_ROW; i += LANES) {
        const vf low = (1.0f - up) * vf_load(&noise[z / 2][y / 2][i]) +
                       up * vf_load(&noise[z / 2][y / 2 + 1][i]);
        const vf high = (1.0f - up) * vf_load(&noise[z / 2 + 1][y / 2][i]) +
                        up * vf_load(&noise[z / 2 + 1][y / 2 + 1][i]);
        vf_store(row + i, (1.0f - on) * low + on * high);
    }
    return between_points(row);
}

/* Returns the acceleration and the pull that forces have in a row of a brick's cells. */
SIMD void forces_of_row(const struct gas_pass *pass, gas_brick_place at, int32_t y, int32_t z,
                        struct eight to[4])
{
    const struct gas_lattice *lattice = &pass->forces;
    const float up = y & 1 ? 0.75f : 0.25f, on = z & 1 ? 0.75f : 0.25f;
    const size_t half = GAS_BRICK / GAS_LATTICE;
    const float4 *p = lattice->points + ((size_t)at.z * half + (size_t)z / 2) * lattice->plane +
                      ((size_t)at.y * half + (size_t)y / 2) * lattice->row + (size_t)at.x * half;
    const float4 *const corner[4] = {p, p + lattice->row, p + lattice->plane,
                                     p + lattice->plane + lattice->row};
    _Alignas(32) float row[4][GAS_STIR_ROW + LANES] = {{0}};
    for (int i = 0; i < GAS_STIR_EDGE; i++)
        for (int c = 0; c < 4; c++) {
            float q[4];
            for (int k = 0; k < 4; k++)
                q[k] = ((const float *)&corner[k][i])[c];
            const float low = (1.0f - up) * q[0] + up * q[1];
            const float high = (1.0f - up) * q[2] + up * q[3];
            row[c][i] = (1.0f - on) * low + on * high;
        }
    for (int c = 0; c < 4; c++)
        to[c] = between_points(row[c]);
}

#endif
