/* Runs kiln figure triptych, which shows a reference, a result and their difference. main.c calls
 * run for the command. figure.c parses the same options again when it checks a figure by the
 * arguments of its sidecar, so a sidecar fails its check once the parser does not know an option
 * that it uses, not even as an older spelling. figure_make.c draws the figure. */
#include "event.h"
#include "figure_make.h"

static const struct option options[] = {
    FIGURE_OUTPUT_OPTIONS, FIGURE_LOOK_OPTIONS, FIGURE_THREADS_OPTION, EVENTS_OPTION, HELP_OPTION,
};

static int run(const struct arguments *arguments)
{
    return figure_make(&figure_triptych_command, KILN_FIGURE_TRIPTYCH, arguments, NULL);
}

const struct command figure_triptych_command = {
    .name = "figure triptych",
    .summary = "draw a reference, a result and their error map",
    .operands = "REFERENCE TEST",
    .description =
        "Shows two pictures and the map of FLIP's errors beside them, with their mean error, as "
        "'kiln compare' measures it. The map goes from black (0) to pale yellow (1).",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 2,
    .most_operands = 2,
    .run = run,
};
