/* What the page's scripts read: the members of result.json by their names there, as scripts write
 * names ("device_name" is "deviceName"), and what is made for the page. */
#include "report/test_data.h"

#include <ctype.h>

#include "report/markup.h"
#include "suite/result_member.h"

/* ---- Members of a result ------------------------------------------------------------------ */

static void add_key(FILE *out, const char *name)
{
    fputc('"', out);
    for (const char *c = name; *c; c++)
        fputc(*c == '_' && c[1] ? toupper(*++c) : *c, out);
    fputs("\":", out);
}

static void add_value(FILE *out, enum kiln_member_kind kind, const void *value)
{
    switch (kind) {
    case KILN_MEMBER_TEXT:
    case KILN_MEMBER_FILE:
        kiln_markup_write_json(out, *(const char *const *)value);
        break;
    case KILN_MEMBER_NAME:
        kiln_markup_write_json(out, value);
        break;
    case KILN_MEMBER_UINT32:
        fprintf(out, "%u", *(const uint32_t *)value);
        break;
    case KILN_MEMBER_DOUBLE:
        kiln_markup_write_number(out, *(const double *)value);
        break;
    case KILN_MEMBER_BOOL:
        fputs(*(const bool *)value ? "true" : "false", out);
        break;
    case KILN_MEMBER_CODE:
        fprintf(out, "%d", (int)*(const enum kiln_code *)value);
        break;
    case KILN_MEMBER_STATUS:
        kiln_markup_write_json(out, kiln_test_status_name(*(const enum kiln_test_status *)value));
        break;
    case KILN_MEMBER_JUDGED_BY:
        kiln_markup_write_json(out, kiln_judged_by_name(*(const enum kiln_judged_by *)value));
        break;
    case KILN_MEMBER_END:
        break;
    }
}

static void add_members(FILE *out, const struct kiln_member *members, const void *object)
{
    for (const struct kiln_member *m = members; m->name; m++) {
        fputs(m == members ? "" : ",", out);
        add_key(out, m->name);
        add_value(out, m->kind, (const char *)object + m->offset);
    }
}

static void add_columns(FILE *out, const struct kiln_result *result)
{
    fputs(",\"columns\":[", out);
    for (size_t i = 0; i < result->column_count; i++) {
        fputs(i ? ",{" : "{", out);
        add_members(out, kiln_result_column_members, &result->columns[i]);
        fputc('}', out);
    }
    fputc(']', out);
}

/* ---- What is made for the page ------------------------------------------------------------ */

static void add_pictures(FILE *out, const struct kiln_gallery_place *places)
{
    fputs(",\"pictures\":[", out);
    for (int i = 0; i < KILN_GALLERY_ROLE_COUNT; i++) {
        const struct kiln_gallery_place *place = &places[i];
        fputs(i ? "," : "", out);
        switch (place->kind) {
        case KILN_GALLERY_NONE:
            fputs("null", out);
            break;
        case KILN_GALLERY_INSIDE:
            fprintf(out, "%u", place->number);
            break;
        case KILN_GALLERY_LINKED:
            fputs("{\"url\":\"", out);
            kiln_markup_write_url(out, place->text);
            fputs("\"}", out);
            break;
        case KILN_GALLERY_BROKEN:
            fputs("{\"problem\":", out);
            kiln_markup_write_json(out, place->text);
            fputc('}', out);
            break;
        }
    }
    fputc(']', out);
}

static void add_measurement(FILE *out, const struct kiln_result *result,
                            const struct kiln_result_frame *frame)
{
    fputc(',', out);
    add_members(out, kiln_result_measured_members, frame);
    fputs(",\"values\":[", out);
    for (size_t i = 0; i < result->column_count; i++) {
        fputs(i ? "," : "", out);
        kiln_markup_write_number(out, frame->values[i]);
    }
    fputs("],\"beyond\":[", out);
    for (size_t i = 0; i < result->column_count; i++)
        fprintf(out, "%s%d", i ? "," : "", frame->beyond[i]);
    fputc(']', out);
}

static void add_frame(FILE *out, const struct kiln_result *result,
                      const struct kiln_result_frame *frame,
                      const struct kiln_gallery_place *places)
{
    fputc('{', out);
    add_members(out, kiln_result_frame_members, frame);
    add_pictures(out, places);
    if (frame->measured)
        add_measurement(out, result, frame);
    fputc('}', out);
}

static void add_changes(FILE *out, const struct kiln_result *result)
{
    fputs(",\"changes\":[", out);
    for (size_t i = 0; i < result->change_count; i++) {
        const struct kiln_result_change *change = &result->changes[i];
        fputs(i ? ",[" : "[", out);
        kiln_markup_write_json(out, change->key);
        fputc(',', out);
        kiln_markup_write_json(out, change->before);
        fputc(',', out);
        kiln_markup_write_json(out, change->after);
        fputc(']', out);
    }
    fputs("],\"notes\":[", out);
    for (size_t i = 0; i < result->note_count; i++) {
        fputs(i ? "," : "", out);
        kiln_markup_write_json(out, result->notes[i]);
    }
    fputc(']', out);
}

void kiln_test_data_write(FILE *out, const struct kiln_results *results, size_t test,
                          const struct kiln_gallery *gallery)
{
    const struct kiln_result *result = results->tests[test];
    fputs("{\"folder\":", out);
    kiln_markup_write_json(out, results->folders[test]);
    fputc(',', out);
    add_members(out, kiln_result_members, result);
    add_columns(out, result);
    fprintf(out, ",\"first\":%zu,\"frames\":[", kiln_result_worst_frame(result));
    for (size_t i = 0; i < result->frame_count; i++) {
        fputs(i ? "," : "", out);
        add_frame(out, result, &result->frames[i], kiln_gallery_places(gallery, test, i));
    }
    fputc(']', out);
    add_changes(out, result);
    fputc('}', out);
}
