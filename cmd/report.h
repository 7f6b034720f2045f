/* Prints messages to the person: one line each, on standard error. */
#ifndef KILN_CMD_REPORT_H
#define KILN_CMD_REPORT_H

#include "kiln_program.h"

/* Prints "kiln: " and the message; returns the code, so that a command can return it. */
int report(enum kiln_code code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reports an error of the library; a signal that stopped it is named. Invalid input starts
 * with its own file, line and column, where editors look for them, so nothing is put before it. */
int report_error(const struct kiln_error *error);

/* Reports, as report_error, why a scene does not load: one that asks for too much has a place, too.
 */
int report_scene_error(const struct kiln_error *error);

int report_no_memory(void);

/* Prints that a spelling of an option is an older one, which the next version will not know. */
void report_older(const char *command, const char *old, const char *now);

/* Prints the name of a file on standard output, as it may be shown. */
void print_name(const char *name);

/* Prints the library's warnings; what it says for information is left out. */
struct kiln_log report_log(void);

/* Ends standard output: its failure is an error of the program, unless that has one already. A
 * reader that went away (`kiln help scene | head`) is no news to anyone and gets no message, but
 * where it ended a job: such a command returns KILN_READER_GONE, whatever the failure was. */
int report_finish(int code);

#endif
