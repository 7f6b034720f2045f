/* A kiln_magnifier enlarges the small picture of the glow to the size of the frame by the cubic
 * B-spline, on the host. */
#ifndef KILN_POST_MAGNIFY_H
#define KILN_POST_MAGNIFY_H

#include "post/compose.h"

/* Holds the four texels around a pixel along one axis and their weights. */
struct kiln_magnify_taps {
    int32_t first; /* index of the first texel; texels beyond the edge repeat the texel at the
                    * edge */
    float weights[4];
};

struct kiln_magnifier {
    uint32_t width, small_width, small_height; /* of the frame; of the glow */
    float scale;                               /* the size of the glow divided by that of the
                                                * frame */
    struct kiln_magnify_taps *columns;         /* of each pixel of a row */
    kiln_quad *rows;                           /* a row of the glow with its edges for each
                                                * thread */
    size_t row_length;
};

/* Allocates memory and computes the taps for the size of `glow`; does nothing if the last call had
 * the same sizes. */
bool kiln_magnifier_prepare(struct kiln_magnifier *magnifier, uint32_t width,
                            const struct kiln_image *glow, float scale, uint32_t threads,
                            struct kiln_error *error);
void kiln_magnifier_finish(struct kiln_magnifier *magnifier);

/* Returns the glow filtered vertically for row y of the frame, times a strength; its alpha is 0.
 * The row is valid until the next call with the same worker. */
const kiln_quad *kiln_magnifier_row(const struct kiln_magnifier *magnifier, const float *glow,
                                    uint32_t y, float strength, uint32_t worker);

/* Returns the glow at pixel x of a row that kiln_magnifier_row returned. */
static inline kiln_quad kiln_magnified(const struct kiln_magnifier *magnifier, const kiln_quad *row,
                                       size_t x)
{
    const struct kiln_magnify_taps *taps = &magnifier->columns[x];
    const kiln_quad *from = row + taps->first;
    return (from[0] * taps->weights[0] + from[1] * taps->weights[1]) +
           (from[2] * taps->weights[2] + from[3] * taps->weights[3]);
}

#endif
