/* A kiln_row_lists holds a list for each band of rows of a picture: the items that touch the band,
 * in the order of their numbers. With it, threads draw bands independently. */
#ifndef KILN_DRAW_VECTOR_ROW_LISTS_H
#define KILN_DRAW_VECTOR_ROW_LISTS_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"
#include "shared/exact.h"

/* Holds the rows, or the columns, from .. to - 1. */
struct kiln_row_range {
    int16_t from, to;
};

struct kiln_row_lists {
    uint32_t bands;
    size_t *first; /* where each band's list begins in `list`, then the last one's end */
    uint32_t *list;
    size_t room, band_room;
};

/* How far the bounds of a triangle are widened, px. Rounding displaces corners by less. */
#define KILN_RANGE_MARGIN 0.0625f

/* Returns the rows, or the columns, that have samples between two positions, out of `size`. */
static inline struct kiln_row_range kiln_row_range_between(float low, float high, float size)
{
    return (struct kiln_row_range){(int16_t)exact_int(exact_clamp(low, 0.0f, size)),
                                   (int16_t)exact_int(exact_clamp(high + 1.0f, 0.0f, size))};
}

/* Lists `count` items by bands of band_height rows. ranges: the rows of each item, all within the
 * picture; an item with an empty range is in no list. The lists start as zeros and may be filled
 * again. False with an error: no memory. */
bool kiln_row_lists_fill(struct kiln_row_lists *lists, const struct kiln_row_range *ranges,
                         uint32_t count, uint32_t height, uint32_t band_height,
                         struct kiln_error *error);
void kiln_row_lists_finish(struct kiln_row_lists *lists);

#endif
