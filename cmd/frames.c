/* Parses lists of frames such as "0-149,200" and turns them into sorted, merged ranges of a clip.
 */
#include "frames.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_RANGES = 1 << 24 }; /* far more than the frames of a scene */

static const char last_word[] = "last";

/* Reads the digits at *text as a number below UINT32_MAX and moves past them. */
static bool read_number(const char **text, uint32_t *number)
{
    char digits[16] = "";
    size_t length = strspn(*text, "0123456789");
    if (length >= sizeof digits)
        return false;
    memcpy(digits, *text, length);
    uint64_t value = 0;
    if (!kiln_text_to_uint64(digits, &value) || value >= UINT32_MAX)
        return false;
    *number = (uint32_t)value;
    *text += length;
    return true;
}

/* Reads a number, or "last", which stands for the clip's last frame. */
static bool read_frame(const char **text, uint32_t *frame, bool *is_last)
{
    *is_last = strncmp(*text, last_word, sizeof last_word - 1) == 0;
    if (!*is_last)
        return read_number(text, frame);
    *text += sizeof last_word - 1;
    return true;
}

static bool ends(const char *text)
{
    return *text == '\0' || *text == ',' || *text == '/';
}

/* Reads the part before the step: FRAME, FIRST-LAST, FIRST- or -LAST. */
static bool read_range(const char **text, struct frame_piece *piece)
{
    const bool from_start = **text == '-';
    if (!from_start && !read_frame(text, &piece->first, &piece->first_is_last))
        return false;
    piece->last = piece->first;
    piece->last_is_last = piece->first_is_last;
    if (**text != '-')
        return true;
    (*text)++;
    if (!from_start && ends(*text)) {
        piece->last_is_last = true;
        return true;
    }
    return read_frame(text, &piece->last, &piece->last_is_last) &&
           (piece->last_is_last || (!piece->first_is_last && piece->first <= piece->last));
}

static bool read_piece(const char **text, struct frame_piece *piece)
{
    const char *start = *text;
    *piece = (struct frame_piece){.step = 1};
    if (!read_range(text, piece))
        return false;
    if (**text == '/') { /* a single frame can have no step */
        const bool is_range = memchr(start, '-', (size_t)(*text - start)) != NULL;
        (*text)++;
        if (!is_range || !read_number(text, &piece->step) || piece->step == 0)
            return false;
    }
    return **text == '\0' || **text == ',';
}

bool frame_spec_parse(const char *text, struct frame_spec *spec, struct frame_piece_place *wrong)
{
    size_t most = 1;
    for (const char *c = text; *c; c++)
        most += *c == ',';
    *spec = (struct frame_spec){.pieces = calloc(most, sizeof *spec->pieces)};
    *wrong = (struct frame_piece_place){.no_memory = !spec->pieces};
    for (const char *next = text; spec->pieces;) {
        const char *start = next;
        if (!read_piece(&next, &spec->pieces[spec->count])) {
            wrong->start = (size_t)(start - text);
            wrong->length = strcspn(start, ",");
            break;
        }
        spec->count++;
        if (*next++ == '\0')
            return true;
    }
    frame_spec_free(spec);
    return false;
}

void frame_spec_free(struct frame_spec *spec)
{
    free(spec->pieces);
    *spec = (struct frame_spec){0};
}

bool frame_spec_is_open(const struct frame_spec *spec)
{
    for (size_t i = 0; i < spec->count; i++) {
        if (spec->pieces[i].last_is_last)
            return true;
    }
    return false;
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

/* Resolves a piece into frame numbers of the clip. Returns FRAMES_BEYOND, with the wrong number in
 * *frame, if the piece goes beyond the clip. */
static enum frame_result close_piece(struct frame_piece *piece, uint32_t last, uint32_t *frame)
{
    piece->first = piece->first_is_last ? last : piece->first;
    piece->last = piece->last_is_last ? last : piece->last;
    *frame = piece->last > last ? piece->last : piece->first;
    return *frame > last ? FRAMES_BEYOND : FRAMES_OK;
}

static size_t count_ranges(const struct frame_piece *piece)
{
    return piece->step == 1 ? 1 : (size_t)((piece->last - piece->first) / piece->step) + 1;
}

enum frame_result frame_list_create(struct frame_list *list, const struct frame_spec *spec,
                                    uint32_t last, uint32_t *frame)
{
    size_t most = 0;
    *list = (struct frame_list){0};
    for (size_t i = 0; i < spec->count; i++) {
        struct frame_piece piece = spec->pieces[i];
        const enum frame_result result = close_piece(&piece, last, frame);
        if (result != FRAMES_OK)
            return result;
        most += count_ranges(&piece);
    }
    list->ranges = most <= MAX_RANGES ? calloc(most, sizeof *list->ranges) : NULL;
    if (!list->ranges)
        return FRAMES_NO_MEMORY;
    for (size_t i = 0; i < spec->count; i++) {
        struct frame_piece piece = spec->pieces[i];
        close_piece(&piece, last, frame);
        const size_t count = count_ranges(&piece);
        for (size_t k = 0; k < count; k++) {
            const uint32_t at = piece.first + (uint32_t)k * piece.step;
            list->ranges[list->count++] =
                (struct kiln_frame_range){at, piece.step == 1 ? piece.last : at};
        }
    }
    merge_ranges(list);
    return FRAMES_OK;
}

void frame_list_free(struct frame_list *list)
{
    free(list->ranges);
    *list = (struct frame_list){0};
}
