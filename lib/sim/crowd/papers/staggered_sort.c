/* Sorts the entries of a grid by their cells: a radix sort from the lowest digit, in threads. The
 * entries are cut into ranges. Each range counts its digits, and puts the entries of a digit behind
 * those of earlier ranges. The order is therefore the same for any number of ranges. */
#include "sim/crowd/papers/staggered_sort.h"

#include <assert.h>
#include <string.h>

enum { DIGIT_BITS = 11 };

static_assert(KILN_SORT_DIGITS == 1 << DIGIT_BITS, "of that many bits");

size_t kiln_sort_stretch(size_t count, uint32_t stretch, uint32_t stretches)
{
    return count * stretch / stretches;
}

uint32_t kiln_sort_stretches(const struct kiln_threads *threads)
{
    /* more ranges than threads, since some threads begin late */
    const uint32_t count = 2 * kiln_threads_count(threads);
    return count < KILN_SORT_STRETCHES ? count : KILN_SORT_STRETCHES;
}

struct pass {
    const struct kiln_interact_entry *from;
    struct kiln_interact_entry *to;
    uint32_t *counts;
    size_t count;
    uint32_t stretches, shift;
};

static uint32_t digit(const struct kiln_interact_entry *entry, uint32_t shift)
{
    return (uint32_t)(entry->cell >> shift) & (KILN_SORT_DIGITS - 1);
}

static void count_digits(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass *pass = context;
    for (size_t s = begin; s < end; s++) {
        uint32_t *counts = pass->counts + s * KILN_SORT_DIGITS;
        const size_t last = kiln_sort_stretch(pass->count, (uint32_t)s + 1, pass->stretches);
        memset(counts, 0, KILN_SORT_DIGITS * sizeof *counts);
        for (size_t i = kiln_sort_stretch(pass->count, (uint32_t)s, pass->stretches); i < last; i++)
            counts[digit(&pass->from[i], pass->shift)]++;
    }
}

/* Turns the counts into the place where each range puts its first entry of each digit. */
static void find_places(const struct pass *pass)
{
    uint32_t before = 0;
    for (size_t d = 0; d < KILN_SORT_DIGITS; d++) {
        for (size_t s = 0; s < pass->stretches; s++) {
            uint32_t *place = &pass->counts[s * KILN_SORT_DIGITS + d];
            const uint32_t here = *place;
            *place = before;
            before += here;
        }
    }
}

static void move(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass *pass = context;
    for (size_t s = begin; s < end; s++) {
        uint32_t *places = pass->counts + s * KILN_SORT_DIGITS;
        const size_t last = kiln_sort_stretch(pass->count, (uint32_t)s + 1, pass->stretches);
        for (size_t i = kiln_sort_stretch(pass->count, (uint32_t)s, pass->stretches); i < last; i++)
            pass->to[places[digit(&pass->from[i], pass->shift)]++] = pass->from[i];
    }
}

void kiln_interact_sort(const struct kiln_interact_sorting *sorting)
{
    struct kiln_interact_entry *from = sorting->entries, *to = sorting->scratch;
    const uint32_t stretches = kiln_sort_stretches(sorting->threads);
    for (uint32_t shift = 0; shift < sorting->bits; shift += DIGIT_BITS) {
        struct pass pass = {.from = from,
                            .to = to,
                            .counts = sorting->counts,
                            .count = sorting->count,
                            .stretches = stretches,
                            .shift = shift};
        kiln_threads_for(sorting->threads, stretches, 1, count_digits, &pass);
        find_places(&pass);
        kiln_threads_for(sorting->threads, stretches, 1, move, &pass);
        struct kiln_interact_entry *swap = from;
        from = to;
        to = swap;
    }
    if (from != sorting->entries)
        memcpy(sorting->entries, from, sorting->count * sizeof *from);
}
