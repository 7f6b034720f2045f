/* Prints the progress of a running job: a line that moves, or lines now and then, and its frames
 * for programs. */
#ifndef KILN_CMD_PROGRESS_H
#define KILN_CMD_PROGRESS_H

#include "kiln_program.h"

enum progress_mode {
    PROGRESS_TTY,    /* one line on standard error, drawn over */
    PROGRESS_LINES,  /* a line on standard error every few seconds */
    PROGRESS_NDJSON, /* prints nothing: an older spelling of --json */
    PROGRESS_NONE,
};

struct progress {
    enum progress_mode mode;
    double last_s;  /* of the job's time, when something was said last */
    bool line_open; /* the moving line has something on it */
};

/* Begins a job. */
void progress_start(struct progress *progress, enum progress_mode mode);

/* Says how far the job is, if it is time to. */
void progress_show(struct progress *progress, const char *scene, const struct kiln_progress *frame);

/* Tells the event `frame`; file: that of the frame, where it has one, or NULL. */
void progress_tell(const char *scene, const struct kiln_progress *frame,
                   const struct kiln_written *file);

/* Tells an engine of Open Job Description how far a call is: the job-th, from 0, of its jobs is at
 * that frame. */
void progress_tell_engine(const char *scene, const struct kiln_progress *frame, size_t job,
                          size_t jobs);

/* Clears the moving line, before anything else is said. */
void progress_clear(struct progress *progress);

/* "0123456789abcdef" */
enum { STATE_TEXT_SIZE = 17 };
const char *state_text(char out[STATE_TEXT_SIZE], struct kiln_state_hash state);

/* Adds the member "pass_ms": {"simulate": 1.250, ...}. */
void add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT]);

#endif
