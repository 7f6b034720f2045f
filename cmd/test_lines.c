/* Prints the lines of kiln test. Colours repeat what the words say, so the lines are complete
 * without them. */
#include "test_lines.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "test_files.h"
#include "test_select.h"

enum { MAX_NAME_WIDTH = 40, STATUS_WIDTH = 6 };

static const char *colour_of(enum kiln_test_status status)
{
    switch (status) {
    case KILN_TEST_PASS:
        return "\033[32m"; /* green */
    case KILN_TEST_SKIP:
        return "\033[2m"; /* faint */
    case KILN_TEST_WARN:
    case KILN_TEST_CHANGE:
    case KILN_TEST_NEW:
        return "\033[33m"; /* yellow */
    default:
        return "\033[1;31m"; /* bold red */
    }
}

static bool wants_colour(FILE *out)
{
    const char *term = kiln_environment("TERM"), *refused = kiln_environment("NO_COLOR");
    return isatty(fileno(out)) == 1 && term && strcmp(term, "dumb") != 0 && !refused;
}

/* Prints a text out of a result, which the process of a test has written. */
static void print_text(FILE *out, const char *text)
{
    char shown[2 * KILN_MESSAGE_SIZE];
    kiln_shown(shown, sizeof shown, text);
    fputs(shown, out);
}

/* Counts the bytes of UTF-8 that continue a character, since they take no column. */
static int count_continuation_bytes(const char *name)
{
    int count = 0;
    for (; *name; name++)
        count += ((unsigned char)*name & 0xc0) == 0x80;
    return count;
}

void test_lines_start(struct test_lines *lines, const struct kiln_suite *suite, FILE *out)
{
    lines->suite = suite;
    lines->out = out;
    lines->colour = wants_colour(out);
    for (size_t i = 0; i < kiln_suite_count(suite); i++) {
        const char *name = kiln_suite_test(suite, i).name;
        int width = (int)strlen(name) - count_continuation_bytes(name);
        if (width > lines->name_width)
            lines->name_width = width < MAX_NAME_WIDTH ? width : MAX_NAME_WIDTH;
    }
}

static bool is_failure(enum kiln_test_status status)
{
    return status == KILN_TEST_NEW || status == KILN_TEST_FAIL || status == KILN_TEST_ERROR;
}

static void print_notes(struct test_lines *lines, const struct kiln_suite *suite, size_t index,
                        const struct kiln_test_summary *summary, bool silent)
{
    for (uint32_t i = 0; i < summary->notes; i++) {
        char text[KILN_MESSAGE_SIZE];
        struct kiln_error error = {0};
        if (!kiln_test_read_note(suite, index, i, text, &error))
            return;
        lines->written += strncmp(text, "wrote ", 6) == 0;
        lines->to_write += strncmp(text, "would write ", 12) == 0;
        if (!silent) {
            fprintf(lines->out, "%*s", STATUS_WIDTH + 2, "");
            print_text(lines->out, text);
            fputc('\n', lines->out);
        }
    }
}

/* Prints where the output of a test's process is, if it has any. */
static void print_log_place(const struct test_lines *lines, const char *results)
{
    char path[KILN_PATH_SIZE], line[LOG_LINE_SIZE];
    snprintf(path, sizeof path, "%s/log.txt", results);
    if (!*last_log_line(path, line))
        return;
    fprintf(lines->out, "%*slog: ", STATUS_WIDTH + 2, "");
    print_text(lines->out, path);
    fputc('\n', lines->out);
}

