/* Runs kiln test approve, which accepts the pictures of the last run as the new goldens. main.c
 * finds test_approve_command in its table and calls run once.
 *
 * This file only chooses tests, by name, by pattern or by --all, and calls kiln_test_approve for
 * each. What may be accepted, and how goldens are written, is decided in lib/suite/approve.c. The
 * choices of --as stand in the order of enum kiln_approve_as, since a choice's number is used as
 * its value. */
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "event.h"
#include "report.h"
#include "signals.h"
#include "test_select.h"

static const struct option options[] = {
    {.name = "results",
     .older_letter = 'o',
     .kind = OPTION_TEXT,
     .placeholder = "FOLDER",
     .help = "The results of the run.",
     .fallback = DEFAULT_RESULTS},
    GOLDEN_OPTION,
    SUITE_ROOT_OPTION,
    {.name = "all",
     .kind = OPTION_FLAG,
     .help = "Accept every test of the run that was new, failed, changed or warned of."},
    {.name = "device",
     .kind = OPTION_TEXT,
     .placeholder = "DEVICE",
     .help = "Accept only pictures that a device drew whose name contains this text."},
    {.name = "as",
     .kind = OPTION_CHOICE,
     .placeholder = "replace|device|alternative",
     .help = "How to accept: replace puts the pictures in place of the goldens that they were "
             "judged by. device puts them beside these goldens, for this device only. alternative "
             "puts them beside these goldens as further right pictures.",
     .fallback = "replace"},
    {.name = "dry-run",
     .letter = 'n',
     .kind = OPTION_FLAG,
     .help = "Print what would be written, and write nothing."},
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    EVENTS_OPTION,
    HELP_OPTION,
};

struct approval {
    struct kiln_approve_params params;
    const char *results; /* the folder of results */
    bool quiet;
    uint32_t count;      /* files written for the present test */
    uint32_t all;        /* number of tests of which something was accepted */
    enum kiln_code code; /* the worst failure so far; the tests after it are still tried */
};

static void print_change(void *user, const char *line)
{
    struct approval *approval = user;
    approval->count++;
    if (!approval->quiet) {
        print_name(line);
        printf("\n");
    }
}

/* Accepts the pictures of a test. With `named`, the user gave the test's name, so the function
 * prints it if there is nothing to accept. */
static void approve(struct approval *approval, const char *name, bool named)
{
    struct kiln_error error = {0};
    approval->params.name = name;
    approval->count = 0;
    if (!kiln_test_approve(&approval->params, &error)) {
        report_error(&error);
        approval->code = kiln_code_worse(approval->code, error.code);
    } else if (approval->count == 0 && named && !approval->quiet) {
        print_name(name);
        printf(": nothing to accept\n");
    }
    approval->all += approval->count > 0;
}

static bool is_pattern(const char *operand)
{
    return operand[strcspn(operand, "*?[")] != '\0';
}

/* Accepts the tests of the last run that a pattern matches, or all tests if pattern is NULL. */
static int approve_matching(struct approval *approval, const char *pattern)
{
    struct kiln_error error = {0};
    struct kiln_results *results = kiln_results_load(&approval->results, 1, &error);
    if (!results)
        return report_error(&error);
    const uint32_t count = kiln_results_summary(results).tests, before = approval->all;
    approval->params.one_of_many = true;
    bool any = !pattern;
    for (uint32_t i = 0; i < count; i++) {
        const char *name = kiln_results_name(results, i);
        if (pattern && fnmatch(pattern, name, 0) != 0)
            continue;
        any = true;
        approve(approval, name, false);
    }
    approval->params.one_of_many = false;
    kiln_results_destroy(&results);
    if (!any)
        return report(KILN_USAGE, "test approve: no result of a test like '%s' in %s", pattern,
                      approval->results);
    if (approval->all == before && approval->code == KILN_OK && !approval->quiet) {
        print_name(pattern ? pattern : "all tests");
        printf(": nothing to accept\n");
    }
    return 0;
}

/* The operands of the command line: where tests are looked for, and which of them are meant. */
struct operands {
    const char **paths, **names;
    size_t path_count, name_count;
};

/* Returns whether an operand names a result of the last run, which a folder of the same name does
 * not hide. */
static bool is_result(const char *results, const char *operand)
{
    char path[KILN_PATH_SIZE];
    const int length = snprintf(path, sizeof path, "%s/%s/result.json", results, operand);
    return length < (int)sizeof path && access(path, F_OK) == 0;
}

