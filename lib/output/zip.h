/* Compresses chunks of EXR files to zlib streams (RFC 1950), more than twice as fast as libdeflate
 * at its fastest. It knows how the bytes of a chunk lie, and so where a search for repeats pays. */
#ifndef KILN_OUTPUT_ZIP_H
#define KILN_OUTPUT_ZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/simd.h"

enum {
    KILN_ZIP_SEQUENCES = 1 << 16, /* most of a block */
    KILN_ZIP_PLACES = 1 << 12,
};

/* Literals, and the match behind them. */
struct kiln_zip_sequence {
    uint32_t literals;
    uint16_t length, distance; /* bytes; the distance is less by 1. Length 0: no match follows */
};

/* Holds tables while a call runs. Their content before and after a call does not matter; calls at
 * the same time need one each. */
struct kiln_zip_scratch {
    uint32_t pairs[256 * 256];
    struct kiln_zip_sequence sequences[KILN_ZIP_SEQUENCES + 1];
    uint16_t places[KILN_ZIP_PLACES]; /* by hash: the last place with such bytes, modulo 2^16 */
};

/* Describes a chunk: two planes of bytes, which have the same number of lines. A line has a number
 * of rows, one or more for each channel. */
struct kiln_zip_layout {
    size_t row_bytes, rows; /* bytes of a row; rows of a line of a plane */
    uint64_t float_rows; /* a bit for each row of a line, at most 64: set where it has floats, not
                            halves */
};

/* Returns the bytes that kiln_zip may write for `size` bytes. */
static inline size_t kiln_zip_room(size_t size)
{
    return size + size / 2 + (3 + size / KILN_ZIP_SEQUENCES) * 512;
}

/* Compresses `size` bytes, which are whole lines of two planes, and returns the number of bytes
 * written. The same bytes give the same output on every machine. `out` has kiln_zip_room(size)
 * bytes. */
typedef size_t kiln_zip_run(const uint8_t *bytes, size_t size, const struct kiln_zip_layout *layout,
                            uint8_t *out, struct kiln_zip_scratch *scratch);
KILN_SIMD_DECLARE(kiln_zip_run, kiln_zip);

#endif
