/* kiln test approve: the pictures of the last run are right. */
#include "command.h"
#include "report.h"
#include "signals.h"
#include "test_select.h"

static const struct option options[] = {
    {.name = "results",
     .letter = 'o',
     .kind = OPTION_TEXT,
     .placeholder = "FOLDER",
     .help = "The results of the run.",
     .fallback = DEFAULT_RESULTS},
    {.name = "as",
     .kind = OPTION_CHOICE,
     .placeholder = "replace|device|alternative",
     .help = "Put the pictures in place of the goldens that they were judged by; beside these, for "
             "this device only; or beside them, as others that are right, too.",
     .fallback = "replace"},
    {.name = "dry-run",
     .letter = 'n',
     .kind = OPTION_FLAG,
     .help = "Say what would be written, and write none of it."},
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    HELP_OPTION,
};

struct listing {
    bool quiet;
    uint32_t count;
};

static void print_change(void *user, const char *line)
{
    struct listing *listing = user;
    listing->count++;
    if (!listing->quiet)
        printf("%s\n", line);
}

static int run(const struct arguments *arguments)
{
    enum kiln_code code = KILN_OK;
    signals_end_at_once(); /* whole pictures only */
    for (size_t i = 0; i < arguments->operand_count; i++) {
        struct listing listing = {.quiet = arguments_flag(arguments, "quiet")};
        const struct kiln_approve_params params = {
            .results = arguments_text(arguments, "results", DEFAULT_RESULTS),
            .name = arguments->operands[i],
            .as = (enum kiln_approve_as)arguments_choice(arguments, "as", KILN_APPROVE_REPLACE),
            .dry_run = arguments_flag(arguments, "dry-run"),
            .change = print_change,
            .user = &listing};
        struct kiln_error error = {0};
        if (!kiln_test_approve(&params, &error)) {
            report_error(&error);
            code = kiln_code_worse(code, error.code);
        } else if (listing.count == 0 && !listing.quiet) {
            printf("%s: nothing to accept, every picture passes\n", params.name);
        }
    }
    return (int)code;
}

const struct command test_approve_command = {
    .name = "test approve",
    .summary = "accept pictures of the last run as goldens",
    .operands = "NAME...",
    .description =
        "Accepts what the last run of each test rendered, where it was new, failed or was warned "
        "of: the pictures become goldens, and their hashes are expected from then on. Nothing is "
        "rendered: what is accepted is what was looked at. Results are refused when the scene, the "
        "pictures or the goldens have changed since.\n\n"
        "One test that cannot be accepted does not keep the others from it.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = SIZE_MAX,
    .run = run,
};
