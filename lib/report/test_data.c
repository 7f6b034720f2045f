/* Each object starts with a member that is always there, so that all others follow a comma. */
#include "report/test_data.h"

#include "report/markup.h"

static void add_text(FILE *out, const char *key, const char *text)
{
    fprintf(out, ",\"%s\":", key);
    kiln_markup_write_json(out, text);
}

static void add_number(FILE *out, const char *key, double value)
{
    fprintf(out, ",\"%s\":", key);
    kiln_markup_write_number(out, value);
}

static void add_facts(FILE *out, const struct kiln_result *result)
{
    const struct {
        const char *key, *text;
    } texts[] = {
        {"test", result->test},
        {"scene", result->scene},
        {"about", result->about},
        {"golden", result->golden},
        {"status", kiln_test_status_name(result->status)},
        {"message", result->message},
        {"log", result->log},
        {"device", result->device},
        {"deviceName", result->device_name},
        {"driver", result->driver},
        {"platform", result->platform},
        {"techniques", result->techniques},
        {"techniquesExpected", result->techniques_expected},
        {"version", result->version},
        {"sceneHash", result->scene_hash},
        {"sceneHashExpected", result->scene_hash_expected},
        {"started", result->started},
        {"rerun", result->rerun},
        {"approve", result->approve},
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        add_text(out, texts[i].key, texts[i].text);
    add_number(out, "code", result->code);
    add_number(out, "seed", result->seed);
    add_number(out, "width", result->width);
    add_number(out, "height", result->height);
    add_number(out, "threads", result->threads);
    add_number(out, "repeat", result->repeat);
    add_number(out, "totalSeconds", result->total_s);
    add_number(out, "warn", result->warn);
    fprintf(out, ",\"hdr\":%s", result->hdr ? "true" : "false");
}

static void add_columns(FILE *out, const struct kiln_result *result)
{
    fputs(",\"columns\":[", out);
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        fprintf(out, "%s{\"higher\":%s", i ? "," : "", column->higher_is_better ? "true" : "false");
        add_text(out, "name", column->name);
        add_text(out, "unit", column->unit);
        if (column->limited)
            add_number(out, "limit", column->limit);
        fputc('}', out);
    }
    fputc(']', out);
}

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
    add_number(out, "score", frame->score);
    fputs(",\"values\":[", out);
    for (size_t i = 0; i < result->column_count; i++) {
        fputs(i ? "," : "", out);
        kiln_markup_write_number(out, frame->values[i]);
    }
    fputs("],\"beyond\":[", out);
    for (size_t i = 0; i < result->column_count; i++)
        fprintf(out, "%s%d", i ? "," : "", frame->beyond[i]);
    fprintf(out, "],\"worst\":[%u,%u],\"window\":[%u,%u,%u,%u,%u]", frame->worst_x, frame->worst_y,
            frame->window_x, frame->window_y, frame->window_width, frame->window_height,
            frame->window_differing);
}

static void add_frame(FILE *out, const struct kiln_result *result,
                      const struct kiln_result_frame *frame,
                      const struct kiln_gallery_place *places)
{
    fprintf(out, "{\"number\":%u", frame->number);
    add_text(out, "status", kiln_test_status_name(frame->status));
    add_text(out, "judgedBy", kiln_judged_by_name(frame->judged_by));
    add_text(out, "message", frame->message);
    add_text(out, "golden", frame->golden);
    add_text(out, "state", frame->state);
    add_text(out, "stateExpected", frame->state_expected);
    add_text(out, "pixels", frame->pixels);
    add_text(out, "pixelsExpected", frame->pixels_expected);
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
    fputs("{\"name\":", out);
    kiln_markup_write_json(out, result->name);
    add_text(out, "folder", results->folders[test]);
    add_facts(out, result);
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
