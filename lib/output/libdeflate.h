/* A kiln_compressor makes zlib streams by libdeflate, at its highest level for small PNG files. Its
 * lower levels are slower than output/deflate.h and give larger files. The library is opened when
 * such a file is written, so that no other run waits for it. */
#ifndef KILN_OUTPUT_LIBDEFLATE_H
#define KILN_OUTPUT_LIBDEFLATE_H

#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

/* Opens libdeflate, once for the process. KILN_IO, with the Debian package, when it is not
 * there. */
bool kiln_libdeflate_open(struct kiln_error *error);

struct kiln_compressor;

/* Creates a compressor, for one thread. level: 1 (fast) to 12 (small). NULL when memory is short.
 * Needs kiln_libdeflate_open. */
struct kiln_compressor *kiln_compressor_create(int level);
void kiln_compressor_destroy(struct kiln_compressor **compressor);

/* Returns the most bytes that a stream of `size` bytes takes. */
size_t kiln_compressor_room(struct kiln_compressor *compressor, size_t size);

/* Compresses `size` bytes to a zlib stream. Returns its bytes; 0 when it does not fit into `room`
 * bytes. At level 12 a byte takes about 0.7 us. */
size_t kiln_compressor_run(struct kiln_compressor *compressor, const void *bytes, size_t size,
                           void *out, size_t room);

#endif
