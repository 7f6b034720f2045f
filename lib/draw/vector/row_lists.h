/* A kiln_row_lists holds a list for each band of rows of a picture: the items that touch the band,
 * in the order of their numbers. With it, threads draw bands independently. The lists of some bands
 * are made at a time, so that their memory is bounded however many bands the items touch. */
#ifndef KILN_DRAW_VECTOR_ROW_LISTS_H
#define KILN_DRAW_VECTOR_ROW_LISTS_H

#include <stddef.h>
#include <stdint.h>

#include "base/footprint.h"
#include "base/thread.h"
#include "kiln.h"
#include "shared/exact.h"

/* The most entries of the lists that are made at a time; a single band may have more. */
enum { KILN_ROW_LISTS_MOST = 1 << 22 };

/* Holds the rows, or the columns, from .. to - 1. */
struct kiln_row_range {
    int16_t from, to;
};

/* Items of a picture, divided into bands of band_height rows. */
struct kiln_row_items {
    const struct kiln_row_range *ranges; /* the rows of each item, all within the picture; an item
                                          * with an empty range is in no list */
    uint32_t count, height, band_height;
};

struct kiln_row_lists {
    uint32_t bands;
    uint32_t begin, end; /* the bands that have their lists now */
    size_t *first;       /* entries of all bands before each one, and of all */
    size_t *next;        /* scratch: by band */
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

/* Makes the lists of some bands after each other, and calls body as kiln_threads_try does for as
 * many bands, until all have been drawn. Number i of a loop is band `begin` + i. The lists start as
 * zeros and may be used again. Returns false with an error: no memory, or the caller wants no more.
 */
bool kiln_row_lists_draw(struct kiln_row_lists *lists, const struct kiln_row_items *items,
                         struct kiln_threads *threads,
                         void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                         void *context, struct kiln_error *error);

/* Returns the list of a band that has one now, and its length. */
static inline const uint32_t *kiln_row_lists_of(const struct kiln_row_lists *lists, size_t band,
                                                size_t *count)
{
    *count = lists->first[band + 1] - lists->first[band];
    return lists->list + (lists->first[band] - lists->first[lists->begin]);
}

void kiln_row_lists_finish(struct kiln_row_lists *lists);

/* Adds the memory of the lists of `count` items in so many bands. */
void kiln_row_lists_footprint(uint64_t count, uint64_t bands, enum kiln_footprint_part part,
                              struct kiln_footprint *footprint);

#endif
