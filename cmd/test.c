/* Runs kiln test, which tells whether scenes still give the accepted pictures. It finds the tests,
 * runs each in a process of its own, prints their results in the order of their names, and writes
 * reports.
 *
 * The main function finds test_command in the table of commands and calls its `run`; the parser,
 * the help, the man page and the completion read its options. A test's process is a fork of this
 * one that runs no other program (test_pool.c), so this process must start no thread and open no
 * device while tests run. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "build.h"
#include "command.h"
#include "event.h"
#include "report.h"
#include "signals.h"
#include "test_files.h"
#include "test_lines.h"
#include "test_outputs.h"
#include "test_pool.h"
#include "test_select.h"
#include "timer_thread.h"

static const struct option options[] = {
    FILTER_OPTION,
    SUITE_ROOT_OPTION,
    SHARD_OPTION,
    GOLDEN_OPTION,
    RESULTS_OPTION,
    {.name = "update",
     .letter = 'u',
     .kind = OPTION_CHOICE,
     .placeholder = "missing|failed|all",
     .help =
         "Write goldens: missing writes those of frames that have none, failed also those of "
         "frames that fail, all those of every frame. Goldens of other devices stay as they are."},
    {.name = "dry-run",
     .letter = 'n',
     .kind = OPTION_FLAG,
     .help = "With --update: print what would be written, and write nothing."},
    {.name = "device",
     .kind = OPTION_TEXT,
     .placeholder = "DEVICE",
     .help = "A number from 'kiln devices', a part of a device's name, 'cpu' to render without "
             "OpenGL, or 'software' for OpenGL on the CPU. It holds for tests that name no device.",
     .fallback = "'cpu', or else the first GPU or the software device if a technique needs it"},
    {.name = "technique",
     .repeats = true,
     .splits_at_commas = true,
     .kind = OPTION_PAIRS,
     .placeholder = "STAGE=NAME",
     .help = "How to run a stage, instead of the techniques that tests name; separate several by "
             "commas (see 'kiln help techniques')."},
    {.name = "jobs",
     .letter = 'j',
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of tests that run at a time.",
     .fallback = "one a core",
     .min = 1,
     .max = 256},
    {.name = "threads",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of threads of each test; 0 shares the cores between the jobs.",
     .fallback = "0",
     .max = 256},
    {.name = "repeat",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Render each test N times. Every render must give the same hashes.",
     .fallback = "1",
     .min = 1,
     .max = 1000},
    {.name = "test-timeout",
     .older_name = "time-limit",
     .kind = OPTION_TIME,
     .placeholder = "TIME",
     .help = "End a test that takes longer than this, as an error.",
     .fallback = "time_limit of the test file, or 120 s",
     .min = 0.001,
     .max = 86400},
    {.name = "ignore-hashes",
     .kind = OPTION_FLAG,
     .help = "Judge by the metrics alone, without the hashes of state and pixels."},
    {.name = "strict",
     .kind = OPTION_FLAG,
     .help = "On a device with accepted hashes of pixels, let only equal pixels pass. On 'cpu', "
             "accepted hashes must be there."},
    {.name = "against",
     .kind = OPTION_TEXT,
     .placeholder = "PROGRAM",
     .help = "For frames whose pixels have changed, draw the accepted side with another kiln, and "
             "say whether that kiln still draws the accepted pixels."},
    OUTPUT_OPTIONS("report.html in the results"),
    EVENTS_OPTION,
    HELP_OPTION,
};

struct test_run {
    const struct kiln_suite *suite;
    size_t count;
    struct kiln_test_params params;
    double time_limit_s; /* limit of every test; 0: each test's own limit holds */
    uint32_t jobs;
    char log[KILN_PATH_SIZE]; /* the log's name, as task_of wrote it last */
    struct kiln_test_summary *summaries;
    bool *ended;
    size_t ended_count, printed; /* the lines of tests 0 to printed-1 are printed */
    enum kiln_code code;         /* the worst code of a test so far */
    struct test_lines lines;
};

/* ---- One test ------------------------------------------------------------------------------- */

struct test_task {
    const char *log;     /* the file that gets what its process prints */
    double time_limit_s; /* real time after which the process is ended */
};

