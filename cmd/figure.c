/* Runs kiln figure --check, which tells whether figures are still what their commands draw. Each
 * command stands in the figure's sidecar; it is run in the folder in which it was given, without
 * writing anything. With --update, a stale figure is written anew. */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "event.h"
#include "figure_make.h"
#include "report.h"
#include "signals.h"

static const struct option options[] = {
    {.name = "check",
     .repeats = true,
     .kind = OPTION_TEXT,
     .placeholder = "FIGURE",
     .help = "Say whether a figure is up to date. For a folder, say it of all figures that have a "
             "sidecar (FILE.figure.json)."},
    {.name = "update",
     .repeats = true,
     .kind = OPTION_TEXT,
     .placeholder = "FIGURE",
     .help =
         "Check like --check, and draw stale figures anew, each by the command in its sidecar."},
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .help = "Name only figures that are stale, or that were."},
    EVENTS_OPTION,
    HELP_OPTION,
};

static const struct {
    const struct command *command;
    enum kiln_figure_kind kind;
} kinds[] = {{&figure_sheet_command, KILN_FIGURE_SHEET},
             {&figure_triptych_command, KILN_FIGURE_TRIPTYCH},
             {&figure_strip_command, KILN_FIGURE_STRIP}};

struct check_mode {
    bool update, quiet;
};

/* Runs the command of a sidecar. The program has already changed to the folder of the command. */
static int run_command(const struct kiln_figure_entry *entry, const struct figure_check *check)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const struct command *command = kinds[i].command;
        if (entry->command_count < 2 || strcmp(entry->command[0], "figure") != 0 ||
            strcmp(entry->command[1], strchr(command->name, ' ') + 1) != 0)
            continue;
        struct arguments arguments;
        int code =
            arguments_parse(&arguments, command->options, command->option_count, command->name,
                            (int)entry->command_count - 2, (char **)(entry->command + 2));
        if (code == 0 && arguments.operand_count < command->least_operands)
            code = report(KILN_USAGE, "%s: needs %s", command->name, command->operands);
        if (code == 0)
            code = figure_make(command, kinds[i].kind, &arguments, check);
        arguments_free(&arguments);
        return code;
    }
    return report(KILN_INVALID_INPUT, "%s: the command in it is not a 'kiln figure' command",
                  entry->sidecar);
}

static int check_entry(const struct kiln_figure_entry *entry, int start_folder,
                       const struct check_mode *check_mode)
{
    if (entry->problem)
        return report_error(entry->problem);
    char *sidecar = realpath(entry->sidecar, NULL);
    if (!sidecar)
        return report(KILN_IO, "%s: the file cannot be read", entry->sidecar);
    struct kiln_figure_result result = {0};
    int code;
    if (chdir(entry->folder) != 0)
        code = report(KILN_IO, "%s: the folder of its command, '%s', cannot be entered",
                      entry->sidecar, entry->folder);
    else
        code = run_command(entry, &(struct figure_check){sidecar, check_mode->update, &result});
    free(sidecar);
    if (fchdir(start_folder) != 0)
        return report(KILN_IO, "the working directory cannot be entered again");
    char figure[KILN_MESSAGE_SIZE], reason[KILN_MESSAGE_SIZE];
    kiln_shown(figure, sizeof figure, entry->figure);
    if (code)
        return report((enum kiln_code)code, "%s: cannot be drawn, for the reason above", figure);
    kiln_shown(reason, sizeof reason, result.reason);
    if (result.redrawn)
        printf("%s: redrawn: %s\n", figure, reason);
    else if (result.stale)
        printf("%s: stale: %s\n", figure, reason);
    else if (!check_mode->quiet)
        printf("%s: up to date%s%s\n", figure, *reason ? ": " : "", reason);
    fflush(stdout);
    return result.stale && !result.redrawn ? KILN_FRAME_FAILED : 0;
}

static int check_all(const struct kiln_figure_list *list, const struct check_mode *check_mode)
{
    int start_folder = open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC), code = 0;
    if (start_folder < 0)
        return report(KILN_IO, "the working directory cannot be opened");
    for (size_t i = 0; i < kiln_figure_list_count(list) && !signals_received(); i++) {
        struct kiln_figure_entry entry = kiln_figure_list_entry(list, i);
        code = (int)kiln_code_worse((enum kiln_code)code,
                                    (enum kiln_code)check_entry(&entry, start_folder, check_mode));
    }
    close(start_folder);
    return signals_received() ? 128 + signals_received() : code;
}

/* Checks the paths of --check or --update and the operands after them, since the shell expands
 * `--check *.png` to a value and operands. */
static int check_paths(const struct value_list *paths, const struct arguments *arguments,
                       const struct check_mode *check_mode)
{
    size_t count = paths->count + arguments->operand_count;
    const char **all = calloc(count, sizeof *all);
    if (!all)
        return report_no_memory();
    for (size_t i = 0; i < count; i++)
        all[i] = i < paths->count ? paths->items[i] : arguments->operands[i - paths->count];
    struct kiln_error error = {0};
    struct kiln_figure_list *list = kiln_figure_list_load(all, count, &error);
    int code = list ? check_all(list, check_mode) : report_error(&error);
    kiln_figure_list_destroy(&list);
    free(all);
    return code;
}

static int report_no_paths(const struct arguments *arguments)
{
    static const char *const names[] = {"sheet", "triptych", "strip", "--check", "--update"};
    char suggestion[SUGGESTION_SIZE];
    if (arguments->operand_count == 0)
        return report(KILN_USAGE, "figure: an operand is missing: sheet, triptych or strip; or "
                                  "give --check FIGURE or --update FIGURE");
    return report(
        KILN_USAGE, "figure: unknown figure '%s'%s; allowed are sheet, triptych and strip",
        arguments->operands[0], suggest(suggestion, "", arguments->operands[0], names, 5));
}

static int run(const struct arguments *arguments)
{
    struct check_mode check_mode = {.update = arguments_flag(arguments, "update"),
                                    .quiet = arguments_flag(arguments, "quiet")};
    bool check = arguments_flag(arguments, "check");
    if (check && check_mode.update)
        return report(KILN_USAGE, "figure: --check and --update exclude each other");
    if (!check && !check_mode.update)
        return report_no_paths(arguments);
    struct value_list paths;
    int code = value_list_create(&paths, arguments, check ? "check" : "update")
                   ? check_paths(&paths, arguments, &check_mode)
                   : report_no_memory();
    value_list_free(&paths);
    return code;
}

const struct command figure_command = {
    .name = "figure",
    .summary = "draw figures for documents, and check that they are up to date",
    .operands = "",
    .description =
        "'kiln figure sheet', 'triptych' and 'strip' make figures. --check draws each figure that "
        "has a sidecar again, by its command and in the folder in which the command was given, and "
        "names the stale ones. A figure is stale when its pixels have changed, or when its file is "
        "not the one that was written. A figure that another device, driver or processor drew may "
        "differ within the limits of 'kiln compare'; the command says so. --check writes nothing. "
        "--update draws stale figures anew, and says so. More paths may follow the first one of "
        "either option.\n"
        "\n"
        "Exit code 0: all figures are up to date, or were redrawn; 1: some figures are stale. A "
        "figure that cannot be checked is reported, and the other figures are checked all the "
        "same. The code is then that of the gravest failure: 3 for a broken sidecar or scene, 2 "
        "for a wrong command.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