static bool read_operands(struct operands *operands, const struct arguments *arguments,
                          const char *results)
{
    operands->paths = calloc(arguments->operand_count + 1, sizeof *operands->paths);
    operands->names = calloc(arguments->operand_count + 1, sizeof *operands->names);
    if (!operands->paths || !operands->names)
        return false;
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const char *operand = arguments->operands[i];
        if (operand_is_path(operand) && !is_result(results, operand))
            operands->paths[operands->path_count++] = operand;
        else
            operands->names[operands->name_count++] = operand;
    }
    return true;
}

/* Finds the tests, of which the results must be. */
static int load_suite(struct kiln_suite **suite, const struct operands *operands,
                      const struct arguments *arguments, const char *results)
{
    static const char *const here[] = {"."};
    struct kiln_error error = {0};
    struct kiln_suite_params params = kiln_suite_defaults();
    params.paths = operands->path_count > 0 ? operands->paths : here;
    params.path_count = operands->path_count > 0 ? operands->path_count : 1;
    params.golden = arguments_text(arguments, "golden", params.golden);
    params.results = results;
    params.asset_root = arguments_text(arguments, "asset-root", NULL);
    *suite = kiln_suite_load(&params, &error);
    return *suite ? 0 : report_error(&error);
}

/* Accepts the tests that the operands mean: all of the run, those that are named or fit a pattern,
 * or those of the files that are given. */
static int approve_all(struct approval *approval, const struct operands *operands, bool all)
{
    int code = all ? approve_matching(approval, NULL) : 0;
    for (size_t i = 0; i < operands->name_count; i++) {
        const char *name = operands->names[i];
        if (!is_pattern(name))
            approve(approval, name, true);
        else
            code = (int)kiln_code_worse((enum kiln_code)code,
                                        (enum kiln_code)approve_matching(approval, name));
    }
    const struct kiln_suite *suite = approval->params.suite;
    for (size_t i = 0; !all && operands->name_count == 0 && i < kiln_suite_count(suite); i++)
        approve(approval, kiln_suite_test(suite, i).name, true);
    return (int)kiln_code_worse((enum kiln_code)code, approval->code);
}

static int run(const struct arguments *arguments)
{
    const bool all = arguments_flag(arguments, "all");
    const char *results = arguments_text(arguments, "results", DEFAULT_RESULTS);
    struct approval approval = {.results = results, .quiet = arguments_flag(arguments, "quiet")};
    approval.params = (struct kiln_approve_params){
        .as = (enum kiln_approve_as)arguments_choice(arguments, "as", KILN_APPROVE_REPLACE),
        .device = arguments_text(arguments, "device", NULL),
        .dry_run = arguments_flag(arguments, "dry-run"),
        .change = print_change,
        .user = &approval};
    struct operands operands = {0};
    struct kiln_suite *suite = NULL;
    int code = read_operands(&operands, arguments, results) ? 0 : report_no_memory();
    if (code == 0 && (all ? operands.name_count > 0 : arguments->operand_count == 0))
        code = report(KILN_USAGE,
                      all ? "test approve: --all takes no names"
                          : "test approve: names of tests are missing; give them, or --all");
    if (code == 0)
        code = load_suite(&suite, &operands, arguments, results);
    approval.params.suite = suite;
    if (code == 0) {
        signals_install_immediate(); /* no loop checks for signals; no file is left half-written */
        code = approve_all(&approval, &operands, all);
    }
    kiln_suite_destroy(&suite);
    free(operands.paths);
    free(operands.names);
    return code;
}

const struct command test_approve_command = {
    .name = "test approve",
    .summary = "accept pictures of the last run as goldens",
    .operands = "[PATH | NAME]...",
    .description =
        "Accepts what the last run of each test rendered, where it was new, failed, changed or "
        "warned of. The pictures become goldens, and their hashes are expected from then on. "
        "Nothing is rendered: the pictures that were looked at are accepted. Results are refused "
        "when the scene, the pictures or the goldens have changed since the run.\n"
        "\n"
        "A pattern such as 'effects/*' stands for the tests of the last run that it matches, --all "
        "for every test. If one test cannot be accepted, the others still are.\n"
        "\n"
        "Results may come from elsewhere. The test and its goldens are those that are found here: "
        "in the PATHs, which are test files, scenes and folders as for 'kiln test', or in the "
        "working directory. A result that names others is refused. PATHs without a NAME stand for "
        "all of their tests.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
