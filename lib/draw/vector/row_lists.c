/* This file lists the items that touch each band of rows, by a counting sort: it counts each list's
 * length, then sums the lengths to where each list begins, then fills the lists. */
#include "draw/vector/row_lists.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "the backdrop");
}

static bool make_bands(struct kiln_row_lists *lists, uint32_t bands)
{
    if (lists->band_room < bands) {
        free(lists->first);
        lists->first = malloc(((size_t)bands + 2) * sizeof *lists->first);
        lists->band_room = lists->first ? bands : 0;
    }
    lists->bands = bands;
    return lists->first != NULL;
}

static bool make_room(struct kiln_row_lists *lists, size_t entries)
{
    if (lists->room >= entries && lists->list)
        return true;
    free(lists->list);
    lists->room = entries + entries / 4 + 64;
    lists->list = malloc(lists->room * sizeof *lists->list);
    return lists->list != NULL;
}

bool kiln_row_lists_fill(struct kiln_row_lists *lists, const struct kiln_row_range *ranges,
                         uint32_t count, uint32_t height, uint32_t band_height,
                         struct kiln_error *error)
{
    uint32_t bands = (height + band_height - 1) / band_height;
    if (!make_bands(lists, bands))
        return out_of_memory(error);
    size_t *first = lists->first;
    memset(first, 0, ((size_t)bands + 2) * sizeof *first);
    for (uint32_t i = 0; i < count; i++) {
        const struct kiln_row_range rows = ranges[i];
        for (int band = rows.from / (int)band_height; band * (int)band_height < rows.to; band++)
            first[band + 2] += rows.from < rows.to;
    }
    for (uint32_t band = 0; band < bands; band++)
        first[band + 2] += first[band + 1];
    if (!make_room(lists, first[bands + 1]))
        return out_of_memory(error);
    /* Filling a list moves its entry in `first` from the list's beginning to its end, where the
     * next list begins. */
    for (uint32_t i = 0; i < count; i++) {
        const struct kiln_row_range rows = ranges[i];
        for (int band = rows.from / (int)band_height;
             rows.from < rows.to && band * (int)band_height < rows.to; band++)
            lists->list[first[band + 1]++] = i;
    }
    return true;
}

void kiln_row_lists_finish(struct kiln_row_lists *lists)
{
    free(lists->first);
    free(lists->list);
    *lists = (struct kiln_row_lists){.bands = 0};
}
