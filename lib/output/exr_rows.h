/* Packs pixels into the bytes of an EXR file's chunk, as OpenEXR's ZIP orders them (ImfZip.cpp):
 * low and high bytes apart, then each byte as its difference to the one before. */
#ifndef KILN_OUTPUT_EXR_ROWS_H
#define KILN_OUTPUT_EXR_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/simd.h"

/* Receives a channel's bytes of a line. A half has a low and a high byte; a float has two of each:
 * of its four bytes, those at even places are low. */
struct kiln_exr_row {
    uint8_t *low, *high;
};

struct kiln_exr_loops {
    /* Packs a line of `width` pixels of `channels` floats, 1 to 4, a row for each channel. half:
     * rounds to halves, which are kept finite. */
    void (*pack)(const float *pixels, uint32_t channels, size_t width, bool half,
                 const struct kiln_exr_row *rows);

    /* Writes the difference of each byte to the one before, plus 128. */
    void (*subtract)(const uint8_t *bytes, uint8_t before, size_t count, uint8_t *out);
};

KILN_SIMD_DECLARE(const struct kiln_exr_loops, kiln_exr_loops);

#endif
