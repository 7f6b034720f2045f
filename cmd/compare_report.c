/* Tables for people, lines of JSON for programs; both have the columns of the library's metrics. */
#include "compare_report.h"

#include <math.h>

/* ---- Text --------------------------------------------------------------------------------- */

/* Five digits, right of a column's start; counts in full. */
static const char *value_text(char out[32], double value)
{
    snprintf(out, 32, fabs(value) < 1e5 ? "%.5g" : "%.0f", value);
    return out;
}

static size_t find_column(const struct kiln_compare_result *result)
{
    size_t first = 0; /* the first that has a limit: what a line of a frame shows */
    while (first + 1 < result->column_count && !result->columns[first].limited)
        first++;
    return first;
}

static void print_frame_line(const struct kiln_compare_result *result,
                             const struct kiln_compare_frame *frame)
{
    char text[32];
    size_t column = find_column(result);
    if (result->frames == 1)
        printf("  %-24s %-11s %16s %9s\n", "frame", "verdict", result->columns[column].name,
               "of limit");
    printf("  %-24s %-11s", frame->name, kiln_compare_verdict_name(frame->verdict));
    if (frame->measured)
        printf(" %16s %7.0f %%\n", value_text(text, frame->values[column]), 100 * frame->score);
    else
        printf(" %s\n", frame->message);
}

/* Its limit, and whether the value is beyond it. */
static void print_limit(const struct kiln_compare_column *column, double value)
{
    bool within = column->higher_is_better ? value >= column->limit : value <= column->limit;
    if (column->limited)
        printf(" %10g  %s", column->limit, within ? "within" : "beyond");
    else
        printf(" %10s", "-");
}

static void print_metrics(const struct kiln_compare_result *result)
{
    char text[32];
    if (result->sequence)
        printf("  %-16s %12s %12s  %-20s %10s\n", "metric", "worst", "mean", "at", "limit");
    else
        printf("  %-16s %12s %10s\n", "metric", "value", "limit");
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        printf("  %-16s %12s", column->name, value_text(text, result->worst[i]));
        if (result->sequence)
            printf(" %12s", value_text(text, result->mean[i]));
        if (result->sequence)
            printf("  %-20s", result->worst_names[i]);
        print_limit(column, result->worst[i]);
        printf("\n");
    }
}

static void print_places(const struct kiln_compare_frame *frame)
{
    if (frame->equal)
        printf("  not one value differs\n");
    else
        printf("  largest difference at %u,%u; densest window of %ux%u at %u,%u: %u pixels\n",
               frame->worst_x, frame->worst_y, frame->window_width, frame->window_height,
               frame->window_x, frame->window_y, frame->window_differing);
}

static void print_counts(const struct kiln_compare_result *result)
{
    printf("%u frame%s:", result->frames, result->frames == 1 ? "" : "s");
    const char *comma = "";
    for (int i = 0; i < KILN_COMPARE_VERDICT_COUNT; i++) {
        if (result->counts[i] == 0)
            continue;
        printf("%s %u %s", comma, result->counts[i],
               kiln_compare_verdict_name((enum kiln_compare_verdict)i));
        comma = ",";
    }
    if (!result->same)
        printf("; the worst is %s", result->worst_frame);
    printf("\n");
}

static void print_result_text(const struct compare_report *report,
                              const struct kiln_compare_result *result)
{
    printf("%s against %s: %s\n", report->test, report->reference,
           result->same                              ? "same"
           : result->counts[KILN_COMPARE_UNREADABLE] ? "unreadable"
                                                     : "different");
    if (result->sequence) {
        printf("  ");
        print_counts(result);
    }
    if (result->measured)
        print_metrics(result);
    if (!result->sequence && report->only.measured)
        print_places(&report->only);
    if (report->stats)
        printf("  FLIP in %.3f s\n  all in %.3f s\n", result->flip_s, result->total_s);
}

/* ---- JSON --------------------------------------------------------------------------------- */

/* JSON knows no infinity; null stands for it. */
static void print_number(double value)
{
    if (isfinite(value))
        printf("%.9g", value);
    else
        printf("null");
}

