/* Records for programs: JSON and CSV. */
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

static void put_text(FILE *out, const char *before, const char *key, const char *value)
{
    fprintf(out, "%s\"%s\": ", before, key);
    if (value)
        kiln_write_json_string(out, value);
    else
        fputs("null", out);
}

static void put_spread(FILE *out, const char *key, const struct kiln_spread *spread)
{
    const struct {
        const char *name;
        double value;
    } members[] = {{"median", spread->median},
                   {"first_quartile", spread->first_quartile},
                   {"third_quartile", spread->third_quartile},
                   {"least", spread->least},
                   {"most", spread->most}};
    fprintf(out, ", \"%s\": {\"turns\": %u", key, spread->count);
    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        fprintf(out, ", \"%s\": ", members[i].name);
        put_number(out, members[i].value);
    }
    fputs("}", out);
}

static void put_row(FILE *out, const struct kiln_bench_row *row)
{
    fputs("{\"x\": ", out);
    put_number(out, row->x);
    put_text(out, ", ", "measure", row->measure);
    put_text(out, ", ", "technique", row->technique);
    put_spread(out, "value", &row->spread);
    if (row->faster.count > 0)
        put_spread(out, "times_as_fast", &row->faster);
    else
        fputs(", \"times_as_fast\": null", out);
    put_text(out, ", ", "published", row->source);
    fputs("}", out);
}

static void put_part(FILE *out, const struct kiln_bench_part *part)
{
    put_text(out, "{", "name", part->name);
    put_text(out, ", ", "suite", part->suite);
    put_text(out, ",\n   ", "title", part->title);
    put_text(out, ",\n   ", "sweep", part->sweep);
    put_text(out, ", ", "unit", part->unit);
    put_text(out, ", ", "reference", part->reference);
    fputs(",\n   \"notes\": [", out);
    for (size_t i = 0; i < part->note_count; i++) {
        fputs(i ? ", " : "", out);
        kiln_write_json_string(out, part->notes[i]);
    }
    fputs("],\n   \"rows\": [", out);
    for (size_t i = 0; i < part->row_count; i++) {
        fputs(i ? ",\n    " : "\n    ", out);
        put_row(out, &part->rows[i]);
    }
    fputs("]}", out);
}

void kiln_bench_write_json(const struct kiln_bench *bench, FILE *out)
{
    put_text(out, "{", "version", KILN_VERSION);
    put_text(out, ",\n \"device\": {", "name", bench->device.name);
    fprintf(out, ", \"software\": %s", bench->device.software ? "true" : "false");
    put_text(out, ", ", "gl_version", bench->device.gl_version);
    put_text(out, "},\n ", "processor", bench->processor);
    fprintf(out, ", \"cores\": %u,\n \"turns\": %u, \"quick\": %s, \"total_s\": ", bench->cores,
            bench->repetitions, bench->quick ? "true" : "false");
    put_number(out, bench->seconds);
    fputs(",\n \"parts\": [", out);
    for (size_t i = 0; i < bench->part_count; i++) {
        fputs(i ? ",\n  " : "\n  ", out);
        put_part(out, &bench->parts[i]);
    }
    fputs("]}\n", out);
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
