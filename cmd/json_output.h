/* Opens and closes where a command writes its result for other programs (--json[=FILE]): standard
 * output, in place of the text for people, or a file. */
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

/* The file of --json; NULL where there is none. */
const char *json_output_path(const struct arguments *arguments);

/* Opens what --json asks for; a file that exists is replaced where the command has --force and that
 * is given. *out is NULL where nothing is asked for. Returns 0, or the exit code after reporting:
 * --events excludes it. */
int json_output_open(const char *command, const struct arguments *arguments, FILE **out);

/* Refuses a file of --json that the scene is made of, or that --output writes. Returns 0, or the
 * exit code after reporting. */
int json_output_claim(const struct arguments *arguments, const struct kiln_scene *scene);

/* Begins the object of a command that has only one: the event `result`, or the document of --json
 * in `out`. False where neither is asked for; json_output_end ends the object. */
bool json_output_begin(struct kiln_json *json, FILE *out);
void json_output_end(struct kiln_json *json);

/* Gives the file its name if the command has a result, and removes it if the command failed.
 * Returns the exit code. */
int json_output_close(int code);

#endif
