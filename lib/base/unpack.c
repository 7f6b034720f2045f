/* Unpacks a frame of zstd. That zstd gets no memory of its own is KILN_DEVICE_FAILED, since it says
 * nothing about the bytes; every other failure is KILN_INVALID_INPUT. */
#include "base/unpack.h"

#include <zstd.h>
#include <zstd_errors.h>

enum kiln_code kiln_unpack(void *out, size_t room, const void *packed, size_t packed_size,
                           size_t *size)
{
    *size = ZSTD_decompress(out, room, packed, packed_size);
    if (!ZSTD_isError(*size))
        return KILN_OK;
    return ZSTD_getErrorCode(*size) == ZSTD_error_memory_allocation ? KILN_DEVICE_FAILED
                                                                    : KILN_INVALID_INPUT;
}
