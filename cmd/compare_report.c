/* Prints the results of kiln compare: tables for people, lines of JSON for programs. Both have the
 * columns of the library's metrics.
 *
 * compare.c calls compare_report_frame after each compared frame, and compare_report_result once at
 * the end, also after an error. The tables may change, with the expected outputs of
 * tests/cli/cases/compare.t. Programs read the JSON by its names: members may be added but not
 * renamed or removed, and each one is listed in event_table.c. */
#include "compare_report.h"

#include <math.h>

#include "event.h"

/* ---- Text --------------------------------------------------------------------------------- */

/* Formats a value with five digits; large counts are written in full. */
static const char *value_text(char out[32], double value)
{
    snprintf(out, 32, fabs(value) < 1e5 ? "%.5g" : "%.0f", value);
    return out;
}

/* Returns the column that the line of a frame shows: the first one with a limit, or the last one if
 * no column has a limit. */
static size_t find_column(const struct kiln_compare_result *result)
{
    size_t first = 0;
    while (first + 1 < result->column_count && !result->columns[first].limited)
        first++;
    return first;
}

static const struct kiln_compare_layer *layer_at(const struct kiln_compare_frame *frame, size_t i)
{
    return (const void *)((const char *)frame->layers + i * frame->layer_stride);
}

/* Returns whether a frame has more to tell than its values say. */
static bool has_layers(const struct kiln_compare_frame *frame)
{
    return frame->layer_count > 1 || (frame->layer_count == 1 && layer_at(frame, 0)->data);
}

/* Prints the values that are beyond their limits, or how near the worst one is to its limit:
 * "flip.p99 0.47 of 0.1". */
static void print_values(const struct kiln_compare_result *result,
                         const struct kiln_compare_layer *layer)
{
    char text[32];
    const char *comma = "";
    for (size_t i = 0; i < result->column_count; i++) {
        if (!layer->beyond[i])
            continue;
        printf("%s%s %s of %g", comma, result->columns[i].name, value_text(text, layer->values[i]),
               result->columns[i].limit);
        comma = ", ";
    }
    if (!*comma)
        printf("at %.0f %% of the limits", 100 * layer->score);
}

/* Prints what was found of a layer: "12 numbers differ, by up to 0.5 at 3,4". */
static void print_finding(const struct kiln_compare_result *result,
                          const struct kiln_compare_layer *layer)
{
    char text[32];
    if (layer->measured && layer->equal)
        printf("not one value differs");
    else if (layer->measured)
        print_values(result, layer);
    else if (*layer->message)
        printf("%s", layer->message);
    else if (layer->equal)
        printf("not one number differs");
    else
        printf("%llu number%s differ%s, by up to %s at %u,%u", (unsigned long long)layer->differing,
               layer->differing == 1 ? "" : "s", layer->differing == 1 ? "s" : "",
               value_text(text, layer->difference), layer->worst_x, layer->worst_y);
    printf("\n");
}

static void print_layers(const struct kiln_compare_result *result,
                         const struct kiln_compare_frame *frame)
{
    printf("  %-24s %s\n", "layer", "verdict");
    for (size_t i = 0; i < frame->layer_count; i++) {
        const struct kiln_compare_layer *layer = layer_at(frame, i);
        char name[256];
        kiln_shown(name, sizeof name, layer->name);
        printf("  %-24s %-11s ", name, kiln_compare_verdict_name(layer->verdict));
        print_finding(result, layer);
    }
}

/* Prints the layers of a frame of a sequence that differ. */
static void print_differing_layers(const struct kiln_compare_result *result,
                                   const struct kiln_compare_frame *frame)
{
    for (size_t i = 0; i < frame->layer_count; i++) {
        const struct kiln_compare_layer *layer = layer_at(frame, i);
        char name[256];
        kiln_shown(name, sizeof name, layer->name);
        if (layer->verdict == KILN_COMPARE_SAME)
            continue;
        printf("    layer %s: ", name);
        print_finding(result, layer);
    }
}

/* Prints the line of a frame of a sequence, and before the first frame the column headings. */
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
    if (has_layers(frame))
        print_differing_layers(result, frame);
}

/* Prints the limit of a value, and whether the value is beyond it. */
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

