/* Runs kiln test approve, which accepts the pictures of the last run as the new goldens. main.c
 * finds test_approve_command in its table and calls run once.
 *
 * This file only chooses tests, by name, by pattern or by --all, and calls kiln_test_approve for
 * each. What may be accepted, and how goldens are written, is decided in lib/suite/approve.c. The
 * choices of --as stand in the order of enum kiln_approve_as, since a choice's number is used as
 * its value. */
#include <fnmatch.h>
#include <string.h>

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
    bool quiet;
    uint32_t count;      /* files written for the present test */
    uint32_t all;        /* number of tests of which something was accepted */
    enum kiln_code code; /* the worst failure so far; the tests after it are still tried */
};

static void print_change(void *user, const char *line)
{
    struct approval *approval = user;
    approval->count++;
    if (!approval->quiet)
        printf("%s\n", line);
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
        printf("%s: nothing to accept\n", name);
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
    struct kiln_results *results = kiln_results_load(&approval->params.results, 1, &error);
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
                      approval->params.results);
    if (approval->all == before && approval->code == KILN_OK && !approval->quiet)
        printf("%s: nothing to accept\n", pattern ? pattern : "all tests");
    return 0;
}

static int run(const struct arguments *arguments)
{
    const bool all = arguments_flag(arguments, "all");
    struct approval approval = {.quiet = arguments_flag(arguments, "quiet")};
    approval.params = (struct kiln_approve_params){
        .results = arguments_text(arguments, "results", DEFAULT_RESULTS),
        .as = (enum kiln_approve_as)arguments_choice(arguments, "as", KILN_APPROVE_REPLACE),
        .device = arguments_text(arguments, "device", NULL),
        .dry_run = arguments_flag(arguments, "dry-run"),
        .change = print_change,
        .user = &approval};
    if (all == (arguments->operand_count > 0))
        return report(KILN_USAGE,
                      all ? "test approve: --all takes no names"
                          : "test approve: names of tests are missing; give them, or --all");
    signals_install_immediate(); /* no loop checks for signals, and no file is left half-written */
    int code = all ? approve_matching(&approval, NULL) : 0;
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const char *operand = arguments->operands[i];
        if (!is_pattern(operand))
            approve(&approval, operand, true);
        else
            code = (int)kiln_code_worse((enum kiln_code)code,
                                        (enum kiln_code)approve_matching(&approval, operand));
    }
    return (int)kiln_code_worse((enum kiln_code)code, approval.code);
}

const struct command test_approve_command = {
    .name = "test approve",
    .summary = "accept pictures of the last run as goldens",
    .operands = "[NAME]...",
    .description =
        "Accepts what the last run of each test rendered, where it was new, failed, changed or "
        "warned of. The pictures become goldens, and their hashes are expected from then on. "
        "Nothing is rendered: the pictures that were looked at are accepted. Results are refused "
        "when the scene, the pictures or the goldens have changed since the run.\n"
        "\n"
        "A pattern such as 'effects/*' stands for the tests of the last run that it matches, --all "
        "for every test. If one test cannot be accepted, the others still are.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
