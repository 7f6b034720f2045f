/* A kiln_row_lists has for each band of rows of a picture a list of the items that touch it, in the
 * order of the items, so that threads can draw bands. */
#ifndef KILN_DRAW_VECTOR_ROW_LISTS_H
#define KILN_DRAW_VECTOR_ROW_LISTS_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

/* from .. to - 1 */
struct kiln_row_range {
    int16_t from, to;
};

struct kiln_row_lists {
    uint32_t bands;
    size_t *first; /* of each band's list in `list`, and the end of the last one */
    uint32_t *list;
    size_t room, band_room;
};

/* Lists `count` items. ranges: the rows of the first item; those of the next are `stride` bytes on.
 * All are within the picture; an item with an empty range is in no list. Zero-initialised lists are
 * none. */
bool kiln_row_lists_fill(struct kiln_row_lists *lists, const struct kiln_row_range *ranges,
                         size_t stride, uint32_t count, uint32_t height, uint32_t band_height,
                         struct kiln_error *error);
void kiln_row_lists_finish(struct kiln_row_lists *lists);

#endif
