/* This file paints one block of texels with splats, in vectors. A splat is a layer over the paint
 * before it, with an opacity that falls from its middle to its rim. At opacity 0 no bit of a texel
 * changes, so texels or whole splats that are out of reach may be skipped. */
#include <string.h>

#include "sim/paint/paint_gather.h"

/* Holds the paint of a block's texels, by channel. */
struct layer {
    float channel[4][KILN_CHART_BLOCK];
};

static void take(const uint32_t *texels, float (*from)[4], struct layer *layer)
{
    for (int i = 0; i < KILN_CHART_BLOCK; i++) {
        for (int c = 0; c < 4; c++)
            layer->channel[c][i] = texels[i] == KILN_CHART_NOWHERE ? 0.0f : from[texels[i]][c];
    }
}

static void put(const uint32_t *texels, const struct layer *layer, float (*to)[4])
{
    for (int i = 0; i < KILN_CHART_BLOCK; i++) {
        if (texels[i] == KILN_CHART_NOWHERE)
            continue;
        for (int c = 0; c < 4; c++)
            to[texels[i]][c] = layer->channel[c][i];
    }
}

/* Finds the squared distances from the splat to the texels, less the squared radius. Returns
 * whether any is below 0. */
static bool measure(const struct kiln_chart *chart, size_t first, const struct kiln_splat *splat,
                    float out[KILN_CHART_BLOCK])
{
    const float *x = chart->place[0] + first, *y = chart->place[1] + first;
    const float *z = chart->place[2] + first;
    const float at[3] = {splat->position[0], splat->position[1], splat->position[2]},
                square = splat->radius_squared;
    for (int i = 0; i < KILN_CHART_BLOCK; i++) {
        const float dx = x[i] - at[0], dy = y[i] - at[1], dz = z[i] - at[2];
        out[i] = dx * dx + dy * dy + dz * dz - square;
    }
    uint32_t bits[KILN_CHART_BLOCK], signs = 0;
    memcpy(bits, out, sizeof bits);
    for (int i = 0; i < KILN_CHART_BLOCK; i++)
        signs |= bits[i];
    return signs >> 31 != 0;
}

static void cover(const struct kiln_chart *chart, size_t first, const struct kiln_splat *splat,
                  const float beyond[KILN_CHART_BLOCK], struct layer *layer)
{
    const float *nx = chart->normal[0] + first, *ny = chart->normal[1] + first;
    const float *nz = chart->normal[2] + first;
    const float slope = splat->slope, opacity = splat->opacity;
    float part[KILN_CHART_BLOCK];
    for (int i = 0; i < KILN_CHART_BLOCK; i++) {
        float inside = -beyond[i] * slope;
        inside = inside < 0.0f ? 0.0f : inside;
        inside = inside > 1.0f ? 1.0f : inside;
        const float facing =
            nx[i] * splat->normal[0] + ny[i] * splat->normal[1] + nz[i] * splat->normal[2];
        const float smooth = inside * inside * (3.0f - 2.0f * inside) * opacity;
        part[i] = facing >= 0.0f ? smooth : 0.0f;
    }
    for (int c = 0; c < 4; c++) {
        const float color = c < 3 ? splat->color[c] : 1.0f;
        float *channel = layer->channel[c];
        for (int i = 0; i < KILN_CHART_BLOCK; i++)
            channel[i] = channel[i] + (color - channel[i]) * part[i];
    }
}

bool KILN_SIMD_NAME(kiln_paint_block_of)(const struct kiln_chart *chart, uint32_t block,
                                         const struct kiln_splat *splats, const uint32_t *list,
                                         size_t count, float (*texels)[4])
{
    const size_t first = (size_t)block * KILN_CHART_BLOCK;
    struct layer layer;
    bool touched = false;
    for (size_t k = 0; k < count; k++) {
        const struct kiln_splat *splat = &splats[list ? list[k] : k];
        float beyond[KILN_CHART_BLOCK];
        if (!measure(chart, first, splat, beyond))
            continue;
        if (!touched)
            take(chart->texels + first, texels, &layer);
        touched = true;
        cover(chart, first, splat, beyond, &layer);
    }
    if (touched)
        put(chart->texels + first, &layer, texels);
    return touched;
}
