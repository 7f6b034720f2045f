/* Declares the first line of a journal. It identifies the job, and has all settings by which the
 * output can be made from its files without the scene. */
#ifndef KILN_JOB_JOURNAL_HEAD_H
#define KILN_JOB_JOURNAL_HEAD_H

#include "base/arena.h"
#include "base/json.h"
#include "kiln_program.h"
#include "option/node.h"
#include "output/output.h"

enum { KILN_JOURNAL_VERSION = 1 };

struct kiln_journal_head {
    /* complete except for the members that the caller sets: threads, log... */
    struct kiln_output_params output;
    char job[65];        /* the job's hash, as kiln_clip_hash makes it */
    const char *made_by; /* program, device and techniques as text */
    const char *scene;   /* the scene as JSON, as in the manifest */
};

/* Fills a head. False when memory is short. */
bool kiln_journal_head_make(struct kiln_journal_head *head, const struct kiln_output_params *output,
                            const char *made_by, const char *scene);

/* Writes the members of the line. */
void kiln_journal_head_write(struct kiln_json *json, const struct kiln_journal_head *head);

/* Reads them, for an output of a path; texts and ranges lie in the arena. KILN_USAGE, naming the
 * journal, when it makes no sense, also when the settings are not those of its hash. */
bool kiln_journal_head_read(struct kiln_journal_head *head, const char *journal, const char *path,
                            const struct kiln_node *line, struct kiln_arena *arena,
                            struct kiln_error *error);

#endif
