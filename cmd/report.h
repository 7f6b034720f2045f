/* Prints messages for the user, one line each, on standard error. */
#ifndef KILN_CMD_REPORT_H
#define KILN_CMD_REPORT_H

#include "kiln_program.h"

/* Prints "kiln: " and the message; returns the code, so that a command can return it. */
int report(enum kiln_code code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reports an error of the library and returns its exit code. After a stop by a signal, the message
 * names the signal. Invalid input starts with its own file, line and column, where editors look for
 * them, so nothing is put before it. */
int report_error(const struct kiln_error *error);

/* Reports why a scene does not load, as report_error does. A scene over a limit has a place, too,
 * so nothing is put before it. */
int report_scene_error(const struct kiln_error *error);

int report_no_memory(void);

/* Warns that `old` is an older spelling of `replacement`, which the next version will not accept.
 */
void report_deprecated(const char *command, const char *old, const char *replacement);

/* Prints the name of a file on standard output, with control characters escaped. */
void print_name(const char *name);

/* Returns a log that prints the library's warnings; its other messages are dropped. */
struct kiln_log report_log(void);

/* Flushes standard output and returns the exit code of the program. A failure to write is reported
 * and becomes the exit code, unless the program has one already. A reader that went away (`kiln
 * help scene | head`) gets no message, unless that ended a job: a command whose job ended so
 * returns KILN_READER_GONE, whatever the failure was. */
int report_finish(int code);

#endif
