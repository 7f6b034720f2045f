/* Keeps the records of a job's frames in an array, and finds them by the numbers of the frames. */
#include "job/record.h"

#include <stdlib.h>
#include <string.h>

#include "base/ranges.h"

bool kiln_records_create(struct kiln_records *records, const struct kiln_frame_range *clip,
                         size_t clip_count)
{
    *records = (struct kiln_records){.clip = clip, .clip_count = clip_count};
    records->count = (uint32_t)kiln_ranges_count(clip, clip_count);
    records->items = calloc(records->count, sizeof *records->items);
    return records->items != NULL;
}

void kiln_records_free(struct kiln_records *records)
{
    free(records->items);
    kiln_text_free(&records->runs);
    *records = (struct kiln_records){.items = NULL};
}

struct kiln_record *kiln_records_of(const struct kiln_records *records, uint32_t frame)
{
    uint32_t index;
    return kiln_ranges_find(records->clip, records->clip_count, frame, &index)
               ? &records->items[index]
               : NULL;
}

uint32_t kiln_records_frame(const struct kiln_records *records, uint32_t index)
{
    return kiln_ranges_at(records->clip, records->clip_count, index);
}

static void take_clip(struct kiln_records *records, const struct kiln_finished_file *finished)
{
    const uint32_t room = sizeof records->files / sizeof *records->files;
    uint32_t i = 0;
    while (i < records->file_count && strcmp(records->files[i].path, finished->path) != 0)
        i++;
    if (i == room)
        return;
    records->file_count = i < records->file_count ? records->file_count : i + 1;
    struct kiln_clip_file *file = &records->files[i];
    snprintf(file->path, sizeof file->path, "%s", finished->path);
    memcpy(file->sha256, finished->sha256, sizeof file->sha256);
    file->bytes = finished->bytes;
}

void kiln_records_take(struct kiln_records *records, const struct kiln_finished_file *finished)
{
    if (finished->is_clip) {
        take_clip(records, finished);
        return;
    }
    /* A clip may leave out frames, which have no record. */
    for (uint64_t frame = finished->frames.first; frame <= finished->frames.last; frame++) {
        struct kiln_record *record = kiln_records_of(records, (uint32_t)frame);
        if (!record)
            continue;
        record->whole = true;
        if (finished->is_part)
            continue;
        record->bytes = finished->bytes;
        memcpy(record->sha256, finished->sha256, sizeof record->sha256);
    }
}
