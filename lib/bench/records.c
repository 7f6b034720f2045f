/* Writes the records of a benchmark for other programs, as JSON and as CSV. */
#include <string.h>

#include "base/text.h"
#include "bench/result.h"

static void put_number(FILE *out, double value)
{
    char text[32];
    kiln_text_from_double(text, value);
    fputs(text, out);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void add_spread(struct kiln_json *json, const char *key, const struct kiln_spread *spread)
{
    kiln_json_begin_object(json, key);
    kiln_json_uint(json, "turns", spread->count);
    kiln_json_number(json, "median", spread->median);
    kiln_json_number(json, "first_quartile", spread->first_quartile);
    kiln_json_number(json, "third_quartile", spread->third_quartile);
    kiln_json_number(json, "least", spread->least);
    kiln_json_number(json, "most", spread->most);
    kiln_json_end(json);
}

static void add_row(struct kiln_json *json, const struct kiln_bench_row *row)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_number(json, "x", row->x);
    kiln_json_string(json, "measure", row->measure);
    kiln_json_string(json, "technique", row->technique);
    add_spread(json, "value", &row->spread);
    if (row->faster.count > 0)
        add_spread(json, "times_as_fast", &row->faster);
    else
        kiln_json_null(json, "times_as_fast");
    kiln_json_string(json, "published", row->source);
    kiln_json_end(json);
}

static void add_part(struct kiln_json *json, const struct kiln_bench_part *part)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_string(json, "name", part->name);
    kiln_json_string(json, "suite", part->suite);
    kiln_json_indent_next(json, 3);
    kiln_json_string(json, "title", part->title);
    kiln_json_indent_next(json, 3);
    kiln_json_string(json, "sweep", part->sweep);
    kiln_json_string(json, "unit", part->unit);
    kiln_json_string(json, "reference", part->reference);
    kiln_json_indent_items(json, 3);
    kiln_json_strings(json, "notes", part->notes, part->note_count);
    kiln_json_begin_array(json, "rows");
    kiln_json_indent_items(json, 4);
    for (size_t i = 0; i < part->row_count; i++)
        add_row(json, &part->rows[i]);
    kiln_json_end(json);
    kiln_json_end(json);
}

static void add_device(struct kiln_json *json, const struct kiln_device_info *device)
{
    kiln_json_begin_object(json, "device");
    kiln_json_string(json, "name", device->name);
    kiln_json_bool(json, "software", device->software);
    kiln_json_string(json, "gl_version", device->gl_version);
    kiln_json_end(json);
}

void kiln_bench_write_json(const struct kiln_bench *bench, FILE *out)
{
    struct kiln_json json = kiln_json_to_file(out);
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json, "version", KILN_VERSION);
    kiln_json_indent_next(&json, 1);
    add_device(&json, &bench->device);
    kiln_json_indent_next(&json, 1);
    kiln_json_string(&json, "processor", bench->processor);
    kiln_json_uint(&json, "cores", bench->cores);
    kiln_json_indent_next(&json, 1);
    kiln_json_uint(&json, "turns", bench->repetitions);
    kiln_json_bool(&json, "quick", bench->quick);
    kiln_json_number(&json, "total_s", bench->seconds);
    kiln_json_indent_next(&json, 1);
    kiln_json_begin_array(&json, "parts");
    kiln_json_indent_items(&json, 2);
    for (size_t i = 0; i < bench->part_count; i++)
        add_part(&json, &bench->parts[i]);
    kiln_json_end(&json);
    kiln_json_end(&json);
    kiln_json_finish(&json);
}

/* ---- CSV (RFC 4180, but for the ends of lines) ----------------------------------------------- */

static void put_cell(FILE *out, const char *text)
{
    if (!strpbrk(text, ",\"\n")) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"')
            fputc('"', out);
        fputc(*text, out);
    }
    fputc('"', out);
}

static void put_cells(FILE *out, const char *const *texts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        put_cell(out, texts[i] ? texts[i] : "");
        fputc(',', out);
    }
}

static void put_quartiles(FILE *out, const struct kiln_spread *spread, bool all)
{
    const double values[] = {spread->median, spread->first_quartile, spread->third_quartile,
                             spread->least, spread->most};
    for (size_t i = 0; i < (all ? 5 : 3); i++) {
        if (spread->count > 0)
            put_number(out, values[i]);
        fputc(',', out);
    }
}

static void put_record(FILE *out, const struct kiln_bench_part *part,
                       const struct kiln_bench_row *row)
{
    put_cells(out, (const char *const[]){part->suite, part->name, part->sweep}, 3);
    put_number(out, row->x);
    fputc(',', out);
    put_cells(out, (const char *const[]){row->measure, row->technique, part->unit}, 3);
    fprintf(out, "%u,", row->source ? 0 : row->spread.count);
    put_quartiles(out, &row->spread, true);
    put_cells(out, (const char *const[]){part->reference}, 1);
    put_quartiles(out, &row->faster, false);
    put_cell(out, row->source ? row->source : "");
    fputc('\n', out);
}

void kiln_bench_write_csv(const struct kiln_bench *bench, FILE *out)
{
    fputs("suite,part,sweep,x,measure,technique,unit,turns,median,first_quartile,third_quartile,"
          "least,most,reference,times_as_fast,times_as_fast_first_quartile,"
          "times_as_fast_third_quartile,published\n",
          out);
    for (size_t i = 0; i < bench->part_count; i++) {
        for (size_t k = 0; k < bench->parts[i].row_count; k++)
            put_record(out, &bench->parts[i], &bench->parts[i].rows[k]);
    }
}
