/* Least significant digit first, 11 bits a pass. Each thread owns one stretch of the pairs: it
 * counts the digits in it, and after a sum over (digit, stretch) knows where each of its pairs
 * goes, so the result is stable and the same for any number of threads. */
#include "sort/pairs.h"

#include <stdbool.h>
#include <string.h>

enum {
    DIGIT_BITS = 11,
    DIGITS = 1 << DIGIT_BITS,
    PASSES = 3,
    LEAST_STRETCH = 8192, /* pairs; shorter ones are not worth a thread */
};

struct pass {
    const kiln_sort_pair *from;
    kiln_sort_pair *to;
    size_t count;
    uint32_t stretches;
    unsigned shift;
    uint32_t *places; /* DIGITS a stretch: first counts, then places in `to` */
};

size_t kiln_sort_count_words(const struct kiln_threads *threads)
{
    return (size_t)kiln_threads_count(threads) * DIGITS;
}

static size_t stretch_begin(const struct pass *pass, size_t stretch)
{
    return pass->count * stretch / pass->stretches;
}

static uint32_t digit_of(const struct pass *pass, kiln_sort_pair pair)
{
    return (uint32_t)(pair >> pass->shift) & (DIGITS - 1);
}

static void count_digits(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass *pass = context;
    for (size_t stretch = begin; stretch < end; stretch++) {
        uint32_t *counts = pass->places + stretch * DIGITS;
        memset(counts, 0, DIGITS * sizeof *counts);
        size_t last = stretch_begin(pass, stretch + 1);
        for (size_t i = stretch_begin(pass, stretch); i < last; i++)
            counts[digit_of(pass, pass->from[i])]++;
    }
}

/* Turns counts into places. False when all pairs have the same digit: nothing would move. */
static bool sum_counts(const struct pass *pass)
{
    uint32_t place = 0;
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        uint32_t before = place;
        for (uint32_t stretch = 0; stretch < pass->stretches; stretch++) {
            uint32_t *at = &pass->places[(size_t)stretch * DIGITS + digit];
            uint32_t count = *at;
            *at = place;
            place += count;
        }
        if (place - before == pass->count)
            return false;
    }
    return true;
}

static void move_pairs(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass *pass = context;
    for (size_t stretch = begin; stretch < end; stretch++) {
        uint32_t *places = pass->places + stretch * DIGITS;
        size_t last = stretch_begin(pass, stretch + 1);
        for (size_t i = stretch_begin(pass, stretch); i < last; i++)
            pass->to[places[digit_of(pass, pass->from[i])]++] = pass->from[i];
    }
}

kiln_sort_pair *kiln_sort_pairs(struct kiln_threads *threads, kiln_sort_pair *pairs,
                                kiln_sort_pair *scratch, size_t count, uint32_t *counts)
{
    size_t useful = count / LEAST_STRETCH + 1;
    uint32_t most = kiln_threads_count(threads);
    struct pass pass = {
        .count = count,
        .stretches = useful < most ? (uint32_t)useful : most,
    };
    pass.places = counts;
    kiln_sort_pair *sorted = pairs, *other = scratch;
    for (unsigned i = 0; i < PASSES && count > 1; i++) {
        pass.from = sorted;
        pass.to = other;
        pass.shift = 32 + i * DIGIT_BITS;
        kiln_threads_for(threads, pass.stretches, 1, count_digits, &pass);
        if (!sum_counts(&pass))
            continue;
        kiln_threads_for(threads, pass.stretches, 1, move_pairs, &pass);
        other = sorted;
        sorted = pass.to;
    }
    return sorted;
}
