/* Makes a palette for a whole clip, and dithers frames with it by a pattern that does not crawl. */
#ifndef KILN_OUTPUT_PALETTE_H
#define KILN_OUTPUT_PALETTE_H

#include "output/output.h"

enum { KILN_MAX_PALETTE = 256 };

/* Counts of colours, in 2^18 cells. */
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

/* At most `most` colours (1 to 256) that stand for those counted; fewer if so few were counted, and
 * black where none was. A function of the counts alone. False when memory is short, or as the
 * caller (which may be NULL) says. */
bool kiln_palette_make(struct kiln_palette *palette, const struct kiln_histogram *histogram,
                       uint32_t most, const struct kiln_caller *caller, struct kiln_error *error);

/* Mixes of a palette's colours for all others. */
struct kiln_dither;

/* Copies the palette. NULL when memory is short. */
struct kiln_dither *kiln_dither_create(const struct kiln_palette *palette);
void kiln_dither_destroy(struct kiln_dither **dither);

/* The palette's index for each pixel of row y, which starts at x = 0. The same colour at the same
 * place always gets the same index. */
void kiln_dither_row(struct kiln_dither *dither, uint32_t y, const uint8_t *rgb, uint32_t width,
                     uint8_t *indices);

#endif
