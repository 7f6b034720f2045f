/* Runs kiln join, which joins the parts that several tasks drew into one clip. */
#include <inttypes.h>
#include <stdlib.h>

#include "build.h"
#include "command.h"
#include "event.h"
#include "limits.h"
#include "report.h"
#include "sandbox.h"
#include "signals.h"

static const struct option options[] = {
    {.name = "manifest",
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .access = ACCESS_WRITE,
     .help = "Also write a JSON file that describes the job. Its `result` is that of one run; its "
             "`runs_before` are those of the shards."},
    {.name = "force",
     .kind = OPTION_FLAG,
     .help = "Replace files that exist and do not belong to the job."},
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    EVENTS_OPTION,
    HELP_OPTION,
};

static void print_result(const char *output, const struct kiln_join_stats *stats, bool quiet)
{
    struct kiln_json json = event_begin("result");
    kiln_json_string(&json, "output", output);
    kiln_json_uint(&json, "frames", stats->frames);
    kiln_json_uint(&json, "parts", stats->parts);
    kiln_json_bool(&json, "was_whole", stats->was_whole);
    event_end(&json);
    if (quiet)
        return;
    print_name(output);
    printf(": %" PRIu32 " frame%s in %" PRIu32 " part%s%s\n", stats->frames,
           stats->frames == 1 ? "" : "s", stats->parts, stats->parts == 1 ? "" : "s",
           stats->was_whole ? ", whole already" : "");
}

static int run_join(const struct arguments *arguments, const char **command, size_t count)
{
    const struct kiln_join_params params = {
        .size = sizeof params,
        .output = arguments->operands[0],
        .manifest = arguments_text(arguments, "manifest", NULL),
        .command = command,
        .command_count = count,
        .build = build_name(),
        .overwrite = arguments_flag(arguments, "force"),
        .stop = signals_wants_stop,
        .budget = arguments->budget,
        .log = report_log(),
    };
    struct kiln_join_stats stats = kiln_join_stats_empty();
    struct kiln_error error = {0};
    signals_install_for_job();
    if (!kiln_join(&params, &stats, &error))
        return error.code == KILN_INTERRUPTED ? signals_report(params.output, "%s", "")
                                              : report_error(&error);
    print_result(params.output, &stats, arguments_flag(arguments, "quiet"));
    return 0;
}

static int run(const struct arguments *arguments)
{
    size_t count = 0;
    const char **command = calloc(arguments->argc + 2, sizeof *command);
    if (!command)
        return report_no_memory();
    command[count++] = "kiln";
    command[count++] = "join";
    for (size_t i = 0; i < arguments->argc; i++)
        command[count++] = arguments->argv[i];
    const int code = run_join(arguments, command, count);
    free(command);
    return code;
}

const struct command join_command = {
    .name = "join",
    .summary = "make a clip of the parts that several tasks drew",
    .operands = "OUTPUT",
    .description =
        "OUTPUT is the name that was given to 'kiln render --shard' as --output. The command "
        "checks that all parts are there, of one scene and by one version of kiln, and makes the "
        "clip of them. Its bytes are those of a clip that one run renders. For images, it checks "
        "that all are there. It names missing or damaged parts, and then writes nothing.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_WRITE,
    .run = run,
};
