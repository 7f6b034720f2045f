/* Declares the journal of a job, a file beside the job's output that lists which output files are
 * whole, a line of JSON each. By it a later run resumes a job that was killed. docs/jobs.md
 * describes the file. */
#ifndef KILN_JOB_JOURNAL_H
#define KILN_JOB_JOURNAL_H

#include "job/attempt.h"
#include "job/journal_head.h"
#include "job/record.h"

struct kiln_journal;

/* "OUTPUT.journal", or of one of several shards "OUTPUT.2-of-4.journal". KILN_USAGE when it is
 * too long. */
bool kiln_journal_path(const char *output, struct kiln_shard shard, char path[KILN_PATH_SIZE],
                       struct kiln_error *error);

/* Opens a journal, or begins one, and locks it until it is closed; what it says goes into the
 * records, whose `whole` stays false: nobody has looked. `restart` forgets what it says. *found
 * says whether there was one. KILN_USAGE when it is of another job or no journal; KILN_IO when
 * another process has it, when another program, device or techniques have begun it, or when it
 * cannot be read or written. */
struct kiln_journal *kiln_journal_open(const struct kiln_journal_head *head,
                                       struct kiln_shard shard, bool restart,
                                       struct kiln_records *records, bool *found,
                                       struct kiln_error *error);

/* Reads the journals of all shards of the output; unless they are to be kept, takes them over and
 * removes them. *found becomes true when there were any. After an error, as above,
 * all stay. */
bool kiln_journal_merge(struct kiln_journal *journal, const struct kiln_journal_head *head,
                        bool keep, struct kiln_records *records, bool *found,
                        struct kiln_error *error);

/* Looks at the journals beside that of a shard: takes what that of the whole job says into the
 * records, where *found becomes true, and looks at the first lines of other shards. KILN_USAGE when
 * one is of another job, KILN_IO when a process goes on with the whole. */
bool kiln_journal_look_around(const struct kiln_journal *journal,
                              const struct kiln_journal_head *head, struct kiln_records *records,
                              bool *found, struct kiln_error *error);

/* Removes all journals of an output. KILN_IO when a process has one of them locked: then none is
 * removed. */
bool kiln_journal_forget(const char *output, struct kiln_error *error);

/* Returns whether an output has a journal, and copies the path of one to `path`. */
bool kiln_journal_is_there(const char *output, char path[KILN_PATH_SIZE]);

/* Reads the head of any journal of an output. KILN_IO when there is none, KILN_USAGE when it makes
 * no sense. */
bool kiln_journal_find(const char *output, struct kiln_journal_head *head, struct kiln_arena *arena,
                       struct kiln_error *error);

/* Appends a line for a file that is whole, with the states of its frames. The line is synced to the
 * disk within a second. KILN_IO. */
bool kiln_journal_add(struct kiln_journal *journal, const struct kiln_records *records,
                      const struct kiln_finished_file *finished, struct kiln_error *error);

/* Appends the description of a run at its end. KILN_IO. */
bool kiln_journal_add_attempt(struct kiln_journal *journal, const struct kiln_attempt *run,
                              const struct kiln_render_stats *stats,
                              const struct kiln_error *failure, struct kiln_error *error);
void kiln_journal_close(struct kiln_journal **journal);

/* Closes and removes a journal that was begun and lists no file. */
void kiln_journal_remove(struct kiln_journal **journal);

#endif
