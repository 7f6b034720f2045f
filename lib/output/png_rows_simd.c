/* Makes the rows of a PNG from the pixels of a picture. A filter replaces each byte by its
 * difference from a guess, which is made of the bytes of the pixels to the left and above. Each
 * filter is a plain loop without branches, which the compiler makes vectors of.
 *
 * Which filter is best changes little from row to row, and to try all of them costs four times as
 * much as one. So a few rows share the filter that gives the first of them the least sum of
 * differences. For frames of kiln's scenes, a choice for every sixteenth row gives files that are
 * 0.3 percent larger than a choice for every eighth. */
#include <string.h>

#include "output/png_rows.h"

static size_t packed_bytes(const struct kiln_picture *picture)
{
    return kiln_png_row_bytes(picture) - 1;
}

/* ---- Packing --------------------------------------------------------------------------------- */

static void pack_bytes(const uint8_t *pixels, uint32_t width, uint8_t *out)
{
    for (size_t x = 0; x < width; x++)
        memcpy(out + 3 * x, pixels + 4 * x, 4); /* the next pixel replaces the alpha */
}

static void pack_words(const uint16_t *pixels, uint32_t width, size_t channels, uint8_t *out)
{
    for (size_t x = 0; x < width; x++, pixels += 4, out += 2 * channels) {
        for (size_t i = 0; i < channels; i++) {
            out[2 * i] = (uint8_t)(pixels[i] >> 8);
            out[2 * i + 1] = (uint8_t)pixels[i];
        }
    }
}

/* Writes the samples of a row as PNG has them: without alpha if it means nothing, and with the high
 * byte first. */
static void pack_row(const struct kiln_picture *picture, uint32_t y, uint8_t *out)
{
    const size_t first = (size_t)y * picture->width * 4;
    if (picture->bits == 16)
        pack_words((const uint16_t *)picture->display + first, picture->width,
                   picture->has_alpha ? 4 : 3, out);
    else if (picture->has_alpha)
        memcpy(out, (const uint8_t *)picture->display + first, packed_bytes(picture));
    else
        pack_bytes((const uint8_t *)picture->display + first, picture->width, out);
}

/* ---- Filters --------------------------------------------------------------------------------- */

/* A filter reads a row, and the row above. `back` is the number of bytes to the pixel to the
 * left. */
typedef void filter(const uint8_t *row, const uint8_t *above, size_t size, size_t back,
                    uint8_t *restrict out);

static inline uint8_t distance(uint8_t a, uint8_t b)
{
    return (uint8_t)(a > b ? a - b : b - a);
}

static void filter_sub(const uint8_t *row, const uint8_t *above, size_t size, size_t back,
                       uint8_t *restrict out)
{
    (void)above;
    const uint8_t *left = row - back;
    for (size_t i = 0; i < size; i++)
        out[i] = (uint8_t)(row[i] - left[i]);
}

static void filter_up(const uint8_t *row, const uint8_t *above, size_t size, size_t back,
                      uint8_t *restrict out)
{
    (void)back;
    for (size_t i = 0; i < size; i++)
        out[i] = (uint8_t)(row[i] - above[i]);
}

static void filter_average(const uint8_t *row, const uint8_t *above, size_t size, size_t back,
                           uint8_t *restrict out)
{
    const uint8_t *left = row - back;
    for (size_t i = 0; i < size; i++) {
        const uint8_t both = left[i] & above[i], one = left[i] ^ above[i];
        out[i] = (uint8_t)(row[i] - (uint8_t)(both + (one >> 1))); /* the average in 8 bits */
    }
}

/* The guess is whichever of left (a), above (b), and above left (c) is nearest to a + b - c (PNG
 * specification, 9.4). The distances from it are |b - c|, |a - c| and |(b - c) + (a - c)|. Where
 * b - c and a - c have different signs, the last one is the difference of the other two. Where they
 * have the same sign, it is at least as large as both, so c is not the guess; any number as large
 * serves. So bytes hold all of it. */
static void filter_paeth(const uint8_t *row, const uint8_t *above, size_t size, size_t back,
                         uint8_t *restrict out)
{
    const uint8_t *left = row - back, *corner = above - back;
    for (size_t i = 0; i < size; i++) {
        const uint8_t a = left[i], b = above[i], c = corner[i];
        const uint8_t from_a = distance(b, c), from_b = distance(a, c);
        const uint8_t apart = distance(from_a, from_b);
        const uint8_t from_c = (a < c) == (b < c) ? UINT8_MAX : apart;
        const uint8_t other = from_b <= from_c ? b : c;
        const uint8_t from_other = from_b <= from_c ? from_b : from_c;
        out[i] = (uint8_t)(row[i] - (from_a <= from_other ? a : other));
    }
}

/* Filters by the numbers that PNG has for them. */
enum { FIRST_FILTER = 1, FILTERS = 5 };
static filter *const filters[FILTERS] = {NULL, filter_sub, filter_up, filter_average, filter_paeth};

/* Returns how much differences are, up or down, all together. A row has less than 2^24 bytes. */
static uint32_t sum_differences(const uint8_t *bytes, size_t size)
{
    uint32_t sum = 0;
    for (size_t i = 0; i < size; i++) {
        const uint8_t up = bytes[i], down = (uint8_t)-up;
        sum += up < down ? up : down;
    }
    return sum;
}

/* Returns the number of the filter that is best for a row; `trial` has room for a row. */
static uint8_t choose_filter(const uint8_t *row, const uint8_t *above, size_t size, size_t back,
                             uint8_t *trial)
{
    int best = FIRST_FILTER;
    uint32_t least = UINT32_MAX;
    for (int i = FIRST_FILTER; i < FILTERS; i++) {
        filters[i](row, above, size, back, trial);
        const uint32_t sum = sum_differences(trial, size);
        if (sum < least) {
            least = sum;
            best = i;
        }
    }
    return (uint8_t)best;
}

/* ---- The interface --------------------------------------------------------------------------- */

void KILN_SIMD_NAME(kiln_png_filter_rows)(const struct kiln_picture *picture, uint32_t first,
                                          uint32_t count, uint32_t together, uint8_t *rows,
                                          uint8_t *scratch)
{
    const size_t size = packed_bytes(picture), back = kiln_png_pixel_bytes(picture);
    uint8_t *above = scratch + KILN_PNG_MARGIN, *row = above + size + (size_t)2 * KILN_PNG_MARGIN;
    uint8_t *trial = row + size + KILN_PNG_MARGIN;
    uint8_t number = FIRST_FILTER;
    memset(scratch, 0, (size_t)(trial - scratch));
    if (first > 0)
        pack_row(picture, first - 1, above);
    for (uint32_t y = 0; y < count; y++) {
        pack_row(picture, first + y, row);
        if (y % together == 0)
            number = choose_filter(row, above, size, back, trial);
        *rows = number;
        filters[number](row, above, size, back, rows + 1);
        rows += 1 + size;
        uint8_t *last = above;
        above = row;
        row = last;
    }
}