/* Describes a task; the log's name is valid until the next call. */
static struct test_task task_of(struct test_run *run, size_t index)
{
    struct kiln_test_info test = kiln_suite_test(run->suite, index);
    snprintf(run->log, sizeof run->log, "%s/log.txt", test.results);
    return (struct test_task){.log = run->log,
                              .time_limit_s =
                                  run->time_limit_s > 0 ? run->time_limit_s : test.time_limit_s};
}

/* Runs a test. It is called in the test's own process, whose exit code it returns. */
static int run_test(void *user, size_t index)
{
    const struct test_run *run = user;
    char threads[16];
    snprintf(threads, sizeof threads, "%u", run->params.threads);
    setenv("LP_NUM_THREADS", threads, 0); /* threads of Mesa's OpenGL on the CPU */
    struct kiln_test_summary summary;
    struct kiln_error error = {0};
    if (kiln_test_run(run->suite, index, &run->params, &summary, &error))
        return 0;
    report_error(&error);
    return (int)error.code;
}

static pid_t start_test(void *user, size_t index, struct pool_start *start)
{
    struct test_run *run = user;
    const struct test_task task = task_of(run, index);
    start->time_limit_s = task.time_limit_s;
    return test_pool_start(start, task.log, run_test, run, index);
}

/* Describes how the process of a test failed. Returns false if it ended well, so that it should
 * have left a result. */
static bool describe_failure(const struct pool_end *end, double time_limit_s,
                             char text[KILN_MESSAGE_SIZE])
{
    if (end->problem[0])
        snprintf(text, KILN_MESSAGE_SIZE, "%s", end->problem);
    else if (end->timed_out)
        snprintf(text, KILN_MESSAGE_SIZE, "took longer than %g s", time_limit_s);
    else if (end->signal == SIGKILL)
        snprintf(text, KILN_MESSAGE_SIZE,
                 "crashed: signal %d (%s), as when the system is out of memory", end->signal,
                 strsignal(end->signal));
    else if (end->signal)
        snprintf(text, KILN_MESSAGE_SIZE, "crashed: signal %d (%s)", end->signal,
                 strsignal(end->signal));
    else if (end->exit_code)
        snprintf(text, KILN_MESSAGE_SIZE, "ended without a result, with exit code %d",
                 end->exit_code);
    else
        return false;
    return true;
}

/* Records an error as the result of a test whose process left no result that can be read. */
static void record_failure(struct test_run *run, size_t index, const struct pool_end *end,
                           const char *cause)
{
    struct kiln_test_summary *summary = &run->summaries[index];
    enum kiln_code code = end->exit_code == KILN_IO && !end->signal ? KILN_IO : KILN_DEVICE_FAILED;
    char line[LOG_LINE_SIZE] = "", message[KILN_MESSAGE_SIZE];
    if (!end->problem[0])
        last_log_line(task_of(run, index).log, line);
    snprintf(message, sizeof message, "%.500s%s%s", cause, *line ? "; its log ends: " : "", line);
    struct kiln_error error = {0};
    if (kiln_test_record_error(run->suite, index, code, message, end->total_s, &error) &&
        kiln_test_read_summary(run->suite, index, summary, &error))
        return;
    report_error(&error);
    *summary = (struct kiln_test_summary){.status = KILN_TEST_ERROR,
                                          .code = kiln_code_worse(code, error.code),
                                          .total_s = end->total_s};
    snprintf(summary->message, sizeof summary->message, "%s", message);
}

/* Prints a line for each test whose turn it is. Tests end in any order, but lines come in the order
 * of the tests' names, so the line of a test waits for the lines before it. */
static void print_ended(struct test_run *run)
{
    for (; run->printed < run->count && run->ended[run->printed]; run->printed++)
        test_lines_test(&run->lines, run->suite, run->printed, &run->summaries[run->printed]);
}

static void end_test(void *user, size_t index, const struct pool_end *end)
{
    struct test_run *run = user;
    char cause[KILN_MESSAGE_SIZE];
    struct kiln_error error = {0};
    if (describe_failure(end, task_of(run, index).time_limit_s, cause))
        record_failure(run, index, end, cause);
    else if (!kiln_test_read_summary(run->suite, index, &run->summaries[index], &error))
        record_failure(run, index, end, error.message);
    run->ended[index] = true;
    run->ended_count++;
    run->code = kiln_code_worse(run->code, run->summaries[index].code);
    print_ended(run);
}

