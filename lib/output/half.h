/* Rounds a float to a half: IEEE 754 binary16, to the nearest, ties to the even one. Numbers beyond
 * the largest half, and infinities, become the largest half, 65504, so that a reader finds no
 * infinity that was none. The same float gives the same half on every machine: the processor's own
 * conversions are not used, since some of them flush small numbers to zero. */
#ifndef KILN_OUTPUT_HALF_H
#define KILN_OUTPUT_HALF_H

#include <stdint.h>
#include <string.h>

static inline uint16_t kiln_half(float x)
{
    const uint32_t infinity = 0x7f800000, most = 0x477fe000 /* 65504 */;
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000;
    uint32_t size = bits & 0x7fffffff;
    if (size > infinity)
        return (uint16_t)(sign | 0x7e00); /* not a number */
    if (size > most)
        size = most;
    if (size < 0x38800000) { /* below 2^-14: the last bit of a half is worth 2^-24 */
        float shifted;
        memcpy(&shifted, &size, sizeof shifted);
        shifted += 0.5f; /* whose last bit is worth 2^-24, too: the addition rounds */
        memcpy(&size, &shifted, sizeof size);
        return (uint16_t)(sign | (size - 0x3f000000));
    }
    const uint32_t even = size >> 13 & 1;
    return (uint16_t)(sign | (size - (112u << 23) + 0xfff + even) >> 13);
}

#endif
