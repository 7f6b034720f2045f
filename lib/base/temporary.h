/* Writes files that appear whole or not at all: each is written in its target's folder under a
 * temporary name, and renamed when complete. */
#ifndef KILN_BASE_TEMPORARY_H
#define KILN_BASE_TEMPORARY_H

#include "kiln.h"

/* Zero-initialised is closed; open fills it. */
struct kiln_temporary {
    char *target; /* the name it will get; NULL when closed */
    int file;     /* descriptor */
    int slot;     /* in the registry of temporary names */
    int failure;  /* errno of the first write that failed, else 0; sticky */
    bool durable; /* to be set by who opened it: is on the disk before it has its name */
    struct kiln_budget *budget; /* likewise: its bytes are output, and writing fails where they are
                                 * too many; NULL: no limits */
};

/* Whether a file may be put there: KILN_USAGE, naming it, when something else than a file or link
 * has that name, or one of these has and must not be overwritten. */
bool kiln_target_check(const char *path, bool overwrite, struct kiln_error *error);

/* Creates the missing folders above path. KILN_USAGE, naming the folder, when a file has its name;
 * KILN_IO when it cannot be made. */
bool kiln_make_parent_folders(const char *path, struct kiln_error *error);

/* Opens ".NAME.kiln-PID-N.tmp" in the target's folder; KILN_IO, naming the target, on failure. */
bool kiln_temporary_open(struct kiln_temporary *temporary, const char *target,
                         struct kiln_error *error);

/* Removes what killed processes left of such files in a target's folder: regular files of such a
 * name that nobody locks, as their writers do. */
void kiln_temporary_sweep(const char *target);

/* The name it has now; valid until commit or discard. */
const char *kiln_temporary_path(const struct kiln_temporary *temporary);

/* Writes at the current place, without a buffer. False after any failure; commit tells which, and
 * so does kiln_temporary_fail. */
bool kiln_temporary_write(struct kiln_temporary *temporary, const void *bytes, size_t size);

/* Says why a write failed, and returns false: KILN_IO, or KILN_OVER_LIMIT by the budget. */
bool kiln_temporary_fail(const struct kiln_temporary *temporary, struct kiln_error *error);

/* Moves the place where the next write goes, from the start of the file. */
bool kiln_temporary_seek(struct kiln_temporary *temporary, int64_t offset);

/* Closes and renames the file to its target, replacing a file there only with overwrite; when
 * anything failed since open, removes it instead: KILN_IO with the reason. Closed afterwards. */
bool kiln_temporary_commit(struct kiln_temporary *temporary, bool overwrite,
                           struct kiln_error *error);

/* The same for files that belong together: all get their names, in this order, or none does. Where
 * old ones are replaced, the one of the last name goes before the first new one comes, so that
 * whoever finds that finds what belongs to it. At most 8; all are closed afterwards. */
bool kiln_temporary_commit_all(struct kiln_temporary *const *files, size_t count, bool overwrite,
                               struct kiln_error *error);

/* Writes a whole file, in place of what has that name; makes missing folders. KILN_IO, KILN_USAGE.
 */
bool kiln_temporary_write_file(const char *path, const void *bytes, size_t size,
                               struct kiln_error *error);

/* Closes and removes the file; does nothing when it is closed. */
void kiln_temporary_discard(struct kiln_temporary *temporary);

#endif