/* ---- The run -------------------------------------------------------------------------------- */

/* Writes the files of the whole run and the reports that were asked for. Fills in the summary if
 * the results of all tests can be read. Returns the worse of the tests' code and the code of a
 * failure to write. */
static enum kiln_code write_results(const struct test_run *run, struct test_outputs *outputs,
                                    const char *folder, double total_s,
                                    struct kiln_results_summary *summary)
{
    struct kiln_error error = {0};
    struct kiln_results *results = NULL;
    if (kiln_suite_write_run(run->suite, total_s, &error))
        results = kiln_results_load(&folder, 1, &error);
    if (!results) {
        report_error(&error);
        outputs->page = NULL;
        return kiln_code_worse(run->code, error.code);
    }
    *summary = kiln_results_summary(results);
    enum kiln_code code =
        test_outputs_write(outputs, results, &folder, 1, kiln_code_worse(run->code, summary->code));
    kiln_results_destroy(&results);
    return code;
}

static int finish(struct test_run *run, struct test_outputs *outputs, double total_s)
{
    struct kiln_results_summary summary = {0};
    signals_install_immediate(); /* no loop checks for signals any more */
    int code = (int)write_results(run, outputs, run->lines.results, total_s, &summary);
    bool nothing = summary.tests > 0 && summary.counts[KILN_TEST_SKIP] == summary.tests;
    if (!run->lines.quiet || code) {
        if (summary.tests > 0)
            test_lines_counts(run->lines.out, &summary);
        test_lines_end(&run->lines, &summary, outputs->page);
    }
    if (code == 0 && nothing)
        return report(KILN_NO_DEVICE,
                      "test: every test was skipped, so nothing was tested: none is for a device "
                      "of this machine");
    return code;
}

static int run_tests(struct test_run *run, struct test_outputs *outputs)
{
    const struct pool pool = {.count = run->count,
                              .jobs = run->jobs,
                              .start = start_test,
                              .ended = end_test,
                              .stop = signals_wants_stop,
                              .user = run};
    struct kiln_error error = {0};
    double started_s = now_s();
    signals_install();
    if (pool_run(&pool, &error))
        return finish(run, outputs, now_s() - started_s);
    return error.code == KILN_INTERRUPTED
               ? signals_report("test", " after %zu of %zu tests", run->ended_count, run->count)
               : report_error(&error);
}

/* Decides how many tests run at a time, and how many threads each test has. */
static void share_cores(struct test_run *run, const struct arguments *arguments)
{
    uint32_t cores = pool_cores();
    uint32_t jobs = arguments_integer(arguments, "jobs", cores);
    jobs = jobs > run->count ? (uint32_t)run->count : jobs;
    run->jobs = jobs > 0 ? jobs : 1;
    run->params.threads = arguments_integer(arguments, "threads", 0);
    if (run->params.threads == 0)
        run->params.threads = cores > run->jobs ? cores / run->jobs : 1;
}

static int read_options(struct test_run *run, struct test_outputs *outputs,
                        const struct arguments *arguments, const struct value_list *techniques,
                        const char *page)
{
    struct kiln_test_params *params = &run->params;
    *params = kiln_test_defaults();
    params->device = arguments_text(arguments, "device", NULL);
    params->techniques = techniques->items;
    params->technique_count = techniques->count;
    params->repeat = arguments_integer(arguments, "repeat", params->repeat);
    params->update = arguments_flag(arguments, "update")
                         ? (enum kiln_update)(arguments_choice(arguments, "update", 0) + 1)
                         : KILN_UPDATE_NONE;
    params->dry_run = arguments_flag(arguments, "dry-run");
    params->ignore_hashes = arguments_flag(arguments, "ignore-hashes");
    params->strict = arguments_flag(arguments, "strict");
    params->build = build_name();
    params->against = arguments_text(arguments, "against", NULL);
    params->log = report_log();
    run->time_limit_s = arguments_number(arguments, "test-timeout", 0);
    run->lines.quiet = arguments_flag(arguments, "quiet");
    if (params->dry_run && params->update == KILN_UPDATE_NONE)
        return report(KILN_USAGE, "test: --dry-run: needs --update missing, failed or all; it "
                                  "prints what --update would write");
    if (params->ignore_hashes && params->strict)
        return report(KILN_USAGE, "test: --ignore-hashes and --strict exclude each other");
    return test_outputs_read(outputs, arguments, "test", page);
}

