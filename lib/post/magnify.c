/* This file enlarges the glow to the size of the frame by a cubic B-spline. It filters the columns
 * of the small picture once for each row of the frame; kiln_magnified then filters along that
 * row. */
#include "post/magnify.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"

enum { EDGE = 2 }; /* texels that the filter reads beyond the picture, on each side */

/* Returns the taps of the cubic B-spline around a pixel's centre along one axis. */
static struct kiln_magnify_taps taps_at(uint32_t pixel, float scale)
{
    float texel = ((float)pixel + 0.5f) * scale - 0.5f;
    float base = floorf(texel);
    float t = texel - base, s = 1.0f - t;
    return (struct kiln_magnify_taps){
        .first = (int32_t)base - 1,
        .weights = {s * s * s * (1.0f / 6.0f),
                    (4.0f - 6.0f * t * t + 3.0f * t * t * t) * (1.0f / 6.0f),
                    (4.0f - 6.0f * s * s + 3.0f * s * s * s) * (1.0f / 6.0f),
                    t * t * t * (1.0f / 6.0f)},
    };
}

bool kiln_magnifier_prepare(struct kiln_magnifier *magnifier, uint32_t width,
                            const struct kiln_image *glow, float scale, uint32_t threads,
                            struct kiln_error *error)
{
    struct kiln_magnifier *m = magnifier;
    if (m->rows && m->width == width && m->small_width == glow->width &&
        m->small_height == glow->height && m->scale == scale)
        return true;
    kiln_magnifier_finish(m);
    *m = (struct kiln_magnifier){.width = width,
                                 .small_width = glow->width,
                                 .small_height = glow->height,
                                 .scale = scale,
                                 .row_length = (size_t)glow->width + (size_t)(2 * EDGE)};
    m->columns = calloc(width, sizeof *m->columns);
    m->rows = aligned_alloc(64, (threads * m->row_length * sizeof *m->rows / 64 + 1) * 64);
    if (!m->columns || !m->rows) {
        kiln_magnifier_finish(m);
        return kiln_error_set(error, KILN_DEVICE_FAILED, "bloom: out of memory");
    }
    for (uint32_t x = 0; x < width; x++) {
        m->columns[x] = taps_at(x, scale);
        m->columns[x].first += EDGE;
    }
    return true;
}

void kiln_magnifier_finish(struct kiln_magnifier *magnifier)
{
    free(magnifier->columns);
    free(magnifier->rows);
    *magnifier = (struct kiln_magnifier){0};
}

const kiln_quad *kiln_magnifier_row(const struct kiln_magnifier *magnifier, const float *glow,
                                    uint32_t y, float strength, uint32_t worker)
{
    const struct kiln_magnifier *m = magnifier;
    const struct kiln_magnify_taps taps = taps_at(y, m->scale);
    const float *from[4];
    for (int k = 0; k < 4; k++) {
        int32_t line = taps.first + k, last = (int32_t)m->small_height - 1;
        line = line < 0 ? 0 : line > last ? last : line;
        from[k] = glow + (size_t)line * m->small_width * 4;
    }
    const kiln_quad light = {strength, strength, strength, 0.0f};
    kiln_quad *row = m->rows + worker * m->row_length + EDGE;
    for (size_t x = 0; x < m->small_width; x++) {
        kiln_quad sum = (kiln_quad_load(from[0] + 4 * x) * taps.weights[0] +
                         kiln_quad_load(from[1] + 4 * x) * taps.weights[1]) +
                        (kiln_quad_load(from[2] + 4 * x) * taps.weights[2] +
                         kiln_quad_load(from[3] + 4 * x) * taps.weights[3]);
        row[x] = sum * light;
    }
    for (int k = 1; k <= EDGE; k++) {
        row[-k] = row[0];
        row[m->small_width - 1 + (size_t)k] = row[m->small_width - 1];
    }
    return row - EDGE;
}
