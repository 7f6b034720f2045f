/* Writes the data of a test that the page's scripts read: the members of result.json, with their
 * names in camel case ("device_name" becomes "deviceName"), and data that only the page needs. */
#include "report/test_data.h"

#include <ctype.h>
#include <stdlib.h>

#include "report/markup.h"
#include "suite/result_member.h"

/* ---- Members of a result ------------------------------------------------------------------ */

enum { KEY_SIZE = 64 };

/* Converts a member's name to camel case: "device_name" to "deviceName". */
static const char *script_name(char key[KEY_SIZE], const char *name)
{
    size_t length = 0;
    for (const char *c = name; *c && length + 1 < KEY_SIZE; c++)
        key[length++] = (char)(*c == '_' && c[1] ? toupper(*++c) : *c);
    key[length] = '\0';
    return key;
}

static void add_members(struct kiln_json *json, const struct kiln_member *members,
                        const void *object)
{
    char key[KEY_SIZE];
    for (const struct kiln_member *m = members; m->name; m++)
        kiln_member_write(json, script_name(key, m->name), m, object);
}

static void add_columns(struct kiln_json *json, const struct kiln_result *result)
{
    kiln_json_begin_array(json, "columns");
    for (size_t i = 0; i < result->column_count; i++) {
        kiln_json_begin_object(json, NULL);
        add_members(json, kiln_result_column_members, &result->columns[i]);
        kiln_json_end(json);
    }
    kiln_json_end(json);
}

/* ---- What is made for the page ------------------------------------------------------------ */

static void add_url(struct kiln_json *json, const char *path)
{
    char *url = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&url, &size);
    if (memory)
        kiln_markup_write_url(memory, path);
    json->failed |= !memory || fclose(memory) != 0;
    kiln_json_string(json, "url", url);
    free(url);
}

static void add_picture(struct kiln_json *json, const struct kiln_gallery_place *place)
{
    if (place->kind == KILN_GALLERY_NONE) {
        kiln_json_null(json, NULL);
        return;
    }
    if (place->kind == KILN_GALLERY_EMBEDDED) {
        kiln_json_uint(json, NULL, place->number);
        return;
    }
    kiln_json_begin_object(json, NULL);
    if (place->kind == KILN_GALLERY_LINKED)
        add_url(json, place->text);
    else
        kiln_json_string(json, "problem", place->text);
    kiln_json_end(json);
}

static void add_measurement(struct kiln_json *json, const struct kiln_result *result,
                            const struct kiln_result_frame *frame)
{
    add_members(json, kiln_result_measured_members, frame);
    kiln_json_begin_array(json, "values");
    for (size_t i = 0; i < result->column_count; i++)
        kiln_json_number(json, NULL, frame->values[i]);
    kiln_json_end(json);
    kiln_json_begin_array(json, "beyond");
    for (size_t i = 0; i < result->column_count; i++)
        kiln_json_int(json, NULL, frame->beyond[i]);
    kiln_json_end(json);
}

static void add_frame(struct kiln_json *json, const struct kiln_result *result,
                      const struct kiln_result_frame *frame,
                      const struct kiln_gallery_place *places)
{
    kiln_json_begin_object(json, NULL);
    add_members(json, kiln_result_frame_members, frame);
    kiln_json_begin_array(json, "pictures");
    for (int i = 0; i < KILN_GALLERY_ROLE_COUNT; i++)
        add_picture(json, &places[i]);
    kiln_json_end(json);
    if (frame->measured)
        add_measurement(json, result, frame);
    kiln_json_end(json);
}

static void add_changes(struct kiln_json *json, const struct kiln_result *result)
{
    kiln_json_begin_array(json, "changes");
    for (size_t i = 0; i < result->change_count; i++) {
        const struct kiln_result_change *change = &result->changes[i];
        const char *const texts[] = {change->key, change->before, change->after, change->place};
        kiln_json_strings(json, NULL, texts, 4);
    }
    kiln_json_end(json);
}

void kiln_test_data_write(FILE *out, const struct kiln_results *results, size_t test,
                          const struct kiln_gallery *gallery)
{
    const struct kiln_result *result = results->tests[test];
    struct kiln_json json = kiln_json_to_file(out);
    json.style = KILN_JSON_SCRIPT;
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json, "folder", results->folders[test]);
    add_members(&json, kiln_result_members, result);
    add_columns(&json, result);
    kiln_json_uint(&json, "first", kiln_result_worst_frame(result));
    kiln_json_begin_array(&json, "frames");
    for (size_t i = 0; i < result->frame_count; i++)
        add_frame(&json, result, &result->frames[i], kiln_gallery_places(gallery, test, i));
    kiln_json_end(&json);
    add_changes(&json, result);
    kiln_json_strings(&json, "notes", result->notes, result->note_count);
    kiln_json_end(&json);
}
