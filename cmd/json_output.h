/* What a command tells other programs of its result (--json[=FILE]): on standard output in place of
 * the text for people, or beside it in a file. */
#ifndef KILN_CMD_JSON_OUTPUT_H
#define KILN_CMD_JSON_OUTPUT_H

#include "command.h"

/* `what` says what is printed: "an object", "an object a line: ...". */
#define JSON_OPTION(what)                                                                          \
    {                                                                                              \
        .name = "json", .value_may_go = true, .kind = OPTION_TEXT, .placeholder = "FILE",          \
        .files = "*.json", .reach = REACH_WRITE,                                                   \
        .help = "Print JSON instead of text, or also write it into FILE: " what                    \
    }

/* Opens what --json asks for; a file that exists is replaced where the command has --force and that
 * is given. *out is NULL where nothing is asked for. Returns 0, or the exit code after reporting.
 */
int json_output_open(const struct arguments *arguments, FILE **out);

/* Gives the file its name, if the command came to a result; of one that failed nothing is left.
 * Returns the exit code. */
int json_output_close(int code);

#endif
