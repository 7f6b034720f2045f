/* Handles the reports that `kiln test` (test.c) and `kiln test report` (test_report.c) write: it
 * reads their options (--report, --json, --junit, --tap, --github), checks that no report replaces
 * a file that the command reads, and writes the reports.
 *
 * Both commands call test_outputs_read first and test_outputs_write last, when the results are
 * loaded. `kiln test` also calls test_outputs_claim before the run, so that a wrong path is
 * reported before any time is spent. test_outputs_write checks again, because only then the files
 * of the results are known; the check must stay before the first report is written.
 *
 * A new format needs an option in test_outputs.h, a row in `outputs_by_option` below, one more in
 * MAX_OUTPUTS, and a row in lib/report/report.c under the same name. */
#include "test_outputs.h"

#include <string.h>

#include "event.h"
#include "report.h"

int test_outputs_read(struct test_outputs *outputs, const struct arguments *arguments,
                      const char *command, const char *page)
{
    *outputs = (struct test_outputs){0};
    if (arguments_flag(arguments, "no-report") && arguments_flag(arguments, "report"))
        return report(KILN_USAGE, "%s: --report and --no-report exclude each other", command);
    if (!arguments_flag(arguments, "no-report"))
        outputs->page = arguments_text(arguments, "report", page);
    const bool force = arguments_flag(arguments, "force");
    const struct option_use *json = arguments_last(arguments, "json");
    const struct kiln_results_output outputs_by_option[MAX_OUTPUTS] = {
        {"json", json && !json->text ? "-" : arguments_text(arguments, "json", NULL), false, force},
        {"junit", arguments_text(arguments, "junit", NULL), false, force},
        {"tap", arguments_text(arguments, "tap", NULL), false, force},
        {"html", outputs->page, arguments_flag(arguments, "link"), force},
        {"github", arguments_flag(arguments, "github") ? "-" : NULL, false, force},
    };
    size_t on_standard_output = events_use_stdout();
    for (size_t i = 0; i < MAX_OUTPUTS; i++) {
        if (!outputs_by_option[i].path)
            continue;
        outputs->files[outputs->count++] = outputs_by_option[i];
        bool to_standard_output = strcmp(outputs_by_option[i].path, "-") == 0;
        on_standard_output += to_standard_output;
        /* GitHub finds its annotations among other lines, so they leave standard output free. */
        outputs->standard_output |=
            to_standard_output && strcmp(outputs_by_option[i].format, "github") != 0;
    }
    if (on_standard_output > 1)
        return report(KILN_USAGE,
                      "%s: only one of --json, --junit, --tap, --report, --github and --events "
                      "can go to standard output",
                      command);
    return 0;
}

int test_outputs_claim(const struct test_outputs *outputs, struct kiln_claims *claims)
{
    for (size_t i = 0; i < outputs->count; i++) {
        struct kiln_error error = {0};
        if (!kiln_results_claim(&outputs->files[i], claims, &error))
            return report_error(&error);
    }
    return 0;
}

/* Checks that no report replaces a file of the results. Returns 0, or the exit code after
 * reporting. */
static int claim_results(const struct test_outputs *outputs, const struct kiln_results *results,
                         const char *const *folders, size_t folder_count)
{
    struct kiln_error error = {0};
    struct kiln_claims *claims = kiln_claims_create();
    int code = claims ? 0 : report_no_memory();
    if (code == 0 && !kiln_results_claim_inputs(results, folders, folder_count, claims, &error))
        code = report_error(&error);
    if (code == 0)
        code = test_outputs_claim(outputs, claims);
    kiln_claims_destroy(&claims);
    return code;
}

/* Writes the events of --events: one event for each test and one for the result. They hold what
 * the document of --json holds. */
static void write_result_events(const struct kiln_results *results)
{
    if (!events_are_wanted())
        return;
    const size_t count = kiln_results_summary(results).tests;
    for (size_t i = 0; i < count; i++) {
        struct kiln_json json = event_begin("test");
        kiln_json_string(&json, "name", kiln_results_name(results, i));
        kiln_json_begin_object(&json, "report");
        kiln_results_add_test(&json, results, i);
        kiln_json_end(&json);
        event_end(&json);
    }
    struct kiln_json json = event_begin("result");
    kiln_results_add_head(&json, results);
    event_end(&json);
}

enum kiln_code test_outputs_write(struct test_outputs *outputs, const struct kiln_results *results,
                                  const char *const *folders, size_t folder_count,
                                  enum kiln_code code)
{
    write_result_events(results);
    int refused = claim_results(outputs, results, folders, folder_count);
    if (refused) {
        outputs->page = NULL;
        return kiln_code_worse(code, (enum kiln_code)refused);
    }
    for (size_t i = 0; i < outputs->count; i++) {
        struct kiln_error error = {0};
        if (kiln_results_write(results, &outputs->files[i], &error))
            continue;
        report_error(&error);
        if (outputs->page == outputs->files[i].path)
            outputs->page = NULL;
        code = kiln_code_worse(code, error.code);
    }
    return code;
}
