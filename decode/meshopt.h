/* Declares a decoder of the streams of the extensions EXT_meshopt_compression and
 * KHR_meshopt_compression. Debian's library knows only the first version of the streams of
 * attributes, and its filters round differently on different processors. */
#ifndef KILN_DECODE_MESHOPT_H
#define KILN_DECODE_MESHOPT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

enum meshopt_mode { MESHOPT_ATTRIBUTES, MESHOPT_TRIANGLES, MESHOPT_INDICES };

enum meshopt_filter {
    MESHOPT_NONE,
    MESHOPT_OCTAHEDRAL,
    MESHOPT_QUATERNION,
    MESHOPT_EXPONENTIAL,
    MESHOPT_COLOR
};

struct meshopt_stream {
    enum meshopt_mode mode;
    enum meshopt_filter filter;
    const unsigned char *bytes;
    size_t size;
    uint32_t count, stride; /* elements, and bytes of each, when they are decoded */
};

/* Returns count * stride bytes, which the caller frees; NULL with an error. */
unsigned char *meshopt_decode(const struct meshopt_stream *stream, struct kiln_error *error);

/* Undo a stream's filter in place (meshopt_filter.c). False: the stride does not fit the filter. */
bool meshopt_unfilter(const struct meshopt_stream *stream, unsigned char *elements);

#endif
