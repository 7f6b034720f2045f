/* Runs kiln test calibrate, which measures how much pictures of an unchanged scene differ between
 * threads, techniques and devices, and proposes limits for expect.yaml from that. It writes
 * expect.yaml only with --write.
 *
 * The main function finds test_calibrate_command in the table of commands and calls its `run`; the
 * parser, the help, the man page and the completion read its options. The measuring itself is
 * kiln_test_calibrate; this file reads options and prints. */
#include <stdlib.h>

#include "command.h"
#include "event.h"
#include "report.h"
#include "signals.h"
#include "test_select.h"

static const struct option options[] = {
    FILTER_OPTION,
    SUITE_ROOT_OPTION,
    GOLDEN_OPTION,
    RESULTS_OPTION,
    {.name = "device",
     .repeats = true,
     .kind = OPTION_TEXT,
     .placeholder = "DEVICE",
     .help = "Render on this device: a number from 'kiln devices', a part of its name, 'cpu' or "
             "'software'.",
     .fallback = "'cpu', and the first GPU or the software device for techniques that need it"},
    {.name = "repeat",
     .older_name = "renders",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Render each test N times, with different threads and techniques.",
     .fallback = "8",
     .min = 2,
     .max = 1000},
    {.name = "margin",
     .kind = OPTION_NUMBER,
     .placeholder = "FACTOR",
     .help = "A proposed limit is the worst value times this.",
     .fallback = "3",
     .min = 1,
     .max = 1000},
    {.name = "write",
     .letter = 'w',
     .kind = OPTION_FLAG,
     .help = "Write what was measured and the limits into expect.yaml."},
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    EVENTS_OPTION,
    HELP_OPTION,
};

/* Prints a line about one render. kiln_test_calibrate calls it while it works. */
static void print_render(void *user, const char *line)
{
    const bool *quiet = user;
    if (*quiet)
        return;
    printf("  ");
    print_name(line);
    printf("\n");
    fflush(stdout);
}

static void print_calibration(const struct kiln_calibration *calibration, bool written)
{
    printf("  %u renders, %s%s\n", calibration->renders,
           calibration->equal ? "equal to the bit" : "not all equal",
           written ? "; written into expect.yaml" : "");
    if (calibration->count > 0)
        printf("  %-16s %12s %12s %12s\n", "metric", "limit", "measured", "proposed");
    for (size_t i = 0; i < calibration->count; i++)
        printf("  %-16s %12.5g %12.5g %12.5g\n", calibration->metrics[i].metric,
               calibration->metrics[i].now, calibration->metrics[i].worst,
               calibration->metrics[i].proposed);
    fflush(stdout);
}

/* Calibrates one test and returns its exit code. */
static enum kiln_code calibrate(const struct kiln_suite *suite, size_t index,
                                const struct kiln_calibrate_params *params, bool quiet)
{
    struct kiln_calibration calibration;
    struct kiln_error error = {0};
    if (!quiet)
        printf("%s\n", kiln_suite_test(suite, index).name);
    if (!kiln_test_calibrate(suite, index, params, &calibration, &error)) {
        report_error(&error);
        return error.code;
    }
    if (!quiet)
        print_calibration(&calibration, params->write);
    return KILN_OK;
}

static int run(const struct arguments *arguments)
{
    bool quiet = arguments_flag(arguments, "quiet");
    struct kiln_suite *suite = NULL;
    struct value_list devices;
    bool ok = value_list_create(&devices, arguments, "device");
    int code = ok ? select_tests(&suite, arguments, "test calibrate") : report_no_memory();
    struct kiln_calibrate_params params = kiln_calibrate_defaults();
    params.devices = devices.items;
    params.device_count = devices.count;
    params.renders = arguments_integer(arguments, "repeat", params.renders);
    params.margin = arguments_number(arguments, "margin", params.margin);
    params.write = arguments_flag(arguments, "write");
    const char *scratch = kiln_environment("TMPDIR");
    params.scratch = scratch ? scratch : params.scratch;
    params.render = print_render;
    params.stop = signals_wants_stop;
    params.user = &quiet;
    params.log = report_log();
    if (code == 0) {
        signals_install();
        enum kiln_code worst = KILN_OK;
        for (size_t i = 0; i < kiln_suite_count(suite) && !signals_received(); i++)
            worst = kiln_code_worse(worst, calibrate(suite, i, &params, quiet));
        code = signals_received() ? 128 + signals_received() : (int)worst;
    }
    value_list_free(&devices);
    kiln_suite_destroy(&suite);
    return code;
}

const struct command test_calibrate_command = {
    .name = "test calibrate",
    .summary = "measure how much tests vary, and propose limits",
    .operands = "[PATH | NAME]...",
    .description = "Renders each test several times, with different numbers of threads, techniques "
                   "and devices. It compares all pictures with the goldens, and proposes limits: "
                   "the worst value with a margin. " SELECT_DESCRIPTION,
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
