/* This file makes the mip levels of a cell and its strip, and stores them in 8 bits. */
#include <math.h>

#include "asset/atlas/atlas_code.h"
#include "asset/atlas/quad.h"
#include "shared/draw_layout.h"

/* Returns the mean of texels; normals and heat are weighted by their density. */
static asset_quad mean_of(const asset_quad *texels, int count, uint32_t kind)
{
    const float part = 1.0f / (float)count;
    asset_quad sum = {0}, weighted = {0};
    for (int i = 0; i < count; i++) {
        sum += part * texels[i];
        weighted += texels[i][3] * texels[i];
    }
    const float density = (float)count * sum[3];
    asset_quad mean = sum;
    if (kind == KILN_CELL_MASK && density > 1e-6f) {
        mean = weighted / density;
        mean[3] = sum[3];
    }
    return mean;
}

/* Halves a level. */
static void shrink(const float *from, size_t edge, uint32_t kind, float *to)
{
    const size_t half = edge / 2;
    for (size_t y = 0; y < half; y++) {
        const float *row = from + 2 * y * edge * 4;
        for (size_t x = 0; x < half; x++, row += 8, to += 4) {
            const asset_quad p[4] = {asset_quad_load(row), asset_quad_load(row + 4),
                                     asset_quad_load(row + 4 * edge),
                                     asset_quad_load(row + 4 * edge + 4)};
            asset_quad_store(to, mean_of(p, 4, kind));
        }
    }
}

/* Makes the strip from the level that has as many rows. */
static void average_rows(const float *from, uint32_t kind, float *strip)
{
    for (size_t y = 0; y < KILN_ATLAS_STRIP; y++, strip += 4) {
        asset_quad row[KILN_ATLAS_STRIP];
        for (size_t x = 0; x < KILN_ATLAS_STRIP; x++, from += 4)
            row[x] = asset_quad_load(from);
        asset_quad_store(strip, mean_of(row, KILN_ATLAS_STRIP, kind));
    }
}

static void encode(const float *from, size_t pixels, uint32_t kind, uint8_t *to)
{
    typedef uint8_t bytes __attribute__((vector_size(4), aligned(1), may_alias));
    const asset_quad none = {0}, one = {1.0f, 1.0f, 1.0f, 1.0f};
    const asset_quad part = {0.5f, 0.5f, 1.0f, 1.0f}, start = {0.5f, 0.5f, 0.0f, 0.0f};
    for (size_t i = 0; i < pixels; i++, from += 4, to += 4) {
        asset_quad x = asset_quad_load(from);
        if (kind == KILN_CELL_COLOR) {
            x = asset_quad_max(x, none);
            x = (asset_quad){sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3])};
        } else {
            x = start + part * x;
        }
        x = asset_quad_min(asset_quad_max(x, none), one) * 255.0f + 0.5f;
        *(bytes *)to = __builtin_convertvector(__builtin_convertvector(x, asset_quad_mask), bytes);
    }
}

static void store_cell(float *cell, uint32_t edge, uint32_t kind, uint8_t *texels)
{
    float strip[4 * KILN_ATLAS_STRIP];
    for (; edge > 0; edge /= 2) {
        if (edge == KILN_ATLAS_STRIP)
            average_rows(cell, kind, strip);
        encode(cell, (size_t)edge * edge, kind, texels);
        texels += 4 * (size_t)edge * edge;
        if (edge > 1)
            shrink(cell, edge, kind, cell);
    }
    encode(strip, KILN_ATLAS_STRIP, kind, texels);
}

const struct kiln_atlas_code KILN_SIMD_NAME(kiln_atlas) = {.store_cell = store_cell};
