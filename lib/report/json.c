/* Writes a report as one JSON document: the head of the run and, for each test, its folder, its
 * score and all members of its result.json. */
#include "report/text.h"

enum { VERSION = 1 };

void kiln_results_add_head(struct kiln_json *json, const struct kiln_results *results)
{
    struct kiln_results_summary summary = kiln_results_summary(results);
    kiln_json_uint(json, "kiln_report", VERSION);
    kiln_json_string(json, "version", KILN_VERSION);
    kiln_json_string(json, "started", results->started);
    kiln_json_number(json, "total_s", summary.total_s);
    kiln_json_int(json, "code", (int)summary.code);
    kiln_json_begin_object(json, "counts");
    kiln_json_uint(json, "tests", summary.tests);
    for (int i = 0; i < KILN_TEST_STATUS_COUNT; i++)
        kiln_json_uint(json, kiln_test_status_name((enum kiln_test_status)i), summary.counts[i]);
    kiln_json_end(json);
}

void kiln_results_add_test(struct kiln_json *json, const struct kiln_results *results, size_t index)
{
    kiln_json_string(json, "folder", results->folders[index]);
    kiln_json_number(json, "score", kiln_result_score(results->tests[index]));
    kiln_result_add_json(json, results->tests[index]);
}

static bool write_json(const struct kiln_results *results, const struct kiln_results_output *output,
                       FILE *out, struct kiln_error *error)
{
    (void)output;
    (void)error;
    struct kiln_json json = kiln_json_to_file(out);
    kiln_json_begin_object(&json, NULL);
    kiln_json_indent_items(&json, 0);
    kiln_results_add_head(&json, results);
    kiln_json_begin_array(&json, "tests");
    for (size_t i = 0; i < results->count; i++) {
        kiln_json_begin_object(&json, NULL);
        kiln_json_indent_items(&json, 2);
        kiln_results_add_test(&json, results, i);
        kiln_json_end_indented(&json, 0);
    }
    kiln_json_end(&json);
    kiln_json_end_indented(&json, 0);
    kiln_json_finish(&json); /* the caller checks the stream for failures */
    return true;
}

const struct kiln_report_format kiln_report_json = {
    .name = "json",
    .help = "one document with all results, for programs",
    .option = "--json",
    .start = "{\n\"kiln_report\": ",
    .write = write_json,
};
