/* Runs kiln help, and prints --help of every command. Commands, options and topics are printed from
 * tables, so that no text is written twice. */
#include <string.h>

#include "command.h"
#include "event.h"
#include "report.h"

enum { WIDTH = 80, OPTION_INDENT = 30 };

static const char NEVER[] = "never", AGAIN[] = "again", MORE[] = "with more";

const struct exit_code exit_codes[] = {
    {0, NEVER, "all went well"},
    {1, NEVER, "a frame failed, or a picture differs"},
    {2, NEVER,
     "the command line is wrong, or it names an output that exists or a journal of another job"},
    {3, NEVER, "a scene or another input file is wrong"},
    {4, AGAIN,
     "no device is usable; or, for want of a device, every test was skipped or nothing was "
     "measured"},
    {5, MORE,
     "the device was lost, memory ran out, a frame or test took longer than its limit, a test "
     "crashed, or a library aborted"},
    {6, AGAIN, "reading or writing failed"},
    {7, NEVER, "a golden picture is missing, or its accepted hashes and limits are"},
    {8, MORE, "the job took more than its limits or --timeout allow"},
    {9, AGAIN, "the reader of standard output went away before the job was done"},
    {129, AGAIN, "stopped by SIGHUP; only whole files are left"},
    {130, AGAIN, "stopped by SIGINT; only whole files are left"},
    {143, AGAIN, "stopped by SIGTERM; only whole files are left"},
    {0, NULL, NULL},
};

const char *exit_code_again(int code)
{
    for (const struct exit_code *row = exit_codes; row->meaning; row++) {
        if (row->code == code)
            return row->again;
    }
    return AGAIN;
}

bool exit_code_has_result(int code)
{
    return code == KILN_OK || code == KILN_FRAME_FAILED;
}

void help_print_wrapped(FILE *out, const char *text, size_t column, size_t indent)
{
    bool at_start = true;
    while (*text) {
        if (*text == '\n') {
            fprintf(out, "\n\n");
            text += strspn(text, "\n");
            fprintf(out, "%*s", (int)indent, "");
            column = indent;
            at_start = true;
        }
        size_t length = strcspn(text, " \n");
        if (!at_start && column + 1 + length > WIDTH) {
            fprintf(out, "\n%*s", (int)indent, "");
            column = indent;
        } else if (!at_start) {
            fputc(' ', out);
            column++;
        }
        fwrite(text, 1, length, out);
        column += length;
        at_start = false;
        text += length;
        text += *text == ' ';
    }
    fputc('\n', out);
}

static bool write_exit_codes(FILE *out)
{
    enum { MEANING_COLUMN = 18 };
    fputs(" CODE  AGAIN?     MEANING\n", out);
    for (const struct exit_code *row = exit_codes; row->meaning; row++) {
        fprintf(out, "%5d  %-9s  ", row->code, row->again);
        help_print_wrapped(out, row->meaning, MEANING_COLUMN, MEANING_COLUMN);
    }
    fputs("\n"
          "AGAIN? is for schedulers. never: the same call ends the same way. again: the same call\n"
          "may succeed, on another machine where a device or a disk is the reason; with --resume\n"
          "it goes on. with more: it may succeed with more memory, more time, or larger limits.\n",
          out);
    return !ferror(out);
}

static bool write_tests(FILE *out)
{
    return kiln_test_write_reference(out) && kiln_write_reports(out);
}

bool help_write_completion(FILE *out)
{
    fputs("bash, zsh and fish complete commands, options, their values, keys of scenes and the\n"
          "names of systems when Tab is pressed. 'cmake --install' puts the scripts where the "
          "shells\n"
          "look. bash needs the package bash-completion, zsh needs compinit. To load the scripts "
          "by\n"
          "hand, add to .bashrc, .zshrc or config.fish:\n"
          "\n"
          "    . PREFIX/share/bash-completion/completions/kiln\n"
          "    fpath=(PREFIX/share/zsh/site-functions $fpath); autoload -U compinit; compinit\n"
          "    source PREFIX/share/fish/vendor_completions.d/kiln.fish\n"
          "\n"
          "Before kiln is installed, the scripts are cmd/completion/kiln.bash and kiln.fish, and "
          "the\n"
          "folder of cmd/completion/_kiln. They ask the kiln that the command line names. Names "
          "out of\n"
          "scenes and results are quoted, and those that no system may have are left out.\n",
          out);
    return !ferror(out);
}

