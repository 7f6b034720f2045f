/* Whole files into memory. */
#ifndef KILN_BASE_FILE_IN_H
#define KILN_BASE_FILE_IN_H

#include "kiln.h"

/* Opens a regular file for reading, without waiting for what is a FIFO or device; returns its
 * descriptor and size, or -1: KILN_IO when it cannot be opened, KILN_INVALID_INPUT when it is
 * something else. what ("image") and allowed ("PNG or EXR") are for messages. */
int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error);

/* The bytes of such a file of at most `limit` bytes, which the caller frees, or NULL: as above,
 * KILN_INVALID_INPUT when it is larger, KILN_DEVICE_FAILED when memory is short. */
unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error);

#endif
