/* Writes a report in the Test Anything Protocol, with a block of YAML under each test. The report
 * uses features of version 13 alone, which mean the same in version 14. Its head says 13, because
 * `prove` of Debian 12 fails on any report that says 14. */
#include <math.h>

#include "base/marker.h"
#include "base/text.h"
#include "report/text.h"

/* Writes a description in one line. '#' is escaped, since it would end the description, and a blank
 * breaks other markers of CI servers. */
static void write_description(FILE *out, const char *text)
{
    for (size_t until_blank = 0; *text; text++) {
        unsigned char c = (unsigned char)*text;
        const size_t marker = kiln_marker_break(text, false);
        until_blank = marker > 0 && c != '#' ? marker : until_blank;
        if (c == '#' || c == '\\')
            fputc('\\', out);
        fputc(c < 0x20 || c == 0x7f ? ' ' : c, out);
        if (until_blank > 0 && --until_blank == 0)
            fputc(' ', out);
    }
}

/* Writes a JSON string, which is a YAML scalar, too. */
static void write_string(FILE *out, const char *text)
{
    struct kiln_json json = kiln_json_to_file(out);
    kiln_json_string(&json, NULL, text);
}

/* Writes a member of the YAML block. */
static void write_text(FILE *out, const char *key, const char *text)
{
    if (!*text)
        return;
    fprintf(out, "  %s: ", key);
    write_string(out, text);
    fputs("\n", out);
}

static void write_number(FILE *out, double value)
{
    char number[32] = ".inf";
    if (isfinite(value))
        kiln_report_text_number(number, value);
    fputs(number, out);
}

/* Writes the metrics that have limits, and whether they are beyond them. */
static void write_metrics(FILE *out, const struct kiln_result *result,
                          const struct kiln_result_frame *frame)
{
    const char *before = "      metrics: {";
    for (size_t i = 0; i < result->column_count; i++) {
        if (!result->columns[i].limited)
            continue;
        fputs(before, out);
        write_string(out, result->columns[i].name);
        fputs(": {value: ", out);
        write_number(out, frame->values[i]);
        fputs(", limit: ", out);
        write_number(out, result->columns[i].limit);
        fprintf(out, ", beyond: %s}", frame->beyond[i] ? "true" : "false");
        before = ", ";
    }
    if (*before == ',')
        fputs("}\n", out);
}

static void write_frames(FILE *out, const struct kiln_result *result)
{
    uint32_t written = 0, left_out = 0;
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        if (frame->status == KILN_TEST_PASS)
            continue;
        if (written == KILN_REPORT_MAX_FRAMES) {
            left_out++;
            continue;
        }
        if (written++ == 0)
            fputs("  frames:\n", out);
        fprintf(out, "    - frame: %u\n      status: %s\n      judged_by: %s\n      message: ",
                frame->number, kiln_test_status_name(frame->status),
                kiln_judged_by_name(frame->judged_by));
        write_string(out, frame->message);
        fputs("\n", out);
        if (frame->measured)
            write_metrics(out, result, frame);
    }
    if (left_out)
        fprintf(out, "  frames_left_out: %u\n", left_out);
}

static void write_block(FILE *out, const struct kiln_result *result)
{
    char seconds[32];
    kiln_report_text_seconds(seconds, result->total_s);
    fprintf(out, "  ---\n  status: %s\n  seconds: %s\n", kiln_test_status_name(result->status),
            seconds);
    write_text(out, "message", result->message);
    write_text(out, "test", result->test);
    write_text(out, "device", result->device);
    write_text(out, "kiln", result->version);
    if (result->status >= KILN_TEST_WARN) {
        fprintf(out, "  code: %d\n  seed: %u\n", (int)result->code, result->seed);
        write_text(out, "techniques", result->techniques);
        write_text(out, "rerun", result->rerun);
        write_text(out, "approve", result->approve);
    }
    write_frames(out, result);
    for (size_t i = 0; i < result->note_count; i++) {
        fputs(i ? "    - " : "  notes:\n    - ", out);
        write_string(out, result->notes[i]);
        fputs("\n", out);
    }
    fputs("  ...\n", out);
}

static bool write_tap(const struct kiln_results *results, const struct kiln_results_output *output,
                      FILE *out, struct kiln_error *error)
{
    (void)output;
    (void)error;
    fprintf(out, "%s1..%zu%s\n", kiln_report_tap.start, results->count,
            results->count ? "" : " # SKIP there are no tests");
    for (size_t i = 0; i < results->count; i++) {
        const struct kiln_result *result = results->tests[i];
        fprintf(out, "%s %zu - ", result->code == KILN_OK ? "ok" : "not ok", i + 1);
        write_description(out, result->name);
        if (result->status == KILN_TEST_SKIP) {
            fputs(" # SKIP ", out);
            write_description(out, result->message);
        }
        fputs("\n", out);
        write_block(out, result);
    }
    return true;
}

const struct kiln_report_format kiln_report_tap = {
    .name = "tap",
    .help = "the Test Anything Protocol, version 13, for prove and the like",
    .option = "--tap",
    .start = "TAP version 13\n# kiln\n",
    .write = write_tap,
};
