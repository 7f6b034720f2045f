/* Opens and closes the output of --json[=FILE], to which a command writes its result for other
 * programs: standard output, in place of the text for people, or a file. */
#ifndef KILN_CMD_JSON_OUTPUT_H
#define KILN_CMD_JSON_OUTPUT_H

#include "command.h"

/* `what` completes the help text: "an object", "an object a line: ...". */
#define JSON_OPTION(what)                                                                          \
    {                                                                                              \
        .name = "json", .value_is_optional = true, .kind = OPTION_TEXT, .placeholder = "FILE",     \
        .files = "*.json", .access = ACCESS_WRITE,                                                 \
        .help = "Print JSON instead of text, or also write it into FILE: " what                    \
    }

/* Returns the file that --json names; NULL if it names none. */
const char *json_output_path(const struct arguments *arguments);

/* Opens the output of --json; *out is NULL if --json is not given. With --force, a file that exists
 * is replaced. Returns 0, or the exit code after reporting; --json and --events exclude each other.
 */
int json_output_open(const char *command, const struct arguments *arguments, FILE **out);

/* Refuses a file of --json that the scene reads or that --output writes. Returns 0, or the exit
 * code after reporting. */
int json_output_claim(const struct arguments *arguments, const struct kiln_scene *scene);

/* Begins the object of a command that prints only one: the event `result` with --events, or the
 * document of --json in `out`. Returns false if neither is asked for. json_output_end ends the
 * object. */
bool json_output_begin(struct kiln_json *json, FILE *out);
void json_output_end(struct kiln_json *json);

/* Closes the file of --json. The file gets its name if the command has a result, and is removed if
 * the command failed. Returns the exit code. */
int json_output_close(int code);

#endif
