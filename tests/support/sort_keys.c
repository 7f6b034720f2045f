/* Makes lists of keys that are hard to sort, and gives qsort the order that kiln's sorts must have,
 * for tests of lib/sort. */
#include "support/sort_keys.h"

#include "shared/random.h"
#include "sort/pairs.h"

uint32_t key_of(enum pattern pattern, uint32_t i, uint32_t count)
{
    switch (pattern) {
    case RANDOM:
        return random_mix(i);
    case SORTED:
        return i * 3;
    case REVERSED:
        return UINT32_MAX - i;
    case EQUAL:
        return 0x40000000u;
    case LOW_BITS:
        return random_mix(i) & 3u;
    case HIGH_BITS:
        return random_mix(i) & 0xc0000000u;
    case FEW: /* keys at the borders of radix digits of 6, 8, 11, 12, 22 and 24 bits */
        return (const uint32_t[]){0,     63,     64,       255,      256,       0x7ff,
                                  0x800, 0x1000, 0x3fffff, 0x400000, 0x1000000, UINT32_MAX}
            [random_mix(i) % 12];
    case LARGEST:
        return UINT32_MAX - random_mix(i) % 2u;
    default:
        return i == count / 2 ? 1 : 2;
    }
}

int by_pair(const void *a, const void *b)
{
    kiln_sort_pair x = *(const kiln_sort_pair *)a, y = *(const kiln_sort_pair *)b;
    return (x > y) - (x < y);
}
