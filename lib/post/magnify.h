/* A kiln_magnifier enlarges the small picture of the glow to the size of the frame by the cubic
 * B-spline, on the host. It holds what all rows of the frame have in common; magnify_row.h filters
 * rows. */
#ifndef KILN_POST_MAGNIFY_H
#define KILN_POST_MAGNIFY_H

#include <math.h>

#include "post/compose.h"
#include "shared/exact.h"

enum { KILN_MAGNIFY_EDGE = 2 }; /* texels that the filter reads beyond the picture, on each side */

struct kiln_magnifier {
    uint32_t width, small_width, small_height; /* of the frame; of the glow */
    float scale;                               /* the size of the glow divided by that of the
                                                * frame */
    bool near; /* true: a vector of pixels reads no more texels than it has lanes */
    /* For each pixel of a row: the first of four texels of a plane, and their weights. Vectors may
     * read beyond the last pixel. */
    int32_t *first;
    float *weights[4];
    float *planes;       /* for each thread, three rows of the glow with their edges */
    size_t plane_floats; /* of a row */
};

/* Allocates memory and computes the taps for the size of `glow`; does nothing if the last call had
 * the same sizes. */
bool kiln_magnifier_prepare(struct kiln_magnifier *magnifier, uint32_t width,
                            const struct kiln_image *glow, float scale, uint32_t threads,
                            struct kiln_error *error);
void kiln_magnifier_finish(struct kiln_magnifier *magnifier);

/* Computes the taps of the cubic B-spline around a pixel's centre along one axis. Returns the index
 * of the first of four texels; texels beyond an edge repeat the texel at the edge. */
static inline int32_t kiln_magnify_taps(uint32_t pixel, float scale, float weights[4])
{
    const float texel = ((float)pixel + 0.5f) * scale - 0.5f;
    const float base = floorf(texel), t = texel - base, s = 1.0f - t;
    weights[0] = s * s * s * (1.0f / 6.0f);
    weights[1] = (4.0f - 6.0f * t * t + 3.0f * t * t * t) * (1.0f / 6.0f);
    weights[2] = (4.0f - 6.0f * s * s + 3.0f * s * s * s) * (1.0f / 6.0f);
    weights[3] = t * t * t * (1.0f / 6.0f);
    return exact_int(base) - 1;
}

#endif
