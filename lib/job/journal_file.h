/* Declares the open file of a journal, which journal.c, journal_read.c and journals.c share. */
#ifndef KILN_JOB_JOURNAL_FILE_H
#define KILN_JOB_JOURNAL_FILE_H

#include <pthread.h>

#include "job/journal.h"

#define KILN_JOURNAL_SUFFIX ".journal"
#define KILN_JOURNAL_ANEW   "{\"anew\": true}\n" /* a line that makes all lines before it void */

struct kiln_journal {
    char path[KILN_PATH_SIZE];
    int file;
    pthread_mutex_t mutex; /* guards the members below and the end of the file */
    double synced_s;
    bool unsynced;
};

/* Opens the file of a journal whose path is set. flags: O_CREAT or 0; lock: LOCK_EX, or LOCK_SH to
 * read beside other readers. KILN_IO, also when another process has the file locked. */
bool kiln_journal_open_file(struct kiln_journal *journal, int flags, int lock,
                            struct kiln_error *error);

/* Appends whole lines; `sync` waits until they are on the disk. */
bool kiln_journal_append(struct kiln_journal *journal, const char *bytes, size_t size, bool sync,
                         struct kiln_error *error);

/* Returns the text of a journal, which the caller frees; NULL with an error when the file is no
 * journal. */
char *kiln_journal_read_text(const struct kiln_journal *journal, struct kiln_error *error);

/* Returns whether a journal has no whole line after its head, and the head itself does not declare
 * earlier lines void. */
bool kiln_journal_has_head_alone(const char *text);

/* Reads all whole lines. *length becomes the offset of the end of the last line, *first that of the
 * first line. */
bool kiln_journal_read_lines(const struct kiln_journal *journal, char *text,
                             const struct kiln_journal_head *head, struct kiln_records *records,
                             size_t *first, size_t *length, struct kiln_error *error);

/* Parses a line. *node becomes NULL when the line is no valid JSON. False only when memory is
 * short. */
bool kiln_journal_parse_line(struct kiln_arena *arena, const char *path, char *line,
                             const struct kiln_node **node, struct kiln_error *error);

/* Checks that a journal with this first line (or NULL: none) is of this job. */
bool kiln_journal_check_head(const struct kiln_journal *journal, const struct kiln_node *line,
                             const struct kiln_journal_head *head, struct kiln_error *error);

#endif
