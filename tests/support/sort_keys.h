/* Makes keys that are hard to sort, and compares pairs by the order that a sort must give. */
#ifndef KILN_TESTS_SORT_KEYS_H
#define KILN_TESTS_SORT_KEYS_H

#include <stdint.h>

enum pattern {
    RANDOM,
    SORTED,
    REVERSED,
    EQUAL,
    LOW_BITS,
    HIGH_BITS,
    FEW,
    LARGEST, /* the keys that pad a list, and their neighbours */
    ONE_ODD_ONE,
    PATTERNS
};

uint32_t key_of(enum pattern pattern, uint32_t i, uint32_t count);

/* Compares two pairs (kiln_sort_pair) for qsort: by key, then by place, which is the stable order.
 */
int by_pair(const void *a, const void *b);

#endif
