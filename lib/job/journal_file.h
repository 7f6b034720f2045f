/* Declares the file of a journal, for the code that reads and writes one. */
#ifndef KILN_JOB_JOURNAL_FILE_H
#define KILN_JOB_JOURNAL_FILE_H

#include <pthread.h>

#include "job/journal.h"

#define KILN_JOURNAL_SUFFIX ".journal"
#define KILN_JOURNAL_ANEW   "{\"anew\": true}\n" /* a line: what was there before is forgotten */

struct kiln_journal {
    char path[KILN_PATH_SIZE];
    int file;
    pthread_mutex_t mutex; /* of what follows, and of the end of the file */
    double synced_s;
    bool unsynced;
};

/* Opens the file of a journal whose path is set, with O_CREAT or 0, and locks it: with LOCK_EX, or
 * LOCK_SH to read beside others that read. KILN_IO, also when another process has it. */
bool kiln_journal_open_file(struct kiln_journal *journal, int flags, int lock,
                            struct kiln_error *error);

/* Appends whole lines; `sync` brings them to the disk at once. */
bool kiln_journal_append(struct kiln_journal *journal, const char *bytes, size_t size, bool sync,
                         struct kiln_error *error);

/* The text of a journal, which the caller frees; NULL with an error when it is something else. */
char *kiln_journal_read_text(const struct kiln_journal *journal, struct kiln_error *error);

/* Whether there is no whole line behind the first, and that one does not say that what is there is
 * forgotten. */
bool kiln_journal_has_head_alone(const char *text);

/* Reads all whole lines; *length gets where the last one ends, *first where the first one does. */
bool kiln_journal_read_lines(const struct kiln_journal *journal, char *text,
                             const struct kiln_journal_head *head, struct kiln_records *records,
                             size_t *first, size_t *length, struct kiln_error *error);

/* *node becomes NULL where a line makes no sense. False when memory was too short to say. */
bool kiln_journal_parse_line(struct kiln_arena *arena, const char *path, char *line,
                             const struct kiln_node **node, struct kiln_error *error);

/* That a journal with such a first line (or NULL) is of this job. */
bool kiln_journal_check_head(const struct kiln_journal *journal, const struct kiln_node *line,
                             const struct kiln_journal_head *head, struct kiln_error *error);

#endif
