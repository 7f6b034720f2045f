/* Sets of numbers that are small, such as those of lamps: a bit for each, in words of 32. The
 * functions take the words; a struct holds as many as its greatest number needs. */
#ifndef KILN_BASE_BITS_H
#define KILN_BASE_BITS_H

#include <stdbool.h>
#include <stdint.h>

/* Returns the words of a set of numbers below `count`. There is a bit more, so that kiln_bits_below
 * may be asked for the count. */
#define KILN_BIT_WORDS(count) ((count) / 32 + 1)

static inline bool kiln_bits_have(const uint32_t *words, uint32_t number)
{
    return words[number / 32] >> number % 32 & 1;
}

static inline void kiln_bits_add(uint32_t *words, uint32_t number)
{
    words[number / 32] |= 1u << number % 32;
}

/* Returns how many numbers of a set are below a number. */
static inline uint32_t kiln_bits_below(const uint32_t *words, uint32_t number)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < number / 32; i++)
        count += (uint32_t)__builtin_popcount(words[i]);
    return count + (uint32_t)__builtin_popcount(words[number / 32] & ((1u << number % 32) - 1));
}

#endif
