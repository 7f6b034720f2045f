/* This file lists the items that touch each band of rows, by a counting sort: it counts each list's
 * length, then sums the lengths to where each list begins, then fills the lists of as many bands as
 * fit. */
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
        free(lists->next);
        lists->first = malloc(((size_t)bands + 1) * sizeof *lists->first);
        lists->next = malloc(bands * sizeof *lists->next);
        lists->band_room = lists->first && lists->next ? bands : 0;
    }
    lists->bands = bands;
    return lists->band_room >= bands;
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

/* Counts the items of each band, and sums up where the lists begin. */
static bool start(struct kiln_row_lists *lists, const struct kiln_row_items *items,
                  struct kiln_error *error)
{
    const int tall = (int)items->band_height;
    if (!make_bands(lists, (items->height + items->band_height - 1) / items->band_height))
        return out_of_memory(error);
    size_t *first = lists->first;
    memset(first, 0, ((size_t)lists->bands + 1) * sizeof *first);
    for (uint32_t i = 0; i < items->count; i++) {
        const struct kiln_row_range rows = items->ranges[i];
        for (int band = rows.from / tall; rows.from < rows.to && band * tall < rows.to; band++)
            first[band + 1]++;
    }
    for (uint32_t band = 0; band < lists->bands; band++)
        first[band + 1] += first[band];
    lists->begin = lists->end = 0;
    return true;
}

/* Makes the lists of the next bands, of as many as fit, but of one at least. */
static bool make_next(struct kiln_row_lists *lists, const struct kiln_row_items *items,
                      struct kiln_error *error)
{
    const int tall = (int)items->band_height;
    const size_t *first = lists->first;
    const uint32_t begin = lists->end;
    uint32_t end = begin + 1;
    while (end < lists->bands && first[end + 1] - first[begin] <= KILN_ROW_LISTS_MOST)
        end++;
    lists->begin = begin;
    lists->end = end;
    if (!make_room(lists, first[end] - first[begin]))
        return out_of_memory(error);
    for (uint32_t band = begin; band < end; band++)
        lists->next[band] = first[band] - first[begin];
    for (uint32_t i = 0; i < items->count; i++) {
        const struct kiln_row_range rows = items->ranges[i];
        if (rows.from >= rows.to)
            continue;
        const int from = rows.from / tall;
        for (int band = from < (int)begin ? (int)begin : from;
             band < (int)end && band * tall < rows.to; band++)
            lists->list[lists->next[band]++] = i;
    }
    return true;
}

bool kiln_row_lists_draw(struct kiln_row_lists *lists, const struct kiln_row_items *items,
                         struct kiln_threads *threads,
                         void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                         void *context, struct kiln_error *error)
{
    bool ok = start(lists, items, error);
    while (ok && lists->end < lists->bands)
        ok = make_next(lists, items, error) &&
             kiln_threads_try(threads, lists->end - lists->begin, 1, body, context, error);
    return ok;
}

void kiln_row_lists_finish(struct kiln_row_lists *lists)
{
    free(lists->first);
    free(lists->next);
    free(lists->list);
    *lists = (struct kiln_row_lists){.bands = 0};
}

void kiln_row_lists_footprint(uint64_t count, uint64_t bands, enum kiln_footprint_part part,
                              struct kiln_footprint *footprint)
{
    const struct kiln_row_lists *l = NULL;
    const uint64_t all =
        count < KILN_ROW_LISTS_MOST / (bands ? bands : 1) ? count * bands : KILN_ROW_LISTS_MOST;
    const uint64_t listed = all > count ? all : count;
    kiln_footprint_add(footprint, part, bands, sizeof *l->first + sizeof *l->next);
    kiln_footprint_add(footprint, part, listed, sizeof *l->list);
}
