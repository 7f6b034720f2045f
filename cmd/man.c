/* Writes the manual pages kiln(1) and kiln-scene(5), in the man macros of roff. cmd/help.c calls
 * the functions for `kiln help man` and `kiln help man-scene`; the build runs both to make the
 * pages that are installed (docs/CMakeLists.txt).
 *
 * Commands, options, exit codes, variables and the keys of scenes come from the tables that --help
 * and the readers use, so a new one appears here by itself. Only the description, the files and the
 * examples are written here. The pages have no date, so that the same kiln always writes the same
 * page. The linters of tests/docs/man.sh check the pages. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

/* Writes text so that roff prints it as it stands; an empty line in it begins a paragraph. In roff,
 * a line that begins with '.' or an apostrophe is a request, so \& goes before these. */
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

/* Writes a text of paragraphs. Lines that begin with a blank, such as examples, are not filled. A
 * line is cut after 511 bytes. */
static void put_text(FILE *out, const char *text)
{
    bool verbatim = false, parted = false, at_start = true;
    for (; *text; at_start = false) {
        size_t length = strcspn(text, "\n");
        char line[512];
        snprintf(line, sizeof line, "%.*s", (int)length, text);
        text += length + (text[length] == '\n');
        if (length == 0) {
            parted = true;
            continue;
        }
        bool changes = verbatim != (*line == ' ');
        if (changes && verbatim)
            fputs(".fi\n", out);
        if ((changes || parted) && !at_start)
            fputs(".PP\n", out);
        if (changes && !verbatim)
            fputs(".nf\n", out);
        verbatim = *line == ' ';
        parted = false;
        put(out, line);
        fputc('\n', out);
    }
    if (verbatim)
        fputs(".fi\n", out);
}

/* Writes a section that has the text of a topic of `kiln help`. Returns false when memory is
 * short. */
static bool put_topic(FILE *out, const char *title, bool (*write)(FILE *out))
{
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    bool ok = memory && write(memory);
    ok = memory && fclose(memory) == 0 && ok;
    if (ok) {
        put_heading(out, title);
        put_text(out, text);
    }
    free(text);
    return ok;
}

/* Writes a paragraph with a bold tag. */
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
        fputs(option->value_is_optional ? "[=\\fI" : " \\fI", out);
        put(out, option->placeholder);
        fputs(option->value_is_optional ? "\\fR]" : "\\fR", out);
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
    fprintf(out, ".SS kiln %s [\\fIOPTION...\\fR]", command->name);
    if (*command->operands)
        fprintf(out, " \\fI%s\\fR", command->operands);
    fputc('\n', out);
    put(out, command->description);
    fputc('\n', out);
    for (size_t i = 0; i < command->option_count; i++)
        put_option(out, &command->options[i]);
}

static void put_examples(FILE *out)
{
    static const struct {
        const char *what, *command;
    } rows[] = {
        {"Start from a scene, which is then edited:", "kiln new effect.yaml"},
        {"Render a video of a whole scene:", "kiln render fire_beam.yaml -o fire.mp4"},
        {"Render two stills at another size:",
         "kiln render fire_beam.yaml -o still_%04d.png --frames 60,120 --size 640x360"},
        {"Render several scenes, go on after a failure, and write events for a program:",
         "kiln render a.yaml b.yaml -o '{scene}.mp4' --keep-going --events ndjson"},
        {"Compare a folder of pictures with another one, and write pictures of the differences:",
         "kiln compare golden/ out/ --diff differences/"},
        {"Run golden-image tests of all scenes in a folder, and write the first goldens:",
         "kiln test scenes/ --update missing"},
        {"Run the tests in continuous integration, with a report for its pages:",
         "kiln test scenes/ --junit out/junit.xml"},
        {"Accept a picture that has rightly changed:", "kiln test approve fire_beam"},
        {"Draw four jets side by side, with labels, for a document:",
         "kiln figure sheet fire_beam.yaml -o sizes.png --sweep "
         "'systems.*.emit.rate=5,25,200,2000'"},
    };
    put_heading(out, "examples");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (i > 0)
            fputs(".PP\n", out);
        put(out, rows[i].what);
        fputs("\n.PP\n.RS\n.nf\n", out);
        put(out, rows[i].command);
        fputs("\n.fi\n.RE\n", out);
    }
}

