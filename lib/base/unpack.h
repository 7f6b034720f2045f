/* Unpacks what zstd compressed. */
#ifndef KILN_BASE_UNPACK_H
#define KILN_BASE_UNPACK_H

#include <stddef.h>

#include "kiln.h"

/* Unpacks one frame of zstd into `out`, which has room for so many bytes, and says how many they
 * are. KILN_INVALID_INPUT when the bytes are damaged or make more, KILN_DEVICE_FAILED when memory
 * is short. */
enum kiln_code kiln_unpack(void *out, size_t room, const void *packed, size_t packed_size,
                           size_t *size);

#endif