static void print_frame_json(const struct kiln_compare_result *result,
                             const struct kiln_compare_frame *frame)
{
    printf("{\"event\": \"frame\", \"name\": ");
    kiln_write_json_string(stdout, frame->name);
    printf(", \"verdict\": \"%s\"", kiln_compare_verdict_name(frame->verdict));
    if (!frame->measured) {
        printf(", \"message\": ");
        kiln_write_json_string(stdout, frame->message);
        printf("}\n");
        return;
    }
    printf(", \"width\": %u, \"height\": %u, \"equal\": %s, \"score\": ", frame->width,
           frame->height, frame->equal ? "true" : "false");
    print_number(frame->score);
    printf(", \"metrics\": {");
    for (size_t i = 0; i < result->column_count; i++) {
        printf("%s\"%s\": ", i ? ", " : "", result->columns[i].name);
        print_number(frame->values[i]);
    }
    printf("}, \"beyond\": [");
    const char *comma = "";
    for (size_t i = 0; i < result->column_count; i++) {
        if (!frame->beyond[i])
            continue;
        printf("%s\"%s\"", comma, result->columns[i].name);
        comma = ", ";
    }
    printf("], \"worst_pixel\": [%u, %u], \"window\": {\"x\": %u, \"y\": %u, \"width\": %u, "
           "\"height\": %u, \"differing\": %u}}\n",
           frame->worst_x, frame->worst_y, frame->window_x, frame->window_y, frame->window_width,
           frame->window_height, frame->window_differing);
}

static void print_metrics_json(const struct kiln_compare_result *result)
{
    printf(", \"metrics\": {");
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        printf("%s\"%s\": {\"worst\": ", i ? ", " : "", column->name);
        print_number(result->measured ? result->worst[i] : NAN);
        printf(", \"mean\": ");
        print_number(result->measured ? result->mean[i] : NAN);
        printf(", \"at\": ");
        kiln_write_json_string(stdout, result->worst_names[i]);
        printf(", \"unit\": \"%s\", \"better\": \"%s\", \"limit\": ", column->unit,
               column->higher_is_better ? "higher" : "lower");
        print_number(column->limited ? column->limit : NAN);
        printf("}");
    }
    printf("}");
}

static void print_result_json(const struct compare_report *report,
                              const struct kiln_compare_result *result)
{
    printf("{\"event\": \"result\", \"reference\": ");
    kiln_write_json_string(stdout, report->reference);
    printf(", \"test\": ");
    kiln_write_json_string(stdout, report->test);
    printf(", \"same\": %s, \"range\": \"%s\", \"frames\": %u, \"counts\": {",
           result->same ? "true" : "false", result->hdr ? "hdr" : "ldr", result->frames);
    for (int i = 0; i < KILN_COMPARE_VERDICT_COUNT; i++)
        printf("%s\"%s\": %u", i ? ", " : "",
               kiln_compare_verdict_name((enum kiln_compare_verdict)i), result->counts[i]);
    printf("}, \"worst_frame\": ");
    kiln_write_json_string(stdout, result->worst_frame);
    print_metrics_json(result);
    if (report->stats)
        printf(", \"flip_s\": %.3f, \"total_s\": %.3f", result->flip_s, result->total_s);
    printf("}\n");
}

/* ---- Both --------------------------------------------------------------------------------- */

void compare_report_frame(struct compare_report *report, const struct kiln_compare_result *result,
                          const struct kiln_compare_frame *frame)
{
    report->only = *frame;
    report->only.name = report->only.message = ""; /* which the frame only lends */
    if (report->quiet)
        return;
    if (report->json)
        print_frame_json(result, frame);
    else if (result->sequence)
        print_frame_line(result, frame);
    else if (!frame->measured && frame->verdict != KILN_COMPARE_UNREADABLE) /* that is an error */
        printf("%s\n", frame->message);
    fflush(stdout);
}

void compare_report_result(const struct compare_report *report,
                           const struct kiln_compare_result *result)
{
    if (report->quiet || result->frames == 0)
        return;
    if (report->json)
        print_result_json(report, result);
    else
        print_result_text(report, result);
}