void test_lines_test(struct test_lines *lines, const struct kiln_suite *suite, size_t index,
                     const struct kiln_test_summary *summary)
{
    bool failed = is_failure(summary->status), silent = lines->quiet && !failed;
    if (!silent) {
        const char *name = kiln_suite_test(suite, index).name;
        fprintf(lines->out, "%s%-*s%s  %-*s ", lines->colour ? colour_of(summary->status) : "",
                STATUS_WIDTH, kiln_test_status_name(summary->status),
                lines->colour ? "\033[0m" : "", lines->name_width + count_continuation_bytes(name),
                name);
        if (summary->frames > 0)
            fprintf(lines->out, " %u frame%s in %.3f s", summary->frames,
                    summary->frames == 1 ? "" : "s", summary->total_s);
        if (summary->message[0]) {
            fputs(summary->frames > 0 ? ": " : " ", lines->out);
            print_text(lines->out, summary->message);
        }
        fputc('\n', lines->out);
    }
    print_notes(lines, suite, index, summary, silent);
    if (summary->status == KILN_TEST_ERROR)
        print_log_place(lines, kiln_suite_test(suite, index).results);
    if (summary->status >= KILN_TEST_CHANGE && summary->status <= KILN_TEST_FAIL) {
        lines->approvable = kiln_suite_test(suite, index).name;
        lines->approvable_count++;
    }
    fflush(lines->out);
}

void test_lines_counts(FILE *out, const struct kiln_results_summary *summary)
{
    fprintf(out, "%u test%s in %.3f s:", summary->tests, summary->tests == 1 ? "" : "s",
            summary->total_s);
    const char *separator = "";
    for (int i = 0; i < KILN_TEST_STATUS_COUNT; i++) {
        if (summary->counts[i] == 0)
            continue;
        fprintf(out, "%s %u %s", separator, summary->counts[i],
                kiln_test_status_name((enum kiln_test_status)i));
        separator = ",";
    }
    fputc('\n', out);
}

/* Prints the paths in which tests were looked for, if they were given; approve looks for them
 * there, too. */
static void print_paths(const struct test_lines *lines)
{
    for (size_t i = 0; i < lines->arguments->operand_count; i++) {
        const char *operand = lines->arguments->operands[i];
        if (!operand_is_path(operand))
            continue;
        fprintf(lines->out, *operand == '-' ? " ./" : " ");
        kiln_write_shell_word(lines->out, operand);
    }
}

static void print_folder(const struct test_lines *lines, const char *option, const char *fallback)
{
    const char *folder = arguments_text(lines->arguments, option, fallback);
    if (strcmp(folder, fallback) == 0)
        return;
    fprintf(lines->out, " --%s ", option);
    kiln_write_shell_word(lines->out, folder);
}

/* Prints the command that accepts the pictures of the one test to accept, or of all tests. */
static void print_approval(const struct test_lines *lines)
{
    FILE *out = lines->out;
    if (lines->approvable_count == 0)
        return;
    fprintf(out, "where the pictures are right, accept them: kiln test approve ");
    if (lines->approvable_count > 1)
        fprintf(out, "--all");
    else
        kiln_write_shell_word(out, lines->approvable);
    print_paths(lines);
    print_folder(lines, "results", DEFAULT_RESULTS);
    print_folder(lines, "golden", kiln_suite_defaults().golden);
    fputc('\n', out);
}

static void print_unused(const struct test_lines *lines)
{
    enum { SHOWN = 5 };
    size_t count = 0;
    const char *const *paths = kiln_suite_unused(lines->suite, &count);
    for (size_t i = 0; i < count && i < SHOWN; i++) {
        char path[KILN_MESSAGE_SIZE];
        kiln_shown(path, sizeof path, paths[i]);
        fprintf(lines->out, "%s: no test uses these goldens; perhaps a test was renamed or lost\n",
                path);
    }
    if (count > SHOWN)
        fprintf(lines->out, "and %zu more folders of goldens that no test uses\n", count - SHOWN);
}

void test_lines_end(const struct test_lines *lines, const struct kiln_results_summary *summary,
                    const char *page)
{
    if (page) {
        fprintf(lines->out, "report: ");
        print_text(lines->out, page);
        fputc('\n', lines->out);
    }
    if (lines->written > 0)
        fprintf(lines->out, "%u picture%s written: look at %s before you keep %s\n", lines->written,
                lines->written == 1 ? " was" : "s were", lines->written == 1 ? "it" : "them",
                lines->written == 1 ? "it" : "them");
    if (lines->to_write > 0)
        fprintf(lines->out, "%u picture%s would be written; this was a dry run\n", lines->to_write,
                lines->to_write == 1 ? "" : "s");
    print_unused(lines);
    print_approval(lines);
    if (summary->tests > 0) {
        kiln_write_frames(lines->out, summary);
        fputc('\n', lines->out);
    }
}
