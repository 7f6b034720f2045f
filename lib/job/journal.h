/* The journal of a job: a file beside its output that says which files are whole, a line of JSON
 * each, so that a killed job can be gone on with. docs/jobs.md describes it. */
#ifndef KILN_JOB_JOURNAL_H
#define KILN_JOB_JOURNAL_H

#include "job/record.h"

struct kiln_journal;

struct kiln_journal_params {
    const struct kiln_output_params *output; /* complete */
    const char *made_by;                     /* device and techniques */
    bool restart;                            /* what the journal says is forgotten */
    struct kiln_log log;
};

/* Opens the journal, or begins one, and locks it until it is closed; what it says goes into the
 * records, whose `whole` stays false: nobody has looked. *found says whether it was there. KILN_IO
 * when another process has it, when it is of another job, or cannot be used. */
struct kiln_journal *kiln_journal_open(const struct kiln_journal_params *params,
                                       struct kiln_records *records, bool *found,
                                       struct kiln_error *error);

/* Appends a file that is whole, with the states of its frames. The journal is on the disk a second
 * later. KILN_IO. */
bool kiln_journal_add(struct kiln_journal *journal, const struct kiln_records *records,
                      const struct kiln_whole *whole, struct kiln_error *error);
void kiln_journal_close(struct kiln_journal **journal);

/* Closes a journal that was begun for nothing, and removes it. */
void kiln_journal_remove(struct kiln_journal **journal);

/* "OUTPUT.journal". KILN_IO when it is too long. */
bool kiln_journal_path(const char *output, char path[KILN_PATH_SIZE], struct kiln_error *error);

#endif
