/* Frame lists: read piece by piece, sorted, merged. */
#include "frames.h"

#include <stdlib.h>
#include <string.h>

/* Reads the digits at *text as a frame number and moves past them. */
static bool read_frame(const char **text, uint32_t *frame)
{
    char digits[16] = "";
    size_t length = strspn(*text, "0123456789");
    if (length >= sizeof digits)
        return false;
    memcpy(digits, *text, length);
    uint64_t value = 0;
    if (!kiln_text_to_uint64(digits, &value) || value >= UINT32_MAX)
        return false;
    *frame = (uint32_t)value;
    *text += length;
    return true;
}

static bool read_range(const char **text, struct kiln_frame_range *range)
{
    if (!read_frame(text, &range->first))
        return false;
    range->last = range->first;
    if (**text == '-') {
        (*text)++;
        if (!read_frame(text, &range->last))
            return false;
    }
    return range->first <= range->last;
}

static int compare_ranges(const void *a, const void *b)
{
    uint32_t x = ((const struct kiln_frame_range *)a)->first;
    uint32_t y = ((const struct kiln_frame_range *)b)->first;
    return (x > y) - (x < y);
}

static void merge_ranges(struct frame_list *list)
{
    qsort(list->ranges, list->count, sizeof *list->ranges, compare_ranges);
    size_t merged = 0;
    for (size_t i = 1; i < list->count; i++) {
        struct kiln_frame_range *before = &list->ranges[merged];
        struct kiln_frame_range range = list->ranges[i];
        if (range.first > before->last + 1)
            list->ranges[++merged] = range;
        else if (range.last > before->last)
            before->last = range.last;
    }
    list->count = merged + 1;
}

bool frame_list_parse(const char *text, struct frame_list *list)
{
    size_t pieces = 1;
    for (const char *c = text; *c; c++)
        pieces += *c == ',';
    *list = (struct frame_list){.ranges = calloc(pieces, sizeof *list->ranges)};
    while (list->ranges && read_range(&text, &list->ranges[list->count])) {
        list->count++;
        if (*text == '\0') {
            merge_ranges(list);
            return true;
        }
        if (*text++ != ',')
            break;
    }
    frame_list_free(list);
    return false;
}

void frame_list_free(struct frame_list *list)
{
    free(list->ranges);
    *list = (struct frame_list){0};
}

bool frame_list_next(const struct frame_list *list, uint32_t frame, uint32_t *next)
{
    for (size_t i = 0; i < list->count; i++) {
        if (list->ranges[i].last > frame) {
            *next = list->ranges[i].first > frame ? list->ranges[i].first : frame + 1;
            return true;
        }
    }
    return false;
}
