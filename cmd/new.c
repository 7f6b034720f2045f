/* Runs `kiln new`, which writes a small scene for a person to begin with. main calls its function
 * through the table of commands. The scene is one of the templates that are built into the program
 * (lib/start/template.c); this file only reads the options, chooses between a file and standard
 * output, and prints what to do next. With '-', nothing but the scene may go to standard output. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "event.h"
#include "report.h"

static const struct option options[] = {
    {.name = "template",
     .letter = 't',
     .kind = OPTION_TEXT,
     .placeholder = "TEMPLATE",
     .help = "Which scene (see 'kiln help templates').",
     .fallback = "fire"},
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace a file that exists."},
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    EVENTS_OPTION,
    HELP_OPTION,
};

/* Prints the command that renders the scene, for a person to copy. */
static void print_next(const char *path)
{
    char name[KILN_PATH_SIZE];
    kiln_shown(name, sizeof name, path);
    printf("%s: a scene to begin with", name);
    if (strcmp(name, path) != 0) { /* the path has characters that control a terminal */
        printf("\n");
        return;
    }
    printf("; render it by: kiln render ");
    if (*path == '-')
        fputs("./", stdout);
    kiln_write_shell_word(stdout, path);
    fputs(" -o clip.mp4\n", stdout);
}

static int run(const struct arguments *arguments)
{
    const char *path = arguments->operands[0];
    const char *template = arguments_text(arguments, "template", "fire");
    struct kiln_error error = {0};
    if (!*path)
        return report(KILN_USAGE, "new: the name of the scene is empty");
    char *scene = kiln_template_scene(template, &error);
    if (!scene)
        return error.code == KILN_USAGE ? report(KILN_USAGE, "new: --template: %s", error.message)
                                        : report_error(&error);
    const bool prints = strcmp(path, "-") == 0;
    if (prints)
        fputs(scene, stdout); /* main calls report_finish, which reports a failed write */
    free(scene);
    if (!prints && !kiln_template_write(template, path, arguments_flag(arguments, "force"), &error))
        return report_error(&error);
    if (!prints && !arguments_flag(arguments, "quiet"))
        print_next(path);
    return 0;
}

const struct command new_command = {
    .name = "new",
    .summary = "write a scene to begin with",
    .operands = "SCENE",
    .description =
        "Writes a small commented scene that renders as it is, and needs no other file. Its first "
        "line names the schema of scenes for editors with a YAML language server, such as VS Code. "
        "They complete keys, explain them and mark mistakes. '-' is standard output.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_WRITE,
    .run = run,
};
