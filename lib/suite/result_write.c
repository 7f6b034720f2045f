/* result.json, written by the same tables of members as it is read. */
#include <math.h>
#include <stdio.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary.h"
#include "base/text.h"
#include "suite/result_member.h"

/* JSON knows no infinity, which PSNR of equal pictures is; null stands for it. */
static void add_double(struct kiln_text *text, double value)
{
    char number[32] = "null";
    if (isfinite(value))
        kiln_text_from_double(number, value);
    kiln_text_add(text, "%s", number);
}

static void add_value(struct kiln_text *text, enum kiln_member_kind kind, const void *value)
{
    switch (kind) {
    case KILN_MEMBER_TEXT:
    case KILN_MEMBER_FILE:
        kiln_text_add_json(text, *(const char *const *)value);
        break;
    case KILN_MEMBER_NAME:
        kiln_text_add_json(text, value);
        break;
    case KILN_MEMBER_UINT32:
        kiln_text_add(text, "%u", *(const uint32_t *)value);
        break;
    case KILN_MEMBER_DOUBLE:
        add_double(text, *(const double *)value);
        break;
    case KILN_MEMBER_BOOL:
        kiln_text_add(text, "%s", *(const bool *)value ? "true" : "false");
        break;
    case KILN_MEMBER_CODE:
        kiln_text_add(text, "%d", (int)*(const enum kiln_code *)value);
        break;
    case KILN_MEMBER_STATUS:
        kiln_text_add_json(text, kiln_test_status_name(*(const enum kiln_test_status *)value));
        break;
    case KILN_MEMBER_JUDGED_BY:
        kiln_text_add_json(text, kiln_judged_by_name(*(const enum kiln_judged_by *)value));
        break;
    case KILN_MEMBER_END:
        break;
    }
}

/* `between` goes between two members. */
static void add_members(struct kiln_text *text, const struct kiln_member *members,
                        const void *object, const char *between)
{
    for (const struct kiln_member *m = members; m->name; m++) {
        kiln_text_add(text, "%s\"%s\": ", m == members ? "" : between, m->name);
        add_value(text, m->kind, (const char *)object + m->offset);
    }
}

static void add_measurement(struct kiln_text *text, const struct kiln_result *result,
                            const struct kiln_result_frame *frame)
{
    kiln_text_add(text, ", ");
    add_members(text, kiln_result_measured_members, frame, ", ");
    kiln_text_add(text, ", \"metrics\": {");
    for (size_t i = 0; i < result->column_count; i++) {
        kiln_text_add(text, i ? ", " : "");
        kiln_text_add_json(text, result->columns[i].name);
        kiln_text_add(text, ": ");
        add_double(text, frame->values[i]);
    }
    kiln_text_add(text, "}, \"beyond\": [");
    const char *comma = "";
    for (size_t i = 0; i < result->column_count; i++) {
        if (!frame->beyond[i])
            continue;
        kiln_text_add(text, "%s", comma);
        kiln_text_add_json(text, result->columns[i].name);
        comma = ", ";
    }
    kiln_text_add(text, "]");
}

/* Opens the list at its first entry, and its lines. */
static void start_entry(struct kiln_text *text, size_t index)
{
    kiln_text_add(text, index ? ",\n    " : "\n    ");
}

static void add_columns(struct kiln_text *text, const struct kiln_result *result)
{
    kiln_text_add(text, "\"columns\": [");
    for (size_t i = 0; i < result->column_count; i++) {
        start_entry(text, i);
        kiln_text_add(text, "{");
        add_members(text, kiln_result_column_members, &result->columns[i], ", ");
        kiln_text_add(text, "}");
    }
    kiln_text_add(text, "]");
}

static void add_frames(struct kiln_text *text, const struct kiln_result *result)
{
    kiln_text_add(text, "\"frames\": [");
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        start_entry(text, i);
        kiln_text_add(text, "{");
        add_members(text, kiln_result_frame_members, frame, ", ");
        if (frame->measured)
            add_measurement(text, result, frame);
        kiln_text_add(text, "}");
    }
    kiln_text_add(text, "]");
}

/* How many of `count` entries are written; the others are summed up in one more. */
static size_t entries_written(size_t count)
{
    return count > KILN_RESULT_MAX_ENTRIES ? KILN_RESULT_MAX_ENTRIES - 1 : count;
}

static void add_changes(struct kiln_text *text, const struct kiln_result *result)
{
    kiln_text_add(text, "\"changes\": [");
    size_t written = entries_written(result->change_count);
    for (size_t i = 0; i < written; i++) {
        start_entry(text, i);
        kiln_text_add(text, "{");
        add_members(text, kiln_result_change_members, &result->changes[i], ", ");
        kiln_text_add(text, "}");
    }
    if (written < result->change_count) {
        char key[64];
        snprintf(key, sizeof key, "and %zu more", result->change_count - written);
        const struct kiln_result_change rest = {key, "", ""};
        start_entry(text, written);
        kiln_text_add(text, "{");
        add_members(text, kiln_result_change_members, &rest, ", ");
        kiln_text_add(text, "}");
    }
    kiln_text_add(text, "]");
}

static void add_notes(struct kiln_text *text, const struct kiln_result *result)
{
    kiln_text_add(text, "\"notes\": [");
    size_t written = entries_written(result->note_count);
    for (size_t i = 0; i < written; i++) {
        start_entry(text, i);
        kiln_text_add_json(text, result->notes[i]);
    }
    if (written < result->note_count) {
        start_entry(text, written);
        kiln_text_add(text, "\"and %zu more\"", result->note_count - written);
    }
    kiln_text_add(text, "]");
}

void kiln_result_add_json(struct kiln_text *text, const struct kiln_result *result)
{
    add_members(text, kiln_result_members, result, ",\n  ");
    kiln_text_add(text, ",\n  ");
    add_columns(text, result);
    kiln_text_add(text, ",\n  ");
    add_frames(text, result);
    kiln_text_add(text, ",\n  ");
    add_changes(text, result);
    kiln_text_add(text, ",\n  ");
    add_notes(text, result);
}

bool kiln_result_write(const struct kiln_result *result, const char *folder,
                       struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, folder, "result.json", error))
        return false;
    struct kiln_text text = {0};
    kiln_text_add(&text, "{\n  \"kiln_result\": %d,\n  ", KILN_RESULT_VERSION);
    kiln_result_add_json(&text, result);
    kiln_text_add(&text, "\n}\n");
    bool written = text.failed ? kiln_error_set(error, KILN_IO, "%s: no memory to write it", path)
                               : kiln_temporary_write_file(path, text.data, text.length, error);
    kiln_text_free(&text);
    return written;
}
