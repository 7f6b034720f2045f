/* Radix sort by bytes. Crowds fill few of the bits of a cell, so bytes that are the same in all
 * entries are passed over. */
#include "sim/interact_sort.h"

#include <string.h>

enum { DIGITS = 256, DIGIT_BITS = 8, DIGIT_COUNT = 64 / DIGIT_BITS };

static uint32_t digit(const struct kiln_interact_entry *entry, int number)
{
    return (uint32_t)(entry->cell >> (number * DIGIT_BITS)) & (DIGITS - 1);
}

void kiln_interact_sort(struct kiln_interact_entry *entries, struct kiln_interact_entry *scratch,
                        size_t count)
{
    struct kiln_interact_entry *from = entries, *to = scratch;
    for (int number = 0; number < DIGIT_COUNT && count > 0; number++) {
        size_t places[DIGITS] = {0};
        for (size_t i = 0; i < count; i++)
            places[digit(&from[i], number)]++;
        if (places[digit(&from[0], number)] == count)
            continue;
        size_t before = 0;
        for (int d = 0; d < DIGITS; d++) {
            const size_t here = places[d];
            places[d] = before;
            before += here;
        }
        for (size_t i = 0; i < count; i++)
            to[places[digit(&from[i], number)]++] = from[i];
        struct kiln_interact_entry *swap = from;
        from = to;
        to = swap;
    }
    if (from != entries)
        memcpy(entries, from, count * sizeof *entries);
}
