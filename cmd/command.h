/* The subcommands: one row each, which the dispatch, the help and the man page read. */
#ifndef KILN_CMD_COMMAND_H
#define KILN_CMD_COMMAND_H

#include "options.h"

struct command {
    const char *name;        /* "render", or two words: "test approve" */
    const char *summary;     /* a line */
    const char *operands;    /* of the synopsis, "SCENE..." */
    const char *description; /* paragraphs, with an empty line between two */
    const struct option *options;
    size_t option_count;
    size_t least_operands, most_operands;
    enum reach reach;                              /* of operands */
    int (*run)(const struct arguments *arguments); /* returns the exit code */
};

extern const struct command render_command, bake_command, plan_command, join_command,
    encode_command, compare_command, test_command, test_approve_command, test_calibrate_command,
    test_report_command, test_list_command, figure_command, figure_sheet_command,
    figure_triptych_command, figure_strip_command, bench_command, check_command, devices_command,
    new_command, help_command, complete_command;

/* All but `complete`, in the order of the help; NULL ends the list. */
extern const struct command *const commands[];

/* The command whose name is the first word, or the first and the second one; the longer name
 * counts; `complete`, too. second may be NULL. NULL when there is none. */
const struct command *command_find(const char *first, const char *second);

/* Whether the command is one of two words whose first is `group`. */
bool command_is_under(const struct command *command, const char *group);

/* Every command takes it, and it comes last in its table. */
#define HELP_OPTION                                                                                \
    {                                                                                              \
        .name = "help", .letter = 'h', .kind = OPTION_FLAG, .help = "Print this help."             \
    }

/* Of commands that write clips. */
#define QUALITY_OPTION                                                                             \
    {                                                                                              \
        .name = "quality", .kind = OPTION_INTEGER, .placeholder = "N",                             \
        .help = "Quality of JPEG, MP4, WebM, MOV and WebP files, from 0 (smallest) to 100 (no "    \
                "loss that an eye can see).",                                                      \
        .fallback = "80", .max = 100                                                               \
    }

/* For --help of a command. */
void help_print_command(const struct command *command);

/* The overview, for `kiln help`, or for standard error after `kiln` alone. */
void help_print_overview(FILE *out);

/* Visits the topics of `kiln help` that are no commands. */
void help_visit_topics(void (*visit)(void *user, const char *name, const char *summary),
                       void *user);

/* Prints words within 80 columns; the first line goes on at column `column`, others start at
 * indent. An empty line in the text stays one. */
void help_print_wrapped(FILE *out, const char *text, size_t column, size_t indent);

/* The variables of the environment. */
bool help_write_environment(FILE *out);

/* How to have command lines completed. */
bool help_write_completion(FILE *out);

/* The man pages, in roff: kiln(1), and kiln-scene(5) of the keys of a scene. False when memory is
 * short. */
bool man_print(FILE *out);
bool man_print_scene(FILE *out);

/* Each exit code; a NULL meaning ends the list. */
struct exit_code {
    int code;
    const char *again; /* whether to run the command again: "never", "again", "with more" memory or
                          time */
    const char *meaning;
};
extern const struct exit_code exit_codes[];

/* `again` of a code: "again" for one that is not listed, such as that of a kill. A signal's handler
 * may call it. */
const char *exit_code_again(int code);

/* Whether a command that ends with this code came to a result: it did all, or pictures differ. */
bool exit_code_has_result(int code);

/* Variables of the environment; as above. */
struct variable {
    const char *name;
    const char *meaning;
};
extern const struct variable variables[];

/* Names of all commands, for suggestions. Returns how many. */
enum { MAX_COMMANDS = 32 };
size_t command_names(const char *names[MAX_COMMANDS]);

#endif
