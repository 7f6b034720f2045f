/* Declares an attempt, which is one process that works at a job, from its start to its end, whether
 * it succeeds or fails. The job's manifest and its journal describe it. Later runs and `join` read
 * the descriptions of earlier attempts from the journal. */
#ifndef KILN_JOB_ATTEMPT_H
#define KILN_JOB_ATTEMPT_H

#include <time.h>

#include "job/shard.h"
#include "kiln_program.h"
#include "option/node.h"

struct kiln_attempt {
    const char *const *command; /* the words of the command line */
    size_t command_count;
    /* version and commit, "0.2.0 (254e4dc)"; NULL: the version alone */
    const char *build;
    const struct kiln_device_info *device; /* NULL: no device was used */
    const char *techniques;                /* "simulate=cpu sort=cpu ..." */
    struct kiln_shard shard;               /* count 0: the whole job */
    time_t started;                        /* time of day at the start */
    uint32_t asked;                        /* the number of frames that were to be drawn */
};

/* Adds the members that describe a run to an object: on which machine and with which techniques it
 * worked, how many frames it drew, and its error if it failed (failure is NULL if it did not). */
void kiln_attempt_describe(struct kiln_json *json, const struct kiln_attempt *run,
                           const struct kiln_render_stats *stats, const struct kiln_error *failure);

/* Adds the description of a run that was read from a journal, or any other value that was read from
 * JSON. */
void kiln_attempt_copy(struct kiln_json *json, const char *key, const struct kiln_node *value);

/* Adds the times of the passes as the member "ms". */
void kiln_attempt_add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT]);

#endif
