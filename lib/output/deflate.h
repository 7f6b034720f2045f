/* Compresses filtered rows of pictures to DEFLATE (RFC 1951), fast. Its own code, not zlib's, since
 * rendered frames have dither on them, in which a search for repeats finds little: only runs of
 * zeros become matches, and the rest are literals. */
#ifndef KILN_OUTPUT_DEFLATE_H
#define KILN_OUTPUT_DEFLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/simd.h"

/* Holds tables while a call runs. Their content before and after a call does not matter; calls at
 * the same time need one each. 256 KiB. */
struct kiln_deflate_scratch {
    uint32_t pairs[256 * 256];
};

/* Returns the bytes that kiln_deflate may write for `size` bytes: up to 12 bits for each, and a
 * head. */
static inline size_t kiln_deflate_room(size_t size)
{
    return size + size / 2 + 512;
}

/* Compresses `size` bytes (at least 1) to blocks of a DEFLATE stream, which end at a whole byte,
 * and returns the number of bytes written. The output of several calls makes one stream; `last`
 * marks its end. The same bytes give the same output on every machine. `out` has
 * kiln_deflate_room(size) bytes. */
typedef size_t kiln_deflate_run(const uint8_t *bytes, size_t size, bool last, uint8_t *out,
                                struct kiln_deflate_scratch *scratch);
KILN_SIMD_DECLARE(kiln_deflate_run, kiln_deflate);

#endif
