/* Reads whole files into memory. */
#ifndef KILN_BASE_FILE_IN_H
#define KILN_BASE_FILE_IN_H

#include <fcntl.h>

#include "kiln.h"

/* How a file that a user names is opened: without waiting, should it be a FIFO or a device. */
enum { KILN_FILE_FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY };

/* Opens a regular file for reading, without waiting should it be a FIFO or a device. Returns its
 * descriptor and size, or -1: KILN_IO when it cannot be opened, KILN_INVALID_INPUT when it is no
 * regular file. what ("image") and allowed ("PNG or EXR") are for messages. */
int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error);

/* Returns the bytes of a regular file of at most `limit` bytes, which the caller frees. NULL with
 * the codes of kiln_file_open, with KILN_INVALID_INPUT when the file is larger, or with
 * KILN_DEVICE_FAILED when memory is short. */
unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error);

/* The steps of kiln_file_read, for a descriptor that the caller has opened and closes: the first
 * checks that it is a regular file and finds its size, the second compares the size with a limit,
 * the third reads the bytes. */
bool kiln_file_check(int file, const char *path, const char *what, const char *allowed,
                     size_t *size, struct kiln_error *error);
bool kiln_file_check_size(const char *path, const char *what, size_t size, size_t limit,
                          struct kiln_error *error);
unsigned char *kiln_file_take(int file, const char *path, const char *what, size_t size,
                              struct kiln_error *error);

#endif
