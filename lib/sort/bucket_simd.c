/* This file sorts few pairs on one thread by a radix sort, least significant digit first. It counts
 * the digits of all passes at once, since no other thread moves pairs in between. */
#include <string.h>

#include "sort/bucket.h"

enum { MOST_DIGIT_BITS = 9, MOST_PASSES = 4 };

struct digits {
    uint32_t least; /* the least key, which is subtracted from every key */
    unsigned bits;  /* width of a digit */
    uint32_t places[MOST_PASSES][1 << MOST_DIGIT_BITS];
};

static inline uint32_t digit_of(const struct digits *digits, kiln_sort_pair pair, unsigned pass)
{
    const uint32_t key = (uint32_t)(pair >> 32) - digits->least;
    return key >> (pass * digits->bits) & ((1u << digits->bits) - 1);
}

/* Chooses the width of a digit and returns how many passes are needed. */
static unsigned choose_digit_width(struct digits *digits, uint32_t span)
{
    unsigned bits = 0;
    while (bits < 32 && span >> bits != 0)
        bits++;
    const unsigned passes = (bits + MOST_DIGIT_BITS - 1) / MOST_DIGIT_BITS;
    digits->bits = passes ? (bits + passes - 1) / passes : 0;
    return passes;
}

static inline void count_digits(struct digits *digits, unsigned passes, const kiln_sort_pair *pairs,
                                size_t count)
{
    for (size_t i = 0; i < count; i++) {
        for (unsigned pass = 0; pass < passes; pass++)
            digits->places[pass][digit_of(digits, pairs[i], pass)]++;
    }
}

static void find_places(struct digits *digits, unsigned passes, const kiln_sort_pair *pairs,
                        size_t count)
{
    for (unsigned pass = 0; pass < passes; pass++)
        memset(digits->places[pass], 0, sizeof(uint32_t) << digits->bits);
    if (passes == 1)
        count_digits(digits, 1, pairs, count);
    else if (passes == 2)
        count_digits(digits, 2, pairs, count);
    else
        count_digits(digits, passes, pairs, count);
    for (unsigned pass = 0; pass < passes; pass++) {
        uint32_t place = 0;
        for (uint32_t digit = 0; digit < 1u << digits->bits; digit++) {
            const uint32_t digit_count = digits->places[pass][digit];
            digits->places[pass][digit] = place;
            place += digit_count;
        }
    }
}

void KILN_SIMD_NAME(kiln_sort_bucket)(kiln_sort_pair *pairs, size_t count,
                                      struct kiln_sort_span span, kiln_sort_pair *scratch,
                                      uint32_t *list, int step)
{
    struct digits digits;
    digits.least = span.least;
    const unsigned passes = choose_digit_width(&digits, span.greatest - span.least);
    if (passes == 0) {
        for (size_t i = 0; i < count; i++)
            list[(ptrdiff_t)i * step] = (uint32_t)pairs[i];
        return;
    }
    find_places(&digits, passes, pairs, count);
    kiln_sort_pair *from = pairs, *to = scratch;
    for (unsigned pass = 0; pass + 1 < passes; pass++) {
        for (size_t i = 0; i < count; i++)
            to[digits.places[pass][digit_of(&digits, from[i], pass)]++] = from[i];
        kiln_sort_pair *swap = from;
        from = to;
        to = swap;
    }
    for (size_t i = 0; i < count; i++) {
        const uint32_t place = digits.places[passes - 1][digit_of(&digits, from[i], passes - 1)]++;
        list[(ptrdiff_t)place * step] = (uint32_t)from[i];
    }
}
