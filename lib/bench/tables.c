/* Writes a benchmark as tables: as text, with a row for each measurement, and as Markdown, with
 * medians side by side. */
#include <string.h>

#include "bench/result.h"

size_t kiln_bench_curve_of(const struct kiln_bench_part *part, size_t row)
{
    for (size_t i = 0; i < row; i++) {
        if (strcmp(part->rows[i].measure, part->rows[row].measure) == 0 &&
            strcmp(part->rows[i].technique, part->rows[row].technique) == 0)
            return i;
    }
    return row;
}

void kiln_bench_curve_name(const struct kiln_bench_part *part, size_t row, char name[160])
{
    const struct kiln_bench_row *r = &part->rows[row];
    bool one_measure = true, one_technique = true;
    for (size_t i = 0; i < part->row_count; i++) {
        one_measure = one_measure && strcmp(part->rows[i].measure, r->measure) == 0;
        one_technique = one_technique && strcmp(part->rows[i].technique, r->technique) == 0;
    }
    if (one_measure)
        snprintf(name, 160, "%s", r->technique);
    else if (one_technique)
        snprintf(name, 160, "%s", r->measure);
    else
        snprintf(name, 160, "%s, %s", r->measure, r->technique);
}

static void put_head(const struct kiln_bench *bench, FILE *out)
{
    fprintf(out, "kiln %s on %s%s, %s, %u core%s; at most %u turns%s; %.0f s\n", KILN_VERSION,
            bench->device.name, bench->device.software ? " (software)" : "", bench->processor,
            bench->cores, bench->cores == 1 ? "" : "s", bench->repetitions,
            bench->quick ? ", a quick run: its numbers say nothing" : "", bench->seconds);
}

/* Writes a ratio and its quartiles with two digits after the decimal point, or with four if the
 * ratio is less than 0.1. */
static void put_ratios_of(const struct kiln_spread *faster, const char *before, const char *between,
                          const char *after, FILE *out)
{
    int digits = faster->median < 0.1 ? 4 : 2;
    fprintf(out, "%.*f%s%.*f%s%.*f%s", digits, faster->median, before, digits,
            faster->first_quartile, between, digits, faster->third_quartile, after);
}

/* ---- Text ------------------------------------------------------------------------------------ */

static size_t width_of(const struct kiln_bench_part *part, bool technique)
{
    size_t width = technique ? strlen("technique") : strlen("measure");
    for (size_t i = 0; i < part->row_count; i++) {
        size_t length = strlen(technique ? part->rows[i].technique : part->rows[i].measure);
        width = length > width ? length : width;
    }
    return width;
}

static void put_row(const struct kiln_bench_row *row, int measure_width, int technique_width,
                    FILE *out)
{
    char median[32], first[32], third[32];
    kiln_bench_number(median, row->spread.median);
    fprintf(out, "  %13.0f  %-*s  %-*s  %10s", row->x, measure_width, row->measure, technique_width,
            row->technique, median);
    if (row->source) {
        fprintf(out, "  published: %s\n", row->source);
        return;
    }
    if (row->spread.count < 2) {
        fputc('\n', out);
        return;
    }
    kiln_bench_number(first, row->spread.first_quartile);
    kiln_bench_number(third, row->spread.third_quartile);
    fprintf(out, "  %9s - %-9s  %5u", first, third, row->spread.count);
    if (row->faster.count > 0) {
        fputs("  ", out);
        put_ratios_of(&row->faster, " (", " - ", ")", out);
    }
    fputc('\n', out);
}

static void put_part(const struct kiln_bench_part *part, FILE *out)
{
    int measure_width = (int)width_of(part, false), technique_width = (int)width_of(part, true);
    fprintf(out, "\n%s: %s\n", part->name, part->title);
    fprintf(out, "  %13s  %-*s  %-*s  %10s  %9s   %-9s  %5s", part->sweep, measure_width, "measure",
            technique_width, "technique", part->unit, "quartiles", "", "turns");
    if (part->reference)
        fprintf(out, "  times as fast as %s", part->reference);
    fputc('\n', out);
    for (size_t i = 0; i < part->row_count; i++)
        put_row(&part->rows[i], measure_width, technique_width, out);
    for (size_t i = 0; i < part->note_count; i++)
        fprintf(out, "  %s\n", part->notes[i]);
}

