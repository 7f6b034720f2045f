/* Compresses the rows of a PNG by libdeflate at its highest level, for small files. Its lower
 * levels are slower than output/deflate.h and give larger files. */
#ifndef KILN_OUTPUT_PNG_SMALL_H
#define KILN_OUTPUT_PNG_SMALL_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

/* Opens libdeflate, once for the process. KILN_IO, with the Debian package, when it is not
 * there. */
bool kiln_png_small_open(struct kiln_error *error);

/* Compresses `size` bytes to a zlib stream of *written bytes, which is returned; the caller frees
 * it. Takes about 0.7 us a byte. NULL when memory is short. Needs kiln_png_small_open. */
uint8_t *kiln_png_small_compress(const uint8_t *bytes, size_t size, size_t *written);

#endif