/* Writes the section FILES: paths that matter, and what they are. */
static void put_files(FILE *out)
{
    put_heading(out, "files");
    put_tagged(out, "golden/",
               "Pictures that 'kiln test' compares with, and expect.yaml, the hashes and limits of "
               "a test. --golden chooses another folder.");
    put_tagged(out, "out/test/",
               "Results of 'kiln test': report.html, run.json, and for each test result.json, "
               "pictures and log.txt. --results chooses another folder.");
    put_tagged(out, "NAME.test.yaml", "A test: see 'kiln help tests'.");
    put_tagged(out, "share/kiln/scenes/",
               "Scenes to begin with, below the prefix of the "
               "installation.");
}

bool man_print(FILE *out)
{
    fprintf(out, ".TH KILN 1 \"\" \"kiln %s\" \"User Commands\"\n", KILN_VERSION);
    put_heading(out, "name");
    fputs("kiln \\- render particle effects without a display\n", out);
    put_heading(out, "synopsis");
    fputs(".B kiln\n\\fICOMMAND\\fR [\\fIOPTION...\\fR] [\\fIOPERAND...\\fR]\n", out);
    put_heading(out, "description");
    put(out, "Reads a scene file, steps a particle simulation at a fixed timestep and renders each "
             "frame into images or a video, on a machine with no display and perhaps no GPU. The "
             "same scene gives the same simulation on every device.\n"
             "\n"
             "Options and operands may come in any order; '--' ends the options. A value follows "
             "its option, or '=' joins it to the option. Letters may share one dash, as in '-qo "
             "r.png'. If an option is given twice, the last one counts, unless its help says that "
             "it may be given several times.\n");
    put_heading(out, "commands");
    for (size_t i = 0; commands[i]; i++)
        put_command(out, commands[i]);
    bool ok = put_topic(out, "outputs", kiln_write_outputs) &&
              put_topic(out, "templates", kiln_write_templates) &&
              put_topic(out, "techniques", kiln_write_techniques) &&
              put_topic(out, "metrics", kiln_write_metrics) &&
              put_topic(out, "test files", kiln_test_write_reference) &&
              put_topic(out, "reports", kiln_write_reports) &&
              put_topic(out, "completion", help_write_completion);
    put_heading(out, "exit status");
    for (const struct exit_code *row = exit_codes; row->meaning; row++) {
        char code[16];
        snprintf(code, sizeof code, "%d", row->code);
        put_tagged(out, code, row->meaning);
    }
    put_heading(out, "environment");
    for (const struct variable *row = variables; row->name; row++)
        put_tagged(out, row->name, row->meaning);
    put_files(out);
    put_examples(out);
    put_heading(out, "see also");
    fputs(".BR kiln\\-scene (5)\n", out);
    return ok;
}

/* ---- kiln-scene(5) -------------------------------------------------------------------------- */

/* Writes a line of its own below the help of a key. */
static void put_line(FILE *out, const char *label, const char *text)
{
    fputs(".br\n", out);
    put(out, label);
    put(out, text);
    fputc('\n', out);
}

/* Writes the paragraph of a key of scene files; kiln_scene_visit_keys calls it for each key. */
static void put_key(void *user, const struct kiln_option_key *key)
{
    FILE *out = user;
    fputs(".TP\n\\fB", out);
    put(out, key->path);
    fputs("\\fR", out);
    if (key->variant) {
        fputs(" with field: ", out);
        put(out, key->variant);
    }
    fputc('\n', out);
    put(out, key->help);
    fputc('\n', out);
    if (key->shortcut)
        put_line(out, "A bare value is that of ", key->shortcut);
    if (key->allowed)
        put_line(out, "", key->allowed);
    if (key->varies)
        put_line(out, "may vary ", key->varies);
    if (key->fallback)
        put_line(out, "default: ", key->fallback);
    else if (key->allowed)
        put_line(out, "must be given", "");
}

bool man_print_scene(FILE *out)
{
    fprintf(out, ".TH KILN\\-SCENE 5 \"\" \"kiln %s\" \"File Formats\"\n", KILN_VERSION);
    put_heading(out, "name");
    fputs("kiln\\-scene \\- scene files of kiln\n", out);
    put_heading(out, "description");
    put_text(out, kiln_scene_introduction());
    put_heading(out, "keys");
    bool ok = kiln_scene_visit_keys(put_key, out);
    put_heading(out, "see also");
    fputs(".BR kiln (1)\n", out);
    return ok;
}
