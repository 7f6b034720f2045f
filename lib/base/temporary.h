/* Declares files that appear whole or not at all. A file is written under a temporary name in the
 * folder of its target, and gets the target's name when it is complete. All code that writes
 * outputs uses them. */
#ifndef KILN_BASE_TEMPORARY_H
#define KILN_BASE_TEMPORARY_H

#include "kiln.h"

/* A file that is being written. A zero-initialised one is closed. kiln_temporary_open fills it; the
 * caller then sets `durable` and `budget`. */
struct kiln_temporary {
    char *target;               /* the name it will get; NULL when closed */
    int file;                   /* descriptor */
    int slot;                   /* in the registry of temporary names */
    int failure;                /* errno of the first write that failed, else 0; sticky */
    bool durable;               /* true: commit syncs the file to the disk before the rename */
    struct kiln_budget *budget; /* counts its bytes as output: writing fails beyond the limit; NULL:
                                 * no limit */
};

/* Returns whether a file may be written at a path. KILN_USAGE with the path if a folder, device,
 * pipe or socket is there, or a file or link that must not be overwritten. */
bool kiln_target_check(const char *path, bool overwrite, struct kiln_error *error);

/* Creates the missing folders above a path. KILN_USAGE with the folder's name if a file has that
 * name; KILN_IO if the folder cannot be made. */
bool kiln_make_parent_folders(const char *path, struct kiln_error *error);

/* Opens ".NAME.kiln-PID-N.tmp" in the target's folder; KILN_IO, naming the target, on failure. */
bool kiln_temporary_open(struct kiln_temporary *temporary, const char *target,
                         struct kiln_error *error);

/* Removes the temporary files that killed processes left in a target's folder: regular files with a
 * temporary name that no process locks. A writer locks its file. */
void kiln_temporary_sweep(const char *target);

/* Returns the temporary path of the file; valid until commit or discard. */
const char *kiln_temporary_path(const struct kiln_temporary *temporary);

/* Writes at the current place, without a buffer. Returns false after any failure, which commit and
 * kiln_temporary_fail report. */
bool kiln_temporary_write(struct kiln_temporary *temporary, const void *bytes, size_t size);

/* Says why a write failed, and returns false: KILN_IO, or KILN_OVER_LIMIT by the budget. */
bool kiln_temporary_fail(const struct kiln_temporary *temporary, struct kiln_error *error);

/* Moves the place where the next write goes, from the start of the file. */
bool kiln_temporary_seek(struct kiln_temporary *temporary, int64_t offset);

/* Closes and renames the file to its target, replacing a file there only with overwrite; when
 * anything failed since open, removes it instead: KILN_IO with the reason. Closed afterwards. */
bool kiln_temporary_commit(struct kiln_temporary *temporary, bool overwrite,
                           struct kiln_error *error);

/* Does the same for up to 8 files that belong together: all get their names, in this order, or none
 * does. The last file marks a complete set: with overwrite, an old file of that name is removed
 * before the first new file gets its name. If a rename fails, the old files that were replaced by
 * then are lost. All files are closed afterwards. */
bool kiln_temporary_commit_all(struct kiln_temporary *const *files, size_t count, bool overwrite,
                               struct kiln_error *error);

/* Writes a whole file and replaces one of that name; makes missing folders. KILN_IO, KILN_USAGE. */
bool kiln_temporary_write_file(const char *path, const void *bytes, size_t size,
                               struct kiln_error *error);

/* Closes and removes the file; does nothing when it is closed. */
void kiln_temporary_discard(struct kiln_temporary *temporary);

#endif
