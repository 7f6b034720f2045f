/* Makes the rows of a PNG from the pixels of a picture, ready to be compressed: channels in the
 * order and the bytes of the file, and filtered (PNG specification, clause 9). */
#ifndef KILN_OUTPUT_PNG_ROWS_H
#define KILN_OUTPUT_PNG_ROWS_H

#include "output/output.h"

/* Returns the bytes of a filtered row, with the byte that names the filter. */
size_t kiln_png_row_bytes(const struct kiln_picture *picture);

/* Returns the bytes that kiln_png_filter_rows works with. */
size_t kiln_png_filter_scratch(const struct kiln_picture *picture);

/* Writes `count` filtered rows from row `first` on, which follow one another without gaps.
 * `together` rows have the same filter, which is the best one for the first of them. The bytes
 * depend on the picture, first, count and together alone. `scratch` has
 * kiln_png_filter_scratch(picture) bytes, and calls at the same time need one each. */
void kiln_png_filter_rows(const struct kiln_picture *picture, uint32_t first, uint32_t count,
                          uint32_t together, uint8_t *rows, uint8_t *scratch);

#endif
