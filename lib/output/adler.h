/* The checksum of a zlib stream (RFC 1950, 8.2). */
#ifndef KILN_OUTPUT_ADLER_H
#define KILN_OUTPUT_ADLER_H

#include <stddef.h>
#include <stdint.h>

/* Returns the Adler-32 of `size` bytes, which may be 0. zlib's adler32_combine joins those of
 * parts. */
uint32_t kiln_adler32(const uint8_t *bytes, size_t size);

#endif
