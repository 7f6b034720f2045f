/* An attempt is one process that works at a job, from its start to its end, good or bad. Its
 * manifest tells of it, and so does the journal, out of which later runs and `join` tell of those
 * before. */
#ifndef KILN_JOB_ATTEMPT_H
#define KILN_JOB_ATTEMPT_H

#include <time.h>

#include "job/shard.h"
#include "kiln_program.h"
#include "option/node.h"

struct kiln_attempt {
    const char *const *command; /* the words of the command line */
    size_t command_count;
    const char *build;                     /* which kiln, "0.2.0 (254e4dc)"; NULL: its version */
    const struct kiln_device_info *device; /* NULL: no device was used */
    const char *techniques;                /* "simulate=cpu sort=cpu ..." */
    struct kiln_shard shard;               /* count 0: the whole job */
    time_t started;                        /* by the clock of the day */
    uint32_t asked;                        /* frames that were to be drawn */
};

/* Adds the members that tell of a run to an object: where and with what it worked, how far it came,
 * and why it failed where it did (NULL: it did not). */
void kiln_attempt_describe(struct kiln_json *json, const struct kiln_attempt *run,
                           const struct kiln_render_stats *stats, const struct kiln_error *failure);

/* Adds what a journal has of a run, or any other value that was read from JSON. */
void kiln_attempt_copy(struct kiln_json *json, const char *key, const struct kiln_node *value);

/* The times of passes, as the member "ms". */
void kiln_attempt_add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT]);

#endif
