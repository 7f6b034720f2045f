/* Whole files into memory. */
#ifndef KILN_BASE_FILE_IN_H
#define KILN_BASE_FILE_IN_H

#include <fcntl.h>

#include "kiln.h"

/* How a file of people is opened: without waiting for what is a FIFO or device. */
enum { KILN_FILE_FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY };

/* Opens a regular file for reading, without waiting for what is a FIFO or device; returns its
 * descriptor and size, or -1: KILN_IO when it cannot be opened, KILN_INVALID_INPUT when it is
 * something else. what ("image") and allowed ("PNG or EXR") are for messages. */
int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error);

/* The bytes of such a file of at most `limit` bytes, which the caller frees, or NULL: as above,
 * KILN_INVALID_INPUT when it is larger, KILN_DEVICE_FAILED when memory is short. */
unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error);

/* Steps of the above for a descriptor that somebody else has opened, and closes: is it a regular
 * file, and how large; is that little enough; its bytes. */
bool kiln_file_check(int file, const char *path, const char *what, const char *allowed,
                     size_t *size, struct kiln_error *error);
bool kiln_file_check_size(const char *path, const char *what, size_t size, size_t limit,
                          struct kiln_error *error);
unsigned char *kiln_file_take(int file, const char *path, const char *what, size_t size,
                              struct kiln_error *error);

#endif
