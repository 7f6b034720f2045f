/* Events for other programs (--events): one stream of lines that tells how a command goes, from its
 * start to its exit code. Which events of JSON there are, and their members: event_table.c. The
 * form `openjd` has lines of Open Job Description instead: progress, status and failure. */
#ifndef KILN_CMD_EVENT_H
#define KILN_CMD_EVENT_H

#include "command.h"

#define EVENTS_OPTION                                                                              \
    {                                                                                              \
        .name = "events", .kind = OPTION_TEXT, .placeholder = "STREAM",                            \
        .help = "Tell other programs how the command goes, by lines of JSON: 'ndjson' on "         \
                "standard output, 'ndjson:FILE' at the end of a file, 'ndjson:fd=N' to an open "   \
                "descriptor. 'openjd' instead of 'ndjson': by lines of Open Job Description "      \
                "(see 'kiln help events')."                                                        \
    }

/* Opens the stream that --events asks for, if it does, and tells that the command has started.
 * Returns 0, or the exit code after reporting. Before the process confines itself. */
int events_open(const struct command *command, const struct arguments *arguments);

/* Opens the stream of events that --json of render, bake and compare prints: without times, and
 * only those of the result. Returns 0, or the exit code after reporting: --events excludes it. */
int events_open_json(const char *command, const struct arguments *arguments);

/* Opens the stream of --json on standard output for the older spellings `render --progress ndjson`
 * and `render --stats=json`. Does nothing if a stream is open. */
void events_open_plain(void);

/* Whether --events was given; whether JSON is told, by --events or by the older options; and
 * whether that is on standard output, so that nothing else may be printed there. */
bool events_are_wanted(void);
bool events_are_open(void);
bool events_take_stdout(void);

/* Whether the stream could not be written: nobody reads it any more, or a disk is full. */
bool events_failed(void);
bool events_failed_on_stdout(void); /* after it was closed */

/* Begins an event of that name. More members may be added until its end, which ends the line and
 * hands it over; other threads wait in between. Without a stream nothing comes of it. */
struct kiln_json event_begin(const char *name);
void event_end(struct kiln_json *json);

/* Adds the members `file`, `line` and `column` where a message begins with a place. */
void event_add_place(struct kiln_json *json, const char *message);

/* Writes the line "openjd_WHAT: ...", where that is the form of the stream; else nothing. */
void event_openjd(const char *what, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Tells of how much of a command is done, where the form is `openjd`: whole percents, each once.
 * 100 are told with the exit code, when all files are whole. */
void event_progress(uint64_t done, uint64_t total, const char *status);

/* These tell what went wrong, with its place where the message begins with one, what a person is
 * warned of, and that a scene was loaded. They do nothing without --events. */
void event_error(int code, const char *message);
void event_warning(const char *message);
void event_loaded(const char *scene, const struct kiln_scene_info *info);

/* Tells the error and the end in a signal's handler, or beside a thread that hangs: where the
 * stream takes it at once. A process that was forked tells nothing. */
void events_last_words(const char *message, int code);

/* Tells the exit code, before it a result where the command came to its end and told none, and
 * closes the stream. Returns the code, or that of a stream that failed. */
int events_close(int code);

/* The events for people, and their JSON schema. */
bool help_write_events(FILE *out);
bool help_write_events_schema(FILE *out);

#endif