static void print_places(const struct compare_report *report)
{
    const struct kiln_compare_frame *frame = &report->only;
    if (frame->equal)
        printf("  not one value differs\n");
    else if (!report->colors_equal)
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
    char test[KILN_MESSAGE_SIZE], reference[KILN_MESSAGE_SIZE];
    kiln_shown(test, sizeof test, report->test);
    kiln_shown(reference, sizeof reference, report->reference);
    printf("%s against %s: %s\n", test, reference,
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
        print_places(report);
    if (!result->sequence && *report->note && !report->has_layers)
        printf("  %s\n", report->note);
    if (report->stats)
        printf("  FLIP in %.3f s\n  all in %.3f s\n", result->flip_s, result->total_s);
}

/* ---- JSON --------------------------------------------------------------------------------- */

/* Adds a number; it is null in JSON where the value was not measured (NaN) or is infinite. */
static void add_number(struct kiln_json *json, const char *key, double value)
{
    kiln_json_rounded(json, key, value, 9);
}

static void add_measured(struct kiln_json *json, const struct kiln_compare_result *result,
                         const struct kiln_compare_frame *frame)
{
    kiln_json_uint(json, "width", frame->width);
    kiln_json_uint(json, "height", frame->height);
    kiln_json_bool(json, "equal", frame->equal);
    add_number(json, "score", frame->score);
    kiln_json_begin_object(json, "metrics");
    for (size_t i = 0; i < result->column_count; i++)
        add_number(json, result->columns[i].name, frame->values[i]);
    kiln_json_end(json);
    kiln_json_begin_array(json, "beyond");
    for (size_t i = 0; i < result->column_count; i++)
        if (frame->beyond[i])
            kiln_json_string(json, NULL, result->columns[i].name);
    kiln_json_end(json);
    kiln_json_pair(json, "worst_pixel", frame->worst_x, frame->worst_y);
    kiln_json_begin_object(json, "window");
    kiln_json_uint(json, "x", frame->window_x);
    kiln_json_uint(json, "y", frame->window_y);
    kiln_json_uint(json, "width", frame->window_width);
    kiln_json_uint(json, "height", frame->window_height);
    kiln_json_uint(json, "differing", frame->window_differing);
    kiln_json_end(json);
}

static void add_layer(struct kiln_json *json, const struct kiln_compare_result *result,
                      const struct kiln_compare_layer *layer)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_string(json, "name", layer->name);
    kiln_json_string(json, "kind", layer->data ? "data" : "color");
    kiln_json_string(json, "verdict", kiln_compare_verdict_name(layer->verdict));
    if (*layer->message)
        kiln_json_string(json, "message", layer->message);
    kiln_json_bool(json, "equal", layer->equal);
    add_number(json, "score", layer->score);
    if (layer->data) {
        add_number(json, "difference", layer->difference);
        kiln_json_uint(json, "differing", layer->differing);
    }
    kiln_json_pair(json, "worst_pixel", layer->worst_x, layer->worst_y);
    if (layer->measured) {
        kiln_json_begin_object(json, "metrics");
        for (size_t i = 0; i < result->column_count; i++)
            add_number(json, result->columns[i].name, layer->values[i]);
        kiln_json_end(json);
    }
    kiln_json_end(json);
}

static void print_frame_json(const struct kiln_compare_result *result,
                             const struct kiln_compare_frame *frame)
{
    struct kiln_json json = event_begin("frame");
    kiln_json_string(&json, "name", frame->name);
    kiln_json_string(&json, "verdict", kiln_compare_verdict_name(frame->verdict));
    if (frame->measured)
        add_measured(&json, result, frame);
    else
        kiln_json_string(&json, "message", frame->message);
    if (has_layers(frame)) {
        kiln_json_begin_array(&json, "layers");
        for (size_t i = 0; i < frame->layer_count; i++)
            add_layer(&json, result, layer_at(frame, i));
        kiln_json_end(&json);
    }
    event_end(&json);
}

static void add_metrics(struct kiln_json *json, const struct kiln_compare_result *result)
{
    kiln_json_begin_object(json, "metrics");
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        kiln_json_begin_object(json, column->name);
        add_number(json, "worst", result->measured ? result->worst[i] : NAN);
        add_number(json, "mean", result->measured ? result->mean[i] : NAN);
        kiln_json_string(json, "at", result->worst_names[i]);
        kiln_json_string(json, "unit", column->unit);
        kiln_json_string(json, "better", column->higher_is_better ? "higher" : "lower");
        add_number(json, "limit", column->limited ? column->limit : NAN);
        kiln_json_end(json);
    }
    kiln_json_end(json);
}

static void print_result_json(const struct compare_report *report,
                              const struct kiln_compare_result *result)
{
    struct kiln_json json = event_begin("result");
    kiln_json_string(&json, "reference", report->reference);
    kiln_json_string(&json, "test", report->test);
    kiln_json_bool(&json, "same", result->same);
    kiln_json_string(&json, "range", result->hdr ? "hdr" : "ldr");
    kiln_json_uint(&json, "frames", result->frames);
    kiln_json_begin_object(&json, "counts");
    for (int i = 0; i < KILN_COMPARE_VERDICT_COUNT; i++)
        kiln_json_uint(&json, kiln_compare_verdict_name((enum kiln_compare_verdict)i),
                       result->counts[i]);
    kiln_json_end(&json);
    kiln_json_string(&json, "worst_frame", result->worst_frame);
    add_metrics(&json, result);
    if (report->stats) {
        kiln_json_time(&json, "flip_s", result->flip_s);
        kiln_json_time(&json, "total_s", result->total_s);
    }
    event_end(&json);
}

/* ---- Both --------------------------------------------------------------------------------- */

void compare_report_frame(struct compare_report *report, const struct kiln_compare_result *result,
                          const struct kiln_compare_frame *frame)
{
    report->only = *frame;
    report->only.name = report->only.message = ""; /* they may be freed after this call */
    report->only.layers = NULL;
    report->has_layers = has_layers(frame);
    report->colors_equal = true;
    for (size_t i = 0; i < frame->layer_count; i++) {
        const struct kiln_compare_layer *layer = layer_at(frame, i);
        report->colors_equal = report->colors_equal && (layer->equal || !layer->measured);
    }
    snprintf(report->note, sizeof report->note, "%s", frame->measured ? frame->message : "");
    if (report->json)
        print_frame_json(result, frame);
    if (report->quiet)
        return;
    if (result->sequence)
        print_frame_line(result, frame);
    else if (report->has_layers)
        print_layers(result, frame);
    else if (!frame->measured && frame->verdict != KILN_COMPARE_UNREADABLE)
        /* The error that compare.c reports says why a frame is unreadable. */
        printf("%s\n", frame->message);
    fflush(stdout);
}

void compare_report_result(const struct compare_report *report,
                           const struct kiln_compare_result *result)
{
    if (result->frames == 0)
        return;
    if (report->json)
        print_result_json(report, result);
    if (!report->quiet)
        print_result_text(report, result);
}
