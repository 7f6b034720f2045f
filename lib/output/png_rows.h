/* Makes the rows of a PNG from the pixels of a picture, ready to be compressed: channels in the
 * order and the bytes of the file, and filtered (PNG specification, clause 9). */
#ifndef KILN_OUTPUT_PNG_ROWS_H
#define KILN_OUTPUT_PNG_ROWS_H

#include "base/simd.h"
#include "output/output.h"

/* Bytes of zeros before each row, where a filter looks for the pixel to the left of the first one:
 * as many as the largest pixel has. Behind the row there are as many for stores of whole words. */
enum { KILN_PNG_MARGIN = 8 };

static inline size_t kiln_png_pixel_bytes(const struct kiln_picture *picture)
{
    return (picture->has_alpha ? 4 : 3) * (size_t)(picture->bits / 8);
}

/* Returns the bytes of a filtered row, with the byte that names the filter. */
static inline size_t kiln_png_row_bytes(const struct kiln_picture *picture)
{
    return 1 + picture->width * kiln_png_pixel_bytes(picture);
}

/* Returns the bytes that kiln_png_filter_rows works with: three rows and their margins. */
static inline size_t kiln_png_filter_scratch(const struct kiln_picture *picture)
{
    return 3 * (kiln_png_row_bytes(picture) + (size_t)2 * KILN_PNG_MARGIN);
}

/* Writes `count` filtered rows from row `first` on, which follow one another without gaps.
 * `together` rows have the same filter, which is the best one for the first of them. The bytes
 * depend on the picture, first, count and together alone. `scratch` has
 * kiln_png_filter_scratch(picture) bytes, and calls at the same time need one each. */
typedef void kiln_png_filter(const struct kiln_picture *picture, uint32_t first, uint32_t count,
                             uint32_t together, uint8_t *rows, uint8_t *scratch);
KILN_SIMD_DECLARE(kiln_png_filter, kiln_png_filter_rows);

#endif
