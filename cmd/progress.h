/* Prints the progress of a running job: for people, a line that is overwritten or a line every few
 * seconds; for programs, an event for each frame. */
#ifndef KILN_CMD_PROGRESS_H
#define KILN_CMD_PROGRESS_H

#include "kiln_program.h"

enum progress_mode {
    PROGRESS_TTY,    /* one line on standard error, which is overwritten */
    PROGRESS_LINES,  /* a line on standard error every few seconds */
    PROGRESS_NDJSON, /* prints nothing: an older spelling of --json */
    PROGRESS_NONE,
};

struct progress {
    enum progress_mode mode;
    double last_s;   /* time of the last printed line, since the job began */
    bool line_shown; /* the overwritten line is not empty */
};

/* Resets the state for a new job. */
void progress_start(struct progress *progress, enum progress_mode mode);

/* Prints how far the job is, unless the last line is too recent. */
void progress_show(struct progress *progress, const char *scene, const struct kiln_progress *frame);

/* Writes the event `frame`. `file` is the file of the frame, or NULL if it has none. */
void progress_write_event(const char *scene, const struct kiln_progress *frame,
                          const struct kiln_written *file);

/* Writes the progress of a call for an engine of Open Job Description: job number `job`, from 0, of
 * `jobs` is at this frame. */
void progress_write_openjd(const char *scene, const struct kiln_progress *frame, size_t job,
                           size_t jobs);

/* Clears the overwritten line, before anything else is printed. */
void progress_clear(struct progress *progress);

/* Writes a state hash as "0123456789abcdef" and returns out. */
enum { STATE_TEXT_SIZE = 17 };
const char *state_text(char out[STATE_TEXT_SIZE], struct kiln_state_hash state);

/* Adds the member "pass_ms": {"simulate": 1.250, ...}. */
void add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT]);

#endif
