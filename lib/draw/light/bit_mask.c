/* This file rasterises triangles into a mask of bits, in rows of words. */
#include "draw/light/bit_mask.h"

#include <assert.h>

#include "shared/exact.h"

/* Returns the first bit whose centre is at or after x. */
static int32_t bit_from(float x, int32_t bits)
{
    const float at = x - 0.5f;
    if (!(at > 0.0f))
        return 0;
    const int32_t whole = at < (float)bits ? exact_int(at) : bits;
    return whole + ((float)whole < at && whole < bits ? 1 : 0);
}

static void set_bits(uint64_t *row, int32_t from, int32_t to)
{
    for (int32_t word = from / 64; from < to; word++) {
        const int32_t end = (word + 1) * 64 < to ? (word + 1) * 64 : to;
        const int32_t count = end - from;
        row[word] |= (count == 64 ? ~UINT64_C(0) : ((UINT64_C(1) << count) - 1)) << from % 64;
        from = end;
    }
}

void kiln_bit_mask_add(const struct kiln_bit_mask *mask, const float p[3][2])
{
    const int32_t bits = mask->edge;
    const float low = exact_min(p[0][1], exact_min(p[1][1], p[2][1]));
    const float high = exact_max(p[0][1], exact_max(p[1][1], p[2][1]));
    float slopes[3];
    for (int k = 0; k < 3; k++) {
        const float *a = p[k], *b = p[(k + 1) % 3];
        slopes[k] = b[1] != a[1] ? (b[0] - a[0]) / (b[1] - a[1]) : 0.0f;
    }
    for (int32_t y = bit_from(low, bits), end = bit_from(high, bits); y < end; y++) {
        const float middle = (float)y + 0.5f;
        float from = (float)bits, to = 0.0f;
        for (int k = 0; k < 3; k++) {
            const float *a = p[k], *b = p[(k + 1) % 3];
            if ((a[1] <= middle) == (b[1] <= middle))
                continue;
            const float x = a[0] + (middle - a[1]) * slopes[k];
            from = exact_min(from, x);
            to = exact_max(to, x);
        }
        set_bits(mask->rows + (size_t)y * mask->words, bit_from(from, bits), bit_from(to, bits));
    }
}

/* Returns the number of bits that are 1. For __builtin_popcountll, gcc calls a function that looks
 * bytes up in a table, since not every x86-64 processor has the instruction. */
static uint32_t count_bits(uint64_t x)
{
    const uint64_t pairs = x - (x >> 1 & 0x5555555555555555u);
    const uint64_t fours = (pairs & 0x3333333333333333u) + (pairs >> 2 & 0x3333333333333333u);
    const uint64_t bytes = (fours + (fours >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (uint32_t)(bytes * 0x0101010101010101u >> 56);
}

float kiln_bit_mask_part(const struct kiln_bit_mask *mask, size_t x, size_t y)
{
    static_assert(KILN_BIT_CELL * KILN_BIT_CELL <= 64, "a cell fits into a word");
    const size_t bit = x * KILN_BIT_CELL;
    uint64_t cell = 0;
    for (size_t i = 0; i < KILN_BIT_CELL; i++) {
        const uint64_t word = mask->rows[(y * KILN_BIT_CELL + i) * mask->words + bit / 64];
        cell = cell << KILN_BIT_CELL | (word >> bit % 64 & ((1u << KILN_BIT_CELL) - 1));
    }
    return (float)count_bits(cell) / (KILN_BIT_CELL * KILN_BIT_CELL);
}
