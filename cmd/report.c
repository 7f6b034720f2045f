/* Prints a command's errors and warnings on standard error, one line each, and writes them to the
 * stream of --events. Commands call report or report_error where they fail and return its code,
 * which becomes the exit code. main.c calls report_finish last of all, for every command.
 *
 * A message starts with "kiln: ", which batch.c removes from the lines of its jobs. The exception
 * is a message about an input file, which starts with the file's name, and line and column where
 * they are known: editors look for these at the start of a line. Text from files may hold control
 * characters, so it passes through kiln_shown before it is printed; the library's own messages have
 * passed through it already. */
#include "report.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "event.h"
#include "signals.h"

int report(enum kiln_code code, const char *format, ...)
{
    char text[KILN_MESSAGE_SIZE], message[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    kiln_shown(message, sizeof message, text);
    fprintf(stderr, "kiln: %s\n", message);
    event_error((int)code, message);
    return (int)code;
}

/* Prints a message that starts with an input file's name and place, without "kiln: " before it. */
static int report_place(const struct kiln_error *error)
{
    fprintf(stderr, "%s\n", error->message);
    event_error((int)error->code, error->message);
    return (int)error->code;
}

/* Returns the least level of messages that are printed, by KILN_LOG. */
static enum kiln_log_level least_level(void)
{
    const char *level = kiln_environment("KILN_LOG");
    if (level && strcmp(level, "debug") == 0)
        return KILN_LOG_DEBUG;
    return level && strcmp(level, "info") == 0 ? KILN_LOG_INFO : KILN_LOG_WARNING;
}

static void report_origin(const struct kiln_error *error)
{
    if (error->file && least_level() == KILN_LOG_DEBUG)
        fprintf(stderr, "kiln: debug: the next error is of %s:%d\n", error->file, error->line);
}

int report_error(const struct kiln_error *error)
{
    report_origin(error);
    if (error->code == KILN_INTERRUPTED)
        return signals_report("loading a scene", "%s", "");
    if (error->code != KILN_INVALID_INPUT)
        return report(error->code, "%s", error->message);
    return report_place(error);
}

int report_scene_error(const struct kiln_error *error)
{
    if (error->code != KILN_OVER_LIMIT)
        return report_error(error);
    report_origin(error);
    return report_place(error);
}

int report_no_memory(void)
{
    return report(KILN_DEVICE_FAILED, "out of memory");
}

static void write_log(void *user, enum kiln_log_level level, const char *line)
{
    (void)user;
    static const char *const names[] = {"debug", "info", "warning"};
    if (level < least_level())
        return;
    fprintf(stderr, "kiln: %s: %s\n", names[level], line);
    if (level == KILN_LOG_WARNING)
        event_warning(line);
}

void report_deprecated(const char *command, const char *old, const char *replacement)
{
    char line[KILN_MESSAGE_SIZE];
    snprintf(line, sizeof line,
             "%s: %s is an older spelling of %s, and version 0.3 will not know it", command, old,
             replacement);
    write_log(NULL, KILN_LOG_WARNING, line);
}

void print_name(const char *name)
{
    char shown[KILN_PATH_SIZE];
    kiln_shown(shown, sizeof shown, name);
    printf("%s", shown);
}

struct kiln_log report_log(void)
{
    return (struct kiln_log){.write = write_log};
}

int report_finish(int code)
{
    bool failed = ferror(stdout) != 0 || events_failed_on_stdout();
    if (fflush(stdout) == 0 && !failed)
        return code;
    /* A stream remembers that it failed, but not why. One more write fails for the same reason and
     * sets errno to it. */
    errno = EIO;
    ssize_t again = write(STDOUT_FILENO, "\n", 1);
    if (again < 0 && errno == EPIPE && code == KILN_READER_GONE)
        return report(KILN_READER_GONE, "standard output: the reader went away: stopped");
    if (again < 0 && errno == EPIPE)
        return code && code != KILN_IO ? code : KILN_READER_GONE;
    int reported = report(KILN_IO, "standard output: %s", strerror(errno));
    return code && code != KILN_READER_GONE ? code : reported;
}
