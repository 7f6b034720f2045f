/* Runs kiln test report, which writes reports of runs that have ended, such as the shards of one
 * run. */
#include <stdlib.h>

#include "command.h"
#include "event.h"
#include "report.h"
#include "signals.h"
#include "test_files.h"
#include "test_lines.h"
#include "test_outputs.h"

static const struct option options[] = {
    OUTPUT_OPTIONS("report.html in the first folder"),
    EVENTS_OPTION,
    HELP_OPTION,
};

static int write_reports(const struct arguments *arguments, struct test_outputs *outputs)
{
    struct kiln_error error = {0};
    struct kiln_results *results =
        kiln_results_load_whole(arguments->operands, arguments->operand_count, &error);
    if (!results)
        return report_error(&error);
    struct kiln_results_summary summary = kiln_results_summary(results);
    if (summary.missing_shard > 0)
        report(KILN_INVALID_INPUT,
               "test report: shard %u of %u is missing: its tests were judged nowhere",
               summary.missing_shard, summary.shards);
    enum kiln_code code = test_outputs_write(outputs, results, arguments->operands,
                                             arguments->operand_count, summary.code);
    kiln_results_destroy(&results);
    if (code || !arguments_flag(arguments, "quiet")) {
        FILE *out = outputs->standard_output ? stderr : stdout;
        test_lines_counts(out, &summary);
        kiln_write_frames(out, &summary);
        fputc('\n', out);
        if (outputs->page) {
            char page[KILN_PATH_SIZE];
            kiln_shown(page, sizeof page, outputs->page);
            fprintf(out, "report: %s\n", page);
        }
    }
    return (int)code;
}

static int run(const struct arguments *arguments)
{
    char *page = join_path(arguments->operands[0], "report.html");
    if (!page)
        return report_no_memory();
    struct test_outputs outputs;
    int code = test_outputs_read(&outputs, arguments, "test report", page);
    signals_install_immediate();
    if (code == 0)
        code = write_reports(arguments, &outputs);
    free(page);
    return code;
}

const struct command test_report_command = {
    .name = "test report",
    .summary = "write reports of runs, such as the shards of one",
    .operands = "FOLDER...",
    .description =
        "Reads the results of one or several runs and writes reports of all of them together. The "
        "exit code is that of the worst test, as 'kiln test' would have given it. The reports show "
        "a missing shard as a test that ended with an error, of exit code 3.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = SIZE_MAX,
    .run = run,
};
