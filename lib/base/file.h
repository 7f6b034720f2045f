/* Joins and compares paths, and reads whole text files into memory. Most rooms use it, for files
 * such as scenes, test files, journals, results and sidecars. A loader (asset/loader/loader.h)
 * opens pictures, meshes and other assets instead, and checks that they lie below the asset root.
 *
 * A path may come from a user and lead to anything. So reading refuses what is no regular file,
 * never waits for a FIFO, and allocates no more than the caller's limit. */
#ifndef KILN_BASE_FILE_H
#define KILN_BASE_FILE_H

#include "kiln.h"

/* Writes "FOLDER/NAME" to path, without resolving links or "..". Returns false with KILN_IO when
 * the result is too long. */
bool kiln_path_join(char path[KILN_PATH_SIZE], const char *folder, const char *name,
                    struct kiln_error *error);

/* Returns the part of a path below a folder, or NULL when the path is not below the folder. Both
 * must be as realpath gives them, since they are compared as texts: a link or ".." in a path would
 * make it seem to lie below. */
const char *kiln_path_below(const char *path, const char *folder);

/* Reads a regular file of at most `limit` bytes. Returns its contents with a zero byte after them,
 * which *size does not count; the caller frees them. The contents may have zero bytes of their own.
 * `what` names the kind of file in messages, as in "a scene file". Returns NULL with
 * KILN_INVALID_INPUT when the file cannot be opened, is no regular file or is too large; with
 * KILN_IO when reading fails; with KILN_DEVICE_FAILED when memory is short. */
char *kiln_text_file_read(const char *path, const char *what, size_t limit, size_t *size,
                          struct kiln_error *error);

/* Does what kiln_text_file_read does, for a file that is open for reading and stays open. *status
 * becomes what the system says of it (fstat), unless it is NULL. `path` is for messages. */
struct stat;
char *kiln_text_file_take(int file, const char *path, const char *what, size_t limit, size_t *size,
                          struct stat *status, struct kiln_error *error);

#endif
