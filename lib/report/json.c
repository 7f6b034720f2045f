/* One document with everything: the head of the run, and of each test its folder, its score and all
 * that its result.json says. */
#include <inttypes.h>
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "report/words.h"

enum { VERSION = 1 };

static void write_number(FILE *out, double value)
{
    char number[32] = "null";
    if (isfinite(value))
        kiln_text_from_double(number, value);
    fputs(number, out);
}

static void write_head(FILE *out, const struct kiln_results *results)
{
    struct kiln_results_summary summary = kiln_results_summary(results);
    fprintf(out, "{\n\"kiln_report\": %d,\n\"version\": \"%s\",\n\"started\": ", VERSION,
            KILN_VERSION);
    kiln_write_json_string(out, results->started);
    fputs(",\n\"total_s\": ", out);
    write_number(out, summary.total_s);
    fprintf(out, ",\n\"code\": %d,\n\"counts\": {\"tests\": %u", (int)summary.code, summary.tests);
    for (int i = 0; i < KILN_TEST_STATUS_COUNT; i++)
        fprintf(out, ", \"%s\": %u", kiln_test_status_name((enum kiln_test_status)i),
                summary.counts[i]);
    fputs("},\n\"tests\": [", out);
}

static bool write_json(const struct kiln_results *results, const struct kiln_results_output *output,
                       FILE *out, struct kiln_error *error)
{
    (void)output;
    write_head(out, results);
    for (size_t i = 0; i < results->count; i++) {
        fputs(i ? ", {\n  \"folder\": " : "{\n  \"folder\": ", out);
        kiln_write_json_string(out, results->folders[i]);
        fputs(",\n  \"score\": ", out);
        write_number(out, kiln_result_score(results->tests[i]));
        struct kiln_text text = {0};
        kiln_result_add_json(&text, results->tests[i]);
        bool whole = !text.failed;
        if (whole)
            fprintf(out, ",\n  %s\n}", text.data);
        kiln_text_free(&text);
        if (!whole)
            return kiln_error_set(error, KILN_DEVICE_FAILED, "no memory for the JSON report");
    }
    fputs("]\n}\n", out);
    return true;
}

const struct kiln_report_format kiln_report_json = {
    .name = "json",
    .help = "one document with all results, for programs",
    .write = write_json,
};
