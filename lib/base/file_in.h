/* Opens regular files and reads them into memory as a whole. The readers of a
 * scene's assets (lib/asset/loader), of saved states, of parts of clips, of pictures and of the
 * cache call it.
 *
 * A path may come from a user and lead to anything. A file is checked after it is opened, not
 * before, since the file at a path may be replaced between the two. Opening must not wait: the path
 * may lead to a FIFO that nobody writes. */
#ifndef KILN_BASE_FILE_IN_H
#define KILN_BASE_FILE_IN_H

#include <fcntl.h>

#include "kiln.h"

/* The flags by which files are opened for reading. O_NONBLOCK keeps open from waiting for a FIFO,
 * and O_NOCTTY keeps a terminal from becoming the controlling terminal of the process. */
enum { KILN_FILE_FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY };

/* Opens a regular file for reading. Returns its descriptor, which the caller closes, and its size.
 * Returns -1 with KILN_IO when the file cannot be opened, or with KILN_INVALID_INPUT when it is no
 * regular file. `what` ("image") and `allowed` ("PNG or EXR") are for messages. */
int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error);

/* Opens a path below a folder, wherever links lead while it is opened. `flags` are those of open.
 * Returns the descriptor, which the caller closes, or -1 with errno: EXDEV where the path leads out
 * of the folder by "..", by a link or because it is absolute, whether or not something is there;
 * ELOOP where O_NOFOLLOW is among the flags and the file itself is a link. */
int kiln_file_open_below(const char *folder, const char *path, int flags);

/* Returns the bytes of a regular file of at most `limit` bytes, which the caller frees. There is
 * room for one byte more, such as a zero. A file that grows meanwhile is read up to the size that
 * it had when it was opened. NULL with the codes of kiln_file_open, with KILN_INVALID_INPUT when
 * the file is larger, or with KILN_DEVICE_FAILED when memory is short. */
unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error);

/* Returns whether an open file is a pointer of Git LFS, which stands for a file that was not
 * fetched (git-lfs, docs/spec.md). */
bool kiln_file_is_lfs_pointer(int file);

/* Returns whether the file at a path is a pointer of Git LFS; false also when it cannot be opened.
 */
bool kiln_path_is_lfs_pointer(const char *path);

/* These are the steps of kiln_file_read, for a caller that opens the file in its own way and closes
 * it, such as the loader, which opens files only below a given folder.
 *
 * kiln_file_check checks that a descriptor is of a regular file that is no pointer of Git LFS, and
 * finds its size. It returns false with KILN_IO or KILN_INVALID_INPUT. */
bool kiln_file_check(int file, const char *path, const char *what, const char *allowed,
                     size_t *size, struct kiln_error *error);

/* Returns false with KILN_INVALID_INPUT if the size is above the limit. */
bool kiln_file_check_size(const char *path, const char *what, size_t size, size_t limit,
                          struct kiln_error *error);

/* Reads `size` bytes, which the caller frees; there is room for one byte more. Returns NULL with
 * KILN_IO when they cannot be read or the file has become shorter, or with KILN_DEVICE_FAILED when
 * memory is short. */
unsigned char *kiln_file_read_bytes(int file, const char *path, const char *what, size_t size,
                                    struct kiln_error *error);

#endif
