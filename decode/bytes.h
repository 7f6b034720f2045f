/* Numbers as files store them in bytes, in either order. */
#ifndef KILN_DECODE_BYTES_H
#define KILN_DECODE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Returns an unsigned integer of up to 8 bytes. */
static inline uint64_t decode_unsigned(const unsigned char *bytes, size_t size, bool big_endian)
{
    uint64_t value = 0;
    for (size_t i = 0; i < size; i++)
        value = value << 8 | bytes[big_endian ? i : size - 1 - i];
    return value;
}

static inline float decode_float_of(const unsigned char *bytes, bool big_endian)
{
    const uint32_t bits = (uint32_t)decode_unsigned(bytes, sizeof bits, big_endian);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double decode_double_of(const unsigned char *bytes, bool big_endian)
{
    const uint64_t bits = decode_unsigned(bytes, sizeof bits, big_endian);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
