/* Declares the subcommands, one struct command each. The dispatch, the help, the man page and the
 * completion read them. */
#ifndef KILN_CMD_COMMAND_H
#define KILN_CMD_COMMAND_H

#include "options.h"

struct command {
    const char *name;        /* "render", or two words: "test approve" */
    const char *summary;     /* one line for lists of commands */
    const char *operands;    /* as the synopsis shows them, "SCENE..." */
    const char *description; /* paragraphs, with an empty line between two */
    const struct option *options;
    size_t option_count;
    size_t least_operands, most_operands;
    enum file_access access;                       /* what it does with files that are operands */
    int (*run)(const struct arguments *arguments); /* returns the exit code */
};

extern const struct command render_command, bake_command, export_command, plan_command,
    join_command, encode_command, compare_command, test_command, test_approve_command,
    test_calibrate_command, test_report_command, test_list_command, figure_command,
    figure_sheet_command, figure_triptych_command, figure_strip_command, bench_command,
    check_command, devices_command, new_command, params_command, help_command, complete_command;

/* All commands but `complete`, in the order of the help; NULL ends the list. */
extern const struct command *const commands[];

/* Returns the command whose name is "FIRST SECOND" or, if there is none, `first`; NULL if there is
 * no such command. It finds `complete`, too. second may be NULL. */
const struct command *command_find(const char *first, const char *second);

/* Returns whether the command's name has two words of which the first is `group`. */
bool command_is_under(const struct command *command, const char *group);

/* The option --help, which every command has as the last row of its table. */
#define HELP_OPTION                                                                                \
    {                                                                                              \
        .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "Print this help."             \
    }

/* The option --quality of commands that write clips. */
#define QUALITY_OPTION                                                                             \
    {                                                                                              \
        .name = "quality", .kind = OPTION_INTEGER, .placeholder = "N",                             \
        .help = "Quality of JPEG, MP4, WebM, MOV and WebP files, from 0 (smallest) to 100 "        \
                "(visually lossless).",                                                            \
        .fallback = "80", .max = 100                                                               \
    }

/* Prints the help of a command on standard output. */
void help_print_command(const struct command *command);

/* Prints the lists of commands and topics, for `kiln help`; on standard error for `kiln` alone. */
void help_print_overview(FILE *out);

/* Visits the topics of `kiln help` that are not commands. */
void help_visit_topics(void (*visit)(void *user, const char *name, const char *summary),
                       void *user);

/* Prints a text wrapped at 80 columns. The first line continues at column `column`; the other lines
 * begin at column `indent`. An empty line in the text stays an empty line. */
void help_print_wrapped(FILE *out, const char *text, size_t column, size_t indent);

/* Writes the variables of the environment, for `kiln help environment`. Returns false when writing
 * failed. */
bool help_write_environment(FILE *out);

/* Writes how to set up completion in bash and zsh. Returns false when writing failed. */
bool help_write_completion(FILE *out);

/* Write the man pages in roff: kiln(1), and kiln-scene(5) with the keys of a scene. They return
 * false when memory is short. */
bool man_print(FILE *out);
bool man_print_scene(FILE *out);

/* Lists all exit codes; a row with a NULL meaning ends the list. */
struct exit_code {
    int code;
    const char *again; /* whether to run the command again: "never", "again", "with more" memory or
                          time */
    const char *meaning;
};
extern const struct exit_code exit_codes[];

/* Returns `again` of a code, which is "again" for a code that is not listed, such as that of a
 * killed process. A signal handler may call it. */
const char *exit_code_again(int code);

/* Returns whether a command with this exit code has a result: it did all its work, or pictures
 * differ. */
bool exit_code_has_result(int code);

/* Lists the variables of the environment that kiln reads; a row with a NULL name ends the list. */
struct variable {
    const char *name;
    const char *meaning;
};
extern const struct variable variables[];

/* Fills in the names of all commands, for suggestions. Returns their number. */
enum { MAX_COMMANDS = 32 };
size_t command_names(const char *names[MAX_COMMANDS]);

#endif
