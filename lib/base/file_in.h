/* Reads whole files that a user names into memory.
 *
 * Whatever reads a file as a whole calls it: assets of a scene by way of lib/asset/loader, saved
 * states, parts of clips, pictures of a report, caches. A file is checked after it is opened, not
 * before, since a path may lead elsewhere a moment later. Opening must not wait: a path may lead to
 * a FIFO that nobody writes. */
#ifndef KILN_BASE_FILE_IN_H
#define KILN_BASE_FILE_IN_H

#include <fcntl.h>

#include "kiln.h"

/* The flags by which such a file is opened. O_NONBLOCK keeps open from waiting for a FIFO, and
 * O_NOCTTY keeps a terminal from becoming the process's own. */
enum { KILN_FILE_FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY };

/* Opens a regular file for reading. Returns its descriptor, which the caller closes, and its size.
 * Returns -1 with KILN_IO when the file cannot be opened, or with KILN_INVALID_INPUT when it is no
 * regular file. `what` ("image") and `allowed` ("PNG or EXR") are for messages. */
int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error);

/* Returns the bytes of a regular file of at most `limit` bytes, which the caller frees. NULL with
 * the codes of kiln_file_open, with KILN_INVALID_INPUT when the file is larger, or with
 * KILN_DEVICE_FAILED when memory is short. */
unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error);

/* Do the steps of kiln_file_read, for a caller that opens a file in its own way and closes it, as
 * the loader does below an asset root. kiln_file_check checks that it is a regular file and finds
 * its size, kiln_file_check_size compares the size with a limit, and kiln_file_take reads the
 * bytes. */
bool kiln_file_check(int file, const char *path, const char *what, const char *allowed,
                     size_t *size, struct kiln_error *error);
bool kiln_file_check_size(const char *path, const char *what, size_t size, size_t limit,
                          struct kiln_error *error);
unsigned char *kiln_file_take(int file, const char *path, const char *what, size_t size,
                              struct kiln_error *error);

#endif
