/* Runs kiln test list, which lists the tests that kiln test would run. */
#include <unistd.h>

#include "command.h"
#include "event.h"
#include "report.h"
#include "test_select.h"

static const struct option options[] = {
    FILTER_OPTION,
    SUITE_ROOT_OPTION,
    SHARD_OPTION,
    GOLDEN_OPTION,
    RESULTS_OPTION,
    {.name = "files",
     .letter = 'l',
     .kind = OPTION_FLAG,
     .help = "Also print each test's file, after a tab."},
    EVENTS_OPTION,
    HELP_OPTION,
};

static int run(const struct arguments *arguments)
{
    struct kiln_suite *suite;
    int code = select_tests(&suite, arguments, "test list");
    bool files = arguments_flag(arguments, "files");
    const bool for_person = isatty(STDOUT_FILENO) == 1;
    for (size_t i = 0; code == 0 && i < kiln_suite_count(suite); i++) {
        struct kiln_test_info test = kiln_suite_test(suite, i);
        char path[KILN_PATH_SIZE];
        /* A program gets the paths unescaped, unless a CI server would take one for a command. */
        const bool is_shown = for_person || kiln_has_marker(test.path);
        if (is_shown)
            kiln_shown(path, sizeof path, test.path);
        printf("%s%s%s\n", test.name, files ? "\t" : "", !files ? "" : is_shown ? path : test.path);
    }
    kiln_suite_destroy(&suite);
    return code;
}

const struct command test_list_command = {
    .name = "test list",
    .summary = "list the tests that 'kiln test' would run",
    .operands = "[PATH | NAME]...",
    .description = "Prints the names of the tests, in the order in which they run. "
                   "" SELECT_DESCRIPTION
                   "\n\nThe folders of goldens and of results are not searched for tests.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
