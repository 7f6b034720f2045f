/* Packs tables of 32-bit words for saved states. A row of zeros takes one bit. Columns whose words
 * rise from row to row are stored as differences. Bytes of the same significance lie together, and
 * zstd compresses them. */
#ifndef KILN_JOB_PACK_H
#define KILN_JOB_PACK_H

#include "base/temporary.h"
#include "base/thread.h"

enum { KILN_PACK_MAX_COLUMNS = 12 };

struct kiln_table {
    uint32_t *words; /* words in the order [rows][columns] */
    size_t rows;
    uint32_t columns; /* at most KILN_PACK_MAX_COLUMNS */
    uint32_t rising;  /* bit c: column c is stored as differences between successive rows */
};

/* Appends a packed table to a file. False when memory is short (KILN_DEVICE_FAILED); the file
 * itself keeps errors of writing. */
bool kiln_pack_write(const struct kiln_table *table, struct kiln_threads *threads,
                     struct kiln_temporary *file, struct kiln_error *error);

/* Reads a table from the position of an open file into words that have room for rows and columns.
 * Fails with KILN_INVALID_INPUT, naming the path, when the file has no table of this shape there,
 * with KILN_IO, or with KILN_DEVICE_FAILED when memory is short. */
bool kiln_pack_read(const struct kiln_table *table, struct kiln_threads *threads, int file,
                    const char *path, struct kiln_error *error);

/* Reads a table of this shape without keeping it, and checks its CRCs. */
bool kiln_pack_check(const struct kiln_table *table, int file, const char *path,
                     struct kiln_error *error);

/* Reads exactly `size` bytes. KILN_INVALID_INPUT when the file ends before, KILN_IO. */
bool kiln_pack_read_bytes(int file, void *bytes, size_t size, const char *path,
                          struct kiln_error *error);

#endif
