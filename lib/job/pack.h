/* Tables of words in little space: rows of zeros take a bit, words that rise from row to row almost
 * nothing, and the bytes of floats lie beside those that are like them, compressed by zstd. */
#ifndef KILN_JOB_PACK_H
#define KILN_JOB_PACK_H

#include "base/temporary.h"
#include "base/thread.h"

enum { KILN_PACK_MAX_COLUMNS = 12 };

struct kiln_table {
    uint32_t *words; /* [rows][columns] */
    size_t rows;
    uint32_t columns; /* at most KILN_PACK_MAX_COLUMNS */
    uint32_t rising;  /* bit c: the words of column c are kept as what they add to the row before */
};

/* Appends a packed table to a file. False when memory is short (KILN_DEVICE_FAILED); a write that
 * fails is the file's to tell. */
bool kiln_pack_write(const struct kiln_table *table, struct kiln_threads *threads,
                     struct kiln_temporary *file, struct kiln_error *error);

/* Reads a table from where an open file stands, into words that have room for rows and columns.
 * KILN_INVALID_INPUT, naming the path, when it is not one of this shape, KILN_IO, or
 * KILN_DEVICE_FAILED for memory. */
bool kiln_pack_read(const struct kiln_table *table, struct kiln_threads *threads, int file,
                    const char *path, struct kiln_error *error);

/* Reads over a table of such a shape and checks that each byte is as it was written. */
bool kiln_pack_check(const struct kiln_table *table, int file, const char *path,
                     struct kiln_error *error);

/* Reads exactly so many bytes. KILN_INVALID_INPUT when the file ends before, KILN_IO. */
bool kiln_pack_read_bytes(int file, void *bytes, size_t size, const char *path,
                          struct kiln_error *error);

#endif
