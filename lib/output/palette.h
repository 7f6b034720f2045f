/* Makes a palette for a whole clip, and dithers frames with it by a pattern that does not crawl. */
#ifndef KILN_OUTPUT_PALETTE_H
#define KILN_OUTPUT_PALETTE_H

#include "output/output.h"

enum { KILN_MAX_PALETTE = 256 };

/* Counts the colours of a clip, in 2^18 cells. */
struct kiln_histogram;

/* NULL when memory is short. */
struct kiln_histogram *kiln_histogram_create(void);
void kiln_histogram_destroy(struct kiln_histogram **histogram);

/* Counts pixels of three bytes. */
void kiln_histogram_add(struct kiln_histogram *histogram, const uint8_t *rgb, size_t pixels);

struct kiln_palette {
    uint32_t count;
    uint8_t colors[KILN_MAX_PALETTE][3];
};

/* Makes a palette of at most `most` colours (1 to 256) for the counted ones. It has fewer when
 * fewer were counted, and is black when none was. It depends on the counts alone. False when memory
 * is short or the caller (which may be NULL) wants no more. */
bool kiln_palette_make(struct kiln_palette *palette, const struct kiln_histogram *histogram,
                       uint32_t most, const struct kiln_caller *caller, struct kiln_error *error);

/* Holds, for each colour, the palette colours that are mixed for it. */
struct kiln_dither;

/* Makes a dither for a palette, which is copied. NULL when memory is short. */
struct kiln_dither *kiln_dither_create(const struct kiln_palette *palette);
void kiln_dither_destroy(struct kiln_dither **dither);

/* Chooses the palette's index for each pixel of row y, which starts at x = 0. The same colour at
 * the same place always gets the same index. */
void kiln_dither_row(struct kiln_dither *dither, uint32_t y, const uint8_t *rgb, uint32_t width,
                     uint8_t *indices);

#endif
