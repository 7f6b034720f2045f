/* Writes the events of --events: lines by which another program follows a command from its start to
 * its exit code. event_table.c lists the JSON events and their members. The form `openjd` writes
 * lines of Open Job Description instead: progress, status and failure. */
#ifndef KILN_CMD_EVENT_H
#define KILN_CMD_EVENT_H

#include "command.h"

#define EVENTS_OPTION                                                                              \
    {                                                                                              \
        .name = "events", .kind = OPTION_TEXT, .placeholder = "STREAM",                            \
        .help = "Tell other programs how the command goes, in lines of JSON: 'ndjson' on "         \
                "standard output, 'ndjson:FILE' at the end of a file, 'ndjson:fd=N' to an open "   \
                "descriptor. 'openjd' instead of 'ndjson' writes lines of Open Job Description "   \
                "(see 'kiln help events')."                                                        \
    }

/* Opens the stream of --events, if the option is given, and writes the event `started`. Call it
 * before the sandbox is entered, since a file of events may lie outside. Returns 0, or the exit
 * code after reporting. */
int events_open(const struct command *command, const struct arguments *arguments);

/* Opens the stream of --json for render, bake and compare. Its events have no time, and `started`,
 * `loaded`, `warning`, `error` and `ended` are left out. Returns 0, or the exit code after
 * reporting; --json and --events exclude each other. */
int events_open_json(const char *command, const struct arguments *arguments);

/* Opens the stream of --json on standard output for the older spellings `render --progress ndjson`
 * and `render --stats=json`. Does nothing if a stream is open. */
void events_open_plain(void);

/* Return whether --events is in use; whether JSON is written, for --events or --json; and whether
 * it is written to standard output, so that nothing else may be printed there. */
bool events_are_wanted(void);
bool events_are_open(void);
bool events_use_stdout(void);

/* Returns whether writing to the stream has failed: nobody reads it any more, or a disk is full. */
bool events_failed(void);
bool events_failed_on_stdout(void); /* of standard output, after events_close */

/* Begins an event. The caller may add members until it calls event_end, which ends the line and
 * flushes it; other threads wait in between. Without a stream, nothing is written. */
struct kiln_json event_begin(const char *name);
void event_end(struct kiln_json *json);

/* Adds the members `file`, `line` and `column` if a message begins with a place, FILE:LINE:COLUMN.
 */
void event_add_place(struct kiln_json *json, const char *message);

/* Writes the line "openjd_KEYWORD: ..." if the stream has the form `openjd`; else does nothing. */
void event_openjd(const char *keyword, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Writes how much of a command is done, in whole percent and each number once, if the stream has
 * the form `openjd`. 100 is written with the exit code, when all files are whole. */
void event_progress(uint64_t done, uint64_t total, const char *status);

/* Write the events `error`, with its place if the message begins with one, `warning` and `loaded`,
 * for a scene. They do nothing without --events. */
void event_error(int code, const char *message);
void event_warning(const char *message);
void event_loaded(const char *scene, const struct kiln_scene_info *info);

/* Writes the error and the end from a signal handler, or while another thread hangs. It writes
 * nothing if the stream would block, or in a forked process. */
void events_write_final(const char *message, int code);

/* Writes the exit code, and before it an event `result` if the command finished without one, and
 * closes the stream. Returns the exit code, or that of a failed stream. */
int events_close(int code);

/* Write the list of events for people, and the JSON schema of events. Return false when writing
 * failed. */
bool help_write_events(FILE *out);
bool help_write_events_schema(FILE *out);

#endif
