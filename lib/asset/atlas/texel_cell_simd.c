/* This file makes the texels of one cell of a procedural flipbook from its gas. */
#include <math.h>
#include <string.h>

#include "asset/atlas/texel_cell.h"

/* Samples the gas at every texel. */
static void find_gas(const struct texel_job *job, struct kiln_builtin_scratch *scratch)
{
    const size_t texels = (size_t)job->edge * job->edge;
    if (!job->gas) {
        memset(scratch->heat, 0, texels * sizeof(float));
        memset(scratch->x, 0, texels * sizeof(float));
        memset(scratch->y, 0, texels * sizeof(float));
        return;
    }
    float *weight = scratch->weight;
    const struct kiln_fluid_code *fluid = &KILN_SIMD_NAME(kiln_fluid);
    fluid->sample(job->gas->heat, job->edge, &scratch->fluid, scratch->heat);
    fluid->sample(job->gas->place_x, job->edge, &scratch->fluid, scratch->x);
    fluid->sample(job->gas->place_y, job->edge, &scratch->fluid, scratch->y);
    fluid->sample(job->gas->weight, job->edge, &scratch->fluid, weight);
    for (size_t i = 0; i < texels; i++) {
        scratch->x[i] = scratch->x[i] / weight[i];
        scratch->y[i] = scratch->y[i] / weight[i];
    }
}

/* Gathers the texels of a row, except those that are surely empty, and notes their columns in
 * `from`. */
static uint32_t gather(const struct texel_job *job, const struct kiln_builtin_scratch *scratch,
                       uint32_t row, struct texel_sites *sites, uint8_t from[TEXEL_ROW])
{
    const struct builtin *builtin = job->builtin;
    const float *heat = scratch->heat + (size_t)row * job->edge;
    const float *x = scratch->x + (size_t)row * job->edge,
                *y = scratch->y + (size_t)row * job->edge;
    const float texel_size = 2.0f / (float)job->edge;
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->edge; i++) {
        sites->u[count] = ((float)i + 0.5f) * texel_size - 1.0f;
        sites->place_x[count] = x[i];
        sites->place_y[count] = y[i];
        sites->heat[count] = heat[i];
        from[count] = (uint8_t)i;
        bool near =
            builtin->reach_squared == 0.0f || x[i] * x[i] + y[i] * y[i] <= builtin->reach_squared;
        count += heat[i] >= builtin->least_heat && near;
    }
    sites->v = 1.0f - ((float)row + 0.5f) * texel_size;
    sites->count = (count + TEXEL_BLOCK - 1) & ~(uint32_t)(TEXEL_BLOCK - 1);
    for (uint32_t i = count; i < sites->count; i++)
        sites->u[i] = sites->place_x[i] = sites->place_y[i] = sites->heat[i] = 0.0f;
    return count;
}

/* Runs the flipbook's function for every texel. It stores heights in x, heat in heat, density in
 * y. */
static void make_texels(const struct texel_job *job, struct kiln_builtin_scratch *scratch)
{
    struct texel_sites sites = {.time = job->time, .lobes = job->lobes};
    struct texels texels;
    uint8_t from[TEXEL_ROW];
    for (uint32_t row = 0; row < job->edge; row++) {
        const uint32_t count = gather(job, scratch, row, &sites, from);
        float *height = scratch->x + (size_t)row * job->edge;
        float *heat = scratch->heat + (size_t)row * job->edge;
        float *density = scratch->y + (size_t)row * job->edge;
        for (uint32_t i = 0; i < job->edge; i++)
            height[i] = heat[i] = density[i] = 0.0f;
        if (count > 0)
            job->builtin->texels(&sites, &texels);
        for (uint32_t i = 0; i < count; i++) {
            height[from[i]] = texels.height[i];
            heat[from[i]] = texels.heat[i];
            density[from[i]] = texels.density[i];
        }
    }
}

/* Finds normals from the slopes of the height. */
static void tilt(const struct texel_job *job, const struct kiln_builtin_scratch *scratch,
                 float *pixels)
{
    const uint32_t edge = job->edge;
    const float scale = job->builtin->relief;
    for (uint32_t row = 0; row < edge; row++) {
        const float *height = scratch->x + (size_t)row * edge;
        const float *above = height - (row > 0 ? edge : 0);
        const float *below = height + (row < edge - 1 ? edge : 0);
        const float *heat = scratch->heat + (size_t)row * edge;
        const float *density = scratch->y + (size_t)row * edge;
        float beside[TEXEL_ROW + 2];
        memcpy(beside + 1, height, edge * sizeof(float));
        beside[0] = height[0];
        beside[edge + 1] = height[edge - 1];
        for (uint32_t i = 0; i < edge; i++, pixels += 4) {
            float slope_x = scale * (beside[i] - beside[i + 2]);
            float slope_y = scale * (below[i] - above[i]);
            float shorten = 1.0f / sqrtf(1.0f + slope_x * slope_x + slope_y * slope_y);
            pixels[0] = slope_x * shorten;
            pixels[1] = slope_y * shorten;
            pixels[2] = heat[i];
            pixels[3] = density[i];
        }
    }
}

static void make_cell(const struct texel_job *job, struct kiln_builtin_scratch *scratch,
                      float *pixels)
{
    find_gas(job, scratch);
    make_texels(job, scratch);
    tilt(job, scratch, pixels);
}

const struct texel_code KILN_SIMD_NAME(kiln_texel) = {.make_cell = make_cell};