static bool write_man(FILE *out)
{
    return man_print(out) && !ferror(out);
}

static bool write_man_scene(FILE *out)
{
    return man_print_scene(out) && !ferror(out);
}

struct topic {
    const char *name;
    const char *summary;
    bool (*write)(FILE *out);
};

static const struct topic topics[] = {
    {"scene", "every key of a scene file", kiln_scene_write_reference},
    {"schema", "the JSON schema of scene files, for editors", kiln_scene_write_schema},
    {"techniques", "the techniques of each stage", kiln_write_techniques},
    {"metrics", "the metrics that compare pictures", kiln_write_metrics},
    {"limits", "the limits of a job, and the preset for services", kiln_write_limits},
    {"templates", "scenes to begin with, for 'kiln new'", kiln_write_templates},
    {"outputs", "the output formats by suffix", kiln_write_outputs},
    {"tests", "every key of a test file, and the reports", write_tests},
    {"jobs", "every key of a file of jobs, for 'kiln render --batch'", kiln_batch_write_reference},
    {"jobs-schema", "the JSON schema of files of jobs, for editors", kiln_batch_write_schema},
    {"events", "the events that --events writes for other programs", help_write_events},
    {"events-schema", "the JSON schema of events", help_write_events_schema},
    {"exit-codes", "what each exit code means", write_exit_codes},
    {"environment", "the variables of the environment that kiln reads", help_write_environment},
    {"completion", "completion of command lines in bash, zsh and fish", help_write_completion},
    {"man", "the manual page, for `man -l`", write_man},
    {"man-scene", "the manual page of scene files", write_man_scene},
};
enum { TOPIC_COUNT = sizeof topics / sizeof *topics };

void help_visit_topics(void (*visit)(void *user, const char *name, const char *summary), void *user)
{
    for (size_t i = 0; i < TOPIC_COUNT; i++)
        visit(user, topics[i].name, topics[i].summary);
}

static void print_option(const struct option *option)
{
    char left[96], text[512];
    int length = option->letter
                     ? snprintf(left, sizeof left, "  -%c, --%s", option->letter, option->name)
                     : snprintf(left, sizeof left, "      --%s", option->name);
    if (option->placeholder)
        snprintf(left + length, sizeof left - (size_t)length,
                 option->value_is_optional ? "[=%s]" : " %s", option->placeholder);
    snprintf(text, sizeof text, "%s%s%s%s", option->help, option->fallback ? " Default: " : "",
             option->fallback ? option->fallback : "", option->fallback ? "." : "");
    if (strlen(left) + 2 > OPTION_INDENT)
        printf("%s\n%*s", left, OPTION_INDENT, "");
    else
        printf("%-*s", OPTION_INDENT, left);
    help_print_wrapped(stdout, text, OPTION_INDENT, OPTION_INDENT);
}

static void print_repeating(const struct command *command)
{
    printf("\n"
           "Options and operands may come in any order; '--' ends the options. If an option is\n"
           "given twice, the last one counts, but these options add up:");
    for (size_t i = 0; i < command->option_count; i++) {
        if (command->options[i].repeats)
            printf(" --%s", command->options[i].name);
    }
    printf(".\n");
}

/* Prints the two-word commands that begin with this command's name. */
static void print_group(const struct command *command)
{
    bool any = false;
    for (size_t i = 0; commands[i]; i++) {
        if (!command_is_under(commands[i], command->name))
            continue;
        printf("%s  %-16s %s\n", any ? "" : "\nRelated commands:\n", commands[i]->name,
               commands[i]->summary);
        any = true;
    }
}

void help_print_command(const struct command *command)
{
    printf("usage: kiln %s [OPTION...]%s%s\n\n", command->name, *command->operands ? " " : "",
           command->operands);
    help_print_wrapped(stdout, command->description, 0, 0);
    printf("\n");
    bool any_repeats = false;
    for (size_t i = 0; i < command->option_count; i++) {
        print_option(&command->options[i]);
        any_repeats = any_repeats || command->options[i].repeats;
    }
    if (any_repeats)
        print_repeating(command);
    print_group(command);
}

