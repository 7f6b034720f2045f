/* Writes result.json by the tables of members (result.c) by which result_read.c reads it. */
#include <stdio.h>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/temporary.h"
#include "suite/result_member.h"

void kiln_member_write(struct kiln_json *json, const char *key, const struct kiln_member *member,
                       const void *object)
{
    const void *value = (const char *)object + member->offset;
    switch (member->kind) {
    case KILN_MEMBER_TEXT:
    case KILN_MEMBER_FILE:
    case KILN_MEMBER_HASH:
        kiln_json_string(json, key, *(const char *const *)value);
        break;
    case KILN_MEMBER_NAME:
        kiln_json_string(json, key, value);
        break;
    case KILN_MEMBER_UINT32:
        kiln_json_uint(json, key, *(const uint32_t *)value);
        break;
    case KILN_MEMBER_DOUBLE:
        kiln_json_number(json, key, *(const double *)value);
        break;
    case KILN_MEMBER_BOOL:
        kiln_json_bool(json, key, *(const bool *)value);
        break;
    case KILN_MEMBER_CODE:
        kiln_json_int(json, key, (int)*(const enum kiln_code *)value);
        break;
    case KILN_MEMBER_STATUS:
        kiln_json_string(json, key, kiln_test_status_name(*(const enum kiln_test_status *)value));
        break;
    case KILN_MEMBER_JUDGED_BY:
        kiln_json_string(json, key, kiln_judged_by_name(*(const enum kiln_judged_by *)value));
        break;
    case KILN_MEMBER_END:
        break;
    }
}

static void add_members(struct kiln_json *json, const struct kiln_member *members,
                        const void *object)
{
    for (const struct kiln_member *m = members; m->name; m++)
        kiln_member_write(json, m->name, m, object);
}

static void add_object(struct kiln_json *json, const struct kiln_member *members,
                       const void *object)
{
    kiln_json_begin_object(json, NULL);
    add_members(json, members, object);
    kiln_json_end(json);
}

/* Begins a list whose entries have lines of their own. */
static void begin_list(struct kiln_json *json, const char *key)
{
    kiln_json_begin_array(json, key);
    kiln_json_indent_items(json, 4);
}

static void add_measurement(struct kiln_json *json, const struct kiln_result *result,
                            const struct kiln_result_frame *frame)
{
    add_members(json, kiln_result_measured_members, frame);
    kiln_json_begin_object(json, "metrics");
    for (size_t i = 0; i < result->column_count; i++)
        kiln_json_number(json, result->columns[i].name, frame->values[i]);
    kiln_json_end(json);
    kiln_json_begin_array(json, "beyond");
    for (size_t i = 0; i < result->column_count; i++)
        if (frame->beyond[i])
            kiln_json_string(json, NULL, result->columns[i].name);
    kiln_json_end(json);
}

static void add_frame(struct kiln_json *json, const struct kiln_result *result,
                      const struct kiln_result_frame *frame)
{
    kiln_json_begin_object(json, NULL);
    add_members(json, kiln_result_frame_members, frame);
    if (frame->measured)
        add_measurement(json, result, frame);
    kiln_json_end(json);
}

/* Returns how many of `count` entries are written; the others are summed up in one more. */
static size_t entries_written(size_t count)
{
    return count > KILN_RESULT_MAX_ENTRIES ? KILN_RESULT_MAX_ENTRIES - 1 : count;
}

static void add_change(struct kiln_json *json, const struct kiln_result_change *change)
{
    kiln_json_begin_object(json, NULL);
    add_members(json, kiln_result_change_members, change);
    if (*change->place)
        kiln_json_string(json, "place", change->place);
    kiln_json_end(json);
}

static void add_changes(struct kiln_json *json, const struct kiln_result *result)
{
    begin_list(json, "changes");
    size_t written = entries_written(result->change_count);
    for (size_t i = 0; i < written; i++)
        add_change(json, &result->changes[i]);
    if (written < result->change_count) {
        char key[64];
        snprintf(key, sizeof key, "and %zu more", result->change_count - written);
        add_change(json, &(struct kiln_result_change){key, "", "", ""});
    }
    kiln_json_end(json);
}

static void add_notes(struct kiln_json *json, const struct kiln_result *result)
{
    begin_list(json, "notes");
    size_t written = entries_written(result->note_count);
    for (size_t i = 0; i < written; i++)
        kiln_json_string(json, NULL, result->notes[i]);
    if (written < result->note_count)
        kiln_json_format(json, NULL, "and %zu more", result->note_count - written);
    kiln_json_end(json);
}

void kiln_result_add_json(struct kiln_json *json, const struct kiln_result *result)
{
    add_members(json, kiln_result_members, result);
    begin_list(json, "columns");
    for (size_t i = 0; i < result->column_count; i++)
        add_object(json, kiln_result_column_members, &result->columns[i]);
    kiln_json_end(json);
    begin_list(json, "frames");
    for (size_t i = 0; i < result->frame_count; i++)
        add_frame(json, result, &result->frames[i]);
    kiln_json_end(json);
    add_changes(json, result);
    add_notes(json, result);
}

bool kiln_result_print(const struct kiln_result *result, struct kiln_text *text)
{
    struct kiln_json json = kiln_json_to_text(text);
    kiln_json_begin_object(&json, NULL);
    kiln_json_indent_items(&json, 2);
    kiln_json_uint(&json, "kiln_result", KILN_RESULT_VERSION);
    kiln_result_add_json(&json, result);
    kiln_json_end_indented(&json, 0);
    return kiln_json_finish(&json);
}

bool kiln_result_write(const struct kiln_result *result, const char *folder,
                       struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, folder, "result.json", error))
        return false;
    struct kiln_text text = {0};
    bool written = kiln_result_print(result, &text)
                       ? kiln_temporary_write_file(path, text.data, text.length, error)
                       : kiln_error_no_memory(error, "%s", path);
    kiln_text_free(&text);
    return written;
}
