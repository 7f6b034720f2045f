/* The manual page, in the man macros of roff, from the same tables as --help. */
#include <ctype.h>

#include "command.h"

/* Writes text so that roff prints it as it stands. */
static void put(FILE *out, const char *text)
{
    bool line_start = true;
    for (const char *c = text; *c; c++) {
        if (line_start && (*c == '.' || *c == '\''))
            fputs("\\&", out);
        line_start = *c == '\n';
        if (*c == '-')
            fputs("\\-", out);
        else if (*c == '\\')
            fputs("\\e", out);
        else if (*c == '\n' && c[1] == '\n')
            fputs("\n.PP", out);
        else
            fputc(*c, out);
    }
}

static void put_heading(FILE *out, const char *title)
{
    fputs(".SH ", out);
    for (const char *c = title; *c; c++)
        fputc(toupper((unsigned char)*c), out);
    fputc('\n', out);
}

/* A paragraph with a bold tag. */
static void put_tagged(FILE *out, const char *tag, const char *text)
{
    fputs(".TP\n\\fB", out);
    put(out, tag);
    fputs("\\fR\n", out);
    put(out, text);
    fputc('\n', out);
}

static void put_option(FILE *out, const struct option *option)
{
    fputs(".TP\n", out);
    if (option->letter)
        fprintf(out, "\\fB\\-%c\\fR, ", option->letter);
    fputs("\\fB\\-\\-", out);
    put(out, option->name);
    fputs("\\fR", out);
    if (option->placeholder) {
        fputs(option->value_may_go ? "[=\\fI" : " \\fI", out);
        put(out, option->placeholder);
        fputs(option->value_may_go ? "\\fR]" : "\\fR", out);
    }
    fputc('\n', out);
    put(out, option->help);
    if (option->repeats)
        fputs("\nMay be given several times.", out);
    if (option->fallback) {
        fputs("\nDefault: ", out);
        put(out, option->fallback);
        fputc('.', out);
    }
    fputc('\n', out);
}

static void put_command(FILE *out, const struct command *command)
{
    fprintf(out, ".SS kiln %s [\\fIOPTION...\\fR] \\fI%s\\fR\n", command->name, command->operands);
    put(out, command->description);
    fputc('\n', out);
    for (size_t i = 0; i < command->option_count; i++)
        put_option(out, &command->options[i]);
}

static void put_example(FILE *out, const char *what, const char *command)
{
    put(out, what);
    fputs("\n.PP\n.RS\n", out);
    put(out, command);
    fputs("\n.RE\n.PP\n", out);
}

void man_print(FILE *out)
{
    fprintf(out, ".TH KILN 1 \"\" \"kiln %s\" \"User Commands\"\n", KILN_VERSION);
    put_heading(out, "name");
    fputs("kiln \\- render particle effects without a display\n", out);
    put_heading(out, "synopsis");
    fputs(".B kiln\n\\fICOMMAND\\fR [\\fIOPTION...\\fR] [\\fIOPERAND...\\fR]\n", out);
    put_heading(out, "description");
    put(out, "Reads a scene file, steps a particle simulation at a fixed timestep and renders each "
             "frame into images or a video, on a machine with no display and perhaps no GPU. The "
             "same scene gives the same simulation on every device.\n\n"
             "Options and operands may come in any order; '--' ends the options. A value follows "
             "its option or is joined to it by '='. Of an option that is given twice the last one "
             "counts, where it does not say that it may be given several times.\n");
    put_heading(out, "commands");
    for (size_t i = 0; commands[i]; i++)
        put_command(out, commands[i]);
    put_heading(out, "exit status");
    for (const struct exit_code *row = exit_codes; row->code; row++)
        put_tagged(out, row->code, row->meaning);
    put_heading(out, "environment");
    for (const struct variable *row = variables; row->name; row++)
        put_tagged(out, row->name, row->meaning);
    put_heading(out, "examples");
    put_example(out, "A video of a whole scene:", "kiln render fire_beam.yaml -o fire.mp4");
    put_example(out, "Two stills at another size:",
                "kiln render fire_beam.yaml -o still_%04d.png --frames 60,120 --size 640x360");
    put_example(out, "A queue of scenes with progress for a program:",
                "kiln render a.yaml b.yaml -o '{scene}.mp4' --progress ndjson");
    put_example(out, "A folder of pictures against another one, with pictures of the differences:",
                "kiln compare golden/ out/ --diff differences/");
    put_example(out,
                "Golden-image tests of all scenes in a folder, with the first goldens written:",
                "kiln test scenes/ --update missing");
    put_example(out, "The same in continuous integration, with a report for its pages:",
                "kiln test scenes/ --junit out/junit.xml");
    put_example(out, "A picture that has changed is right:", "kiln test approve fire_beam");
    put_heading(out, "see also");
    put(out, "kiln help scene: every key of a scene file.\n");
    put(out, "kiln help tests: every key of a test file.\n");
}