void help_print_overview(FILE *out)
{
    fprintf(out, "kiln " KILN_VERSION ": renders particle effects without a display\n\n"
                 "usage: kiln COMMAND [OPTION...] [OPERAND...]\n"
                 "       kiln --version | --help\n\ncommands:\n");
    for (size_t i = 0; commands[i]; i++)
        fprintf(out, "  %-16s %s\n", commands[i]->name, commands[i]->summary);
    fprintf(out, "\ntopics of 'kiln help TOPIC', beside the commands:\n");
    for (size_t i = 0; i < TOPIC_COUNT; i++)
        fprintf(out, "  %-16s %s\n", topics[i].name, topics[i].summary);
    fprintf(out, "\nA first picture:\n"
                 "  kiln new fire.yaml\n"
                 "  kiln render fire.yaml -o fire.png --frames 60\n");
}

/* Prints the keys of scenes at or below a key, and those that mention a text; NULL: all. */
static int print_keys(const char *below, const char *text)
{
    size_t count;
    if (!kiln_scene_write_keys(stdout, below, text, &count))
        return ferror(stdout) ? KILN_IO : report_no_memory();
    if (count > 0)
        return 0;
    char shown[128];
    kiln_shown(shown, sizeof shown, text ? text : below);
    return report(KILN_USAGE,
                  text ? "help: no key of a scene mentions '%s'; 'kiln help' lists the topics"
                       : "help: a scene has no key '%s'; 'kiln help scene' lists the keys",
                  shown);
}

static int unknown_topic(const char *name)
{
    const char *names[MAX_COMMANDS + TOPIC_COUNT];
    size_t count = command_names(names);
    for (size_t i = 0; i < TOPIC_COUNT; i++)
        names[count++] = topics[i].name;
    char suggestion[SUGGESTION_SIZE];
    return report(KILN_USAGE, "help: unknown topic '%s'%s; 'kiln help' lists the topics", name,
                  suggest(suggestion, "", name, names, count));
}

/* Prints a topic or, where the word is none, the keys of scenes that mention it. */
static int print_topic(const char *name)
{
    for (size_t i = 0; i < TOPIC_COUNT; i++) {
        if (strcmp(topics[i].name, name) == 0)
            return topics[i].write(stdout) ? 0 : KILN_IO;
    }
    size_t count = 0;
    if (!kiln_scene_write_keys(stdout, NULL, name, &count))
        return ferror(stdout) ? KILN_IO : report_no_memory();
    return count > 0 ? 0 : unknown_topic(name);
}

static int run(const struct arguments *arguments)
{
    if (arguments->operand_count == 0) {
        help_print_overview(stdout);
        return 0;
    }
    const char *name = arguments->operands[0];
    const char *second = arguments->operand_count > 1 ? arguments->operands[1] : NULL;
    const char *text = arguments_text(arguments, "search", NULL);
    if (strcmp(name, "scene") == 0 && (second || text))
        return print_keys(second, text);
    if (text)
        return report(KILN_USAGE, "help: --search searches the keys of 'kiln help scene'");
    const struct command *command = command_find(name, second);
    if (second && (!command || strcmp(command->name, name) == 0)) {
        for (size_t i = 0; commands[i]; i++) {
            char both[64];
            snprintf(both, sizeof both, "%s %s", name, second);
            if (command_is_under(commands[i], name))
                return unknown_topic(both);
        }
        return report(KILN_USAGE, "help: one operand too many, '%s'", second);
    }
    if (command) {
        help_print_command(command);
        return 0;
    }
    return print_topic(name);
}

static const struct option options[] = {
    {.name = "search",
     .kind = OPTION_TEXT,
     .placeholder = "TEXT",
     .help = "Of 'kiln help scene', print the keys that mention a text."},
    HELP_OPTION,
};

const struct command help_command = {
    .name = "help",
    .summary = "explain a command or a topic",
    .operands = "[TOPIC [KEY]]",
    .description =
        "Explains a command or a topic. Without an operand, it lists both. 'kiln help scene "
        "systems.NAME.look' prints that part of a scene's keys, and 'kiln help scene "
        "--search WORD' those that mention a word.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = 2, /* a command of two words, or a key */
    .run = run,
};