void kiln_bench_write_text(const struct kiln_bench *bench, FILE *out)
{
    put_head(bench, out);
    for (size_t i = 0; i < bench->part_count; i++)
        put_part(&bench->parts[i], out);
}

/* ---- Markdown -------------------------------------------------------------------------------- */

/* Returns the row of a curve at x, or NULL. */
static const struct kiln_bench_row *find_row(const struct kiln_bench_part *part, size_t curve,
                                             double x)
{
    for (size_t i = curve; i < part->row_count; i++) {
        const struct kiln_bench_row *row = &part->rows[i];
        if (!(row->x < x) && !(row->x > x) && kiln_bench_curve_of(part, i) == curve)
            return row;
    }
    return NULL;
}

static bool is_first_of_x(const struct kiln_bench_part *part, size_t index)
{
    bool first = true;
    for (size_t i = 0; i < index; i++)
        first = first &&
                (part->rows[i].x < part->rows[index].x || part->rows[i].x > part->rows[index].x);
    return first;
}

static void put_line(const struct kiln_bench_part *part, double x, FILE *out)
{
    fprintf(out, "| %.0f |", x);
    for (size_t curve = 0; curve < part->row_count; curve++) {
        if (kiln_bench_curve_of(part, curve) != curve)
            continue;
        const struct kiln_bench_row *row = find_row(part, curve, x);
        char number[32] = "";
        if (row)
            kiln_bench_number(number, row->spread.median);
        fprintf(out, " %s |", number);
    }
    fputc('\n', out);
}

static void put_side_by_side(const struct kiln_bench_part *part, FILE *out)
{
    size_t curves = 0;
    fprintf(out, "\n### %s\n\n%s (%s).\n\n| %s |", part->name, part->title, part->unit,
            part->sweep);
    for (size_t i = 0; i < part->row_count; i++) {
        if (kiln_bench_curve_of(part, i) != i)
            continue;
        char name[160];
        kiln_bench_curve_name(part, i, name);
        fprintf(out, " %s |", name);
        curves++;
    }
    fputs("\n|---|", out);
    for (size_t i = 0; i < curves; i++)
        fputs("---|", out);
    fputc('\n', out);
    for (size_t i = 0; i < part->row_count; i++) {
        if (is_first_of_x(part, i))
            put_line(part, part->rows[i].x, out);
    }
}

static void put_ratios(const struct kiln_bench_part *part, FILE *out)
{
    bool any = false;
    for (size_t i = 0; i < part->row_count; i++)
        any = any || part->rows[i].faster.count > 0;
    if (!any)
        return;
    fprintf(out, "\n| %s | measure | technique | times as fast as %s | quartiles |\n", part->sweep,
            part->reference);
    fputs("|---|---|---|---|---|\n", out);
    for (size_t i = 0; i < part->row_count; i++) {
        const struct kiln_bench_row *row = &part->rows[i];
        if (row->faster.count == 0)
            continue;
        fprintf(out, "| %.0f | %s | %s | ", row->x, row->measure, row->technique);
        put_ratios_of(&row->faster, " | ", " to ", " |\n", out);
    }
}

void kiln_bench_write_markdown(const struct kiln_bench *bench, FILE *out)
{
    put_head(bench, out);
    for (size_t i = 0; i < bench->part_count; i++) {
        const struct kiln_bench_part *part = &bench->parts[i];
        put_side_by_side(part, out);
        put_ratios(part, out);
        for (size_t k = 0; k < part->note_count; k++)
            fprintf(out, "\n%s\n", part->notes[k]);
    }
}
