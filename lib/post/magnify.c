/* This file prepares the enlargement of the glow: memory, and the taps of a row's pixels. */
#include "post/magnify.h"

#include <stdlib.h>

#include "base/error.h"

enum { PAD = 16 }; /* pixels or texels that a vector may read beyond a row */

bool kiln_magnifier_prepare(struct kiln_magnifier *magnifier, uint32_t width,
                            const struct kiln_image *glow, float scale, uint32_t threads,
                            struct kiln_error *error)
{
    struct kiln_magnifier *m = magnifier;
    if (m->planes && m->width == width && m->small_width == glow->width &&
        m->small_height == glow->height && m->scale == scale)
        return true;
    kiln_magnifier_finish(m);
    *m = (struct kiln_magnifier){.width = width,
                                 .small_width = glow->width,
                                 .small_height = glow->height,
                                 .scale = scale,
                                 .near = scale <= 0.5f,
                                 .plane_floats =
                                     (size_t)glow->width + (size_t)(2 * KILN_MAGNIFY_EDGE + PAD)};
    const size_t row = (size_t)width + PAD;
    m->first = calloc(row, sizeof *m->first);
    m->weights[0] = calloc(4 * row, sizeof **m->weights);
    m->planes = calloc(3 * m->plane_floats * threads, sizeof *m->planes);
    if (!m->first || !m->weights[0] || !m->planes) {
        kiln_magnifier_finish(m);
        return kiln_error_no_memory(error, "the bloom");
    }
    for (size_t k = 1; k < 4; k++)
        m->weights[k] = m->weights[0] + k * row;
    for (uint32_t x = 0; x < row; x++) {
        float weights[4];
        const int32_t first = kiln_magnify_taps(x < width ? x : width - 1, scale, weights);
        m->first[x] = first + KILN_MAGNIFY_EDGE;
        for (int k = 0; k < 4; k++)
            m->weights[k][x] = weights[k];
    }
    return true;
}

void kiln_magnifier_finish(struct kiln_magnifier *magnifier)
{
    free(magnifier->first);
    free(magnifier->weights[0]);
    free(magnifier->planes);
    *magnifier = (struct kiln_magnifier){0};
}
