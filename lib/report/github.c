/* Writes the report of a run as workflow commands of GitHub's runners: lines on standard output
 * that become annotations.
 *
 * report.c lists kiln_report_github in its table of formats, and calls write_github after the run
 * when `kiln test` or `kiln test report` was given --github. GitHub shows a limited number of
 * annotations of a step, so the errors must come first (tests that fail, break or lack a golden),
 * then the warnings, then the summary. Titles may be reworded. Texts of results come from scenes
 * and goldens, which others may have written. So each of them must be written escaped, or a line
 * end in it would start a command of its own. */
#include <string.h>

#include "base/marker.h"
#include "base/shown.h"
#include "report/text.h"

/* Writes a character with those in `special` escaped as GitHub reads them (%0A), and others that
 * would act on the text around them as the program shows them ("\x1b"). Returns its bytes. */
static size_t write_character(FILE *out, const char *text, const void *special)
{
    uint32_t character;
    char escaped[12];
    const size_t length = kiln_shown_character(text, &character);
    if (strchr(special, *text))
        fprintf(out, "%%%02X", (unsigned char)*text);
    else if (length == 0 || (kiln_shown_needs_escape(character) && *text != '\t')) {
        kiln_shown_escape(character, length == 0, escaped);
        fputs(escaped, out);
    } else
        fwrite(text, 1, length, out);
    return length > 0 ? length : 1;
}

static void write_message(FILE *out, const char *text)
{
    kiln_marker_write(out, text, write_character, "%\r\n");
}

/* Writes a text of a property, which ':' and ',' would end. */
static void write_property(FILE *out, const char *text)
{
    kiln_marker_write(out, text, write_character, "%\r\n:,");
}

/* Writes the command up to its message, with the file that the annotation is for; file is "" where
 * there is none. */
static void open_command(FILE *out, const char *command, const char *file, const char *title,
                         const char *name)
{
    fprintf(out, "::%s ", command);
    if (*file) {
        fputs("file=", out);
        write_property(out, file);
        fputs(",", out);
    }
    fputs("title=", out);
    write_property(out, title);
    write_property(out, name);
    fputs("::", out);
}

static const char *title_of(enum kiln_test_status status)
{
    switch (status) {
    case KILN_TEST_FAIL:
        return "Golden image differs: ";
    case KILN_TEST_NEW:
        return "Golden image is missing: ";
    case KILN_TEST_CHANGE:
        return "Golden image has other pixels: ";
    case KILN_TEST_WARN:
        return "Golden image is close to its limits: ";
    default:
        return "Golden image test broke: ";
    }
}

static void write_test(FILE *out, const struct kiln_result *result, const char *command)
{
    open_command(out, command, result->test, title_of(result->status), result->name);
    write_message(out, result->message);
    if (*result->rerun) {
        write_message(out, "\nto run it again: ");
        write_message(out, result->rerun);
    }
    if (*result->approve && result->status != KILN_TEST_ERROR) {
        write_message(out, "\nto accept it: ");
        write_message(out, result->approve);
    }
    fputs("\n", out);
}

/* Writes the notes of stale limits as warnings. */
static void write_stale_notes(FILE *out, const struct kiln_result *result)
{
    for (size_t i = 0; i < result->note_count; i++) {
        if (!strstr(result->notes[i], KILN_NOTE_STALE))
            continue;
        open_command(out, "warning", result->test, "Stale limit: ", result->name);
        write_message(out, result->notes[i]);
        fputs("\n", out);
    }
}

static bool write_github(const struct kiln_results *results,
                         const struct kiln_results_output *output, FILE *out,
                         struct kiln_error *error)
{
    (void)output;
    (void)error;
    for (size_t i = 0; i < results->count; i++) {
        if (results->tests[i]->status >= KILN_TEST_NEW)
            write_test(out, results->tests[i], "error");
    }
    for (size_t i = 0; i < results->count; i++) {
        if (results->tests[i]->status == KILN_TEST_WARN ||
            results->tests[i]->status == KILN_TEST_CHANGE)
            write_test(out, results->tests[i], "warning");
        write_stale_notes(out, results->tests[i]);
    }
    char summary[256];
    kiln_report_text_summary(summary, results);
    open_command(out, "notice", "", "kiln test", "");
    write_message(out, summary);
    fputs("\n", out);
    return true;
}

const struct kiln_report_format kiln_report_github = {
    .name = "github",
    .help = "annotations for GitHub Actions, which reads them from standard output",
    .option = "--github",
    .write = write_github,
};