/* Checks that no report replaces what the run reads, or its results. */
static int claim_files(const struct test_run *run, const struct test_outputs *outputs)
{
    struct kiln_error error = {0};
    struct kiln_claims *claims = kiln_claims_create();
    int code = claims ? 0 : report_no_memory();
    if (code == 0 && !kiln_suite_claim(run->suite, claims, &error))
        code = report_error(&error);
    if (code == 0 && run->params.against && strchr(run->params.against, '/') &&
        !kiln_claims_read(claims, run->params.against, "--against", &error))
        code = report_error(&error);
    if (code == 0)
        code = test_outputs_claim(outputs, claims);
    kiln_claims_destroy(&claims);
    return code;
}

static int run_suite(struct test_run *run, struct test_outputs *outputs,
                     const struct arguments *arguments)
{
    struct kiln_suite *suite;
    int code = select_tests(&suite, arguments, "test");
    if (code == 0) {
        run->suite = suite;
        run->count = kiln_suite_count(suite);
        run->summaries = calloc(run->count, sizeof *run->summaries);
        run->ended = calloc(run->count, sizeof *run->ended);
        code = run->summaries && run->ended ? 0 : report_no_memory();
    }
    if (code == 0)
        code = claim_files(run, outputs);
    if (code == 0)
        code = claim_folder(run->lines.results);
    struct kiln_error error = {0};
    if (code == 0 && !kiln_suite_begin(suite, &error))
        code = report_error(&error);
    if (code == 0) {
        share_cores(run, arguments);
        test_lines_start(&run->lines, suite, outputs->standard_output ? stderr : stdout);
        code = run_tests(run, outputs);
    }
    free(run->summaries);
    free(run->ended);
    kiln_suite_destroy(&suite);
    return code;
}

static int run(const struct arguments *arguments)
{
    struct test_run run = {.lines.results = arguments_text(arguments, "results", DEFAULT_RESULTS),
                           .lines.arguments = arguments};
    struct test_outputs outputs = {0};
    struct value_list techniques;
    bool ok = value_list_create(&techniques, arguments, "technique");
    char *page = join_path(run.lines.results, "report.html");
    int code = ok && page ? read_options(&run, &outputs, arguments, &techniques, page)
                          : report_no_memory();
    if (code == 0)
        code = run_suite(&run, &outputs, arguments);
    value_list_free(&techniques);
    free(page);
    return code;
}

const struct command test_command = {
    .name = "test",
    .summary = "render tests and compare them with golden pictures",
    .operands = "[PATH | NAME]...",
    .description =
        "Renders frames of scenes and judges them by accepted states and "
        "pictures. " SELECT_DESCRIPTION "\n"
        "\n"
        "A frame is judged by the hash of the simulation's state, which is the same everywhere; "
        "then by the hash of the picture's pixels on this device; then by how different it looks "
        "from the golden picture (see 'kiln compare'). Other pixels within the limits are a "
        "change. A change is reported; with --strict, it fails. A golden that is missing is a "
        "failure, and is never written without --update. 'kiln help tests' explains test files.\n"
        "\n"
        "The device is 'cpu', whose pixels are the same on every machine, unless a test, --device "
        "or a technique that needs OpenGL asks for another device.\n"
        "\n"
        "Each test has a process of its own: a crash or a hang is the error of that test alone. "
        "The output of the process goes to log.txt in its results.\n"
        "\n"
        "Exit code 0: every test passed; 1: a picture or the state differs; 7: a golden or its "
        "expect.yaml is missing; 2: usage, or there are no tests; 3: a test, scene or golden "
        "cannot be read; 4: no usable device, or every test was skipped; 5: a test crashed or took "
        "too long; 6: results or a report cannot be written. Of several, the worst counts: 5, 6, "
        "4, 3, 2, 1, 7.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
