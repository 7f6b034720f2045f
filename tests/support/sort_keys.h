/* Keys that are hard to sort, and the order that they must come in. */
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
    LARGEST, /* as those that pad */
    ONE_ODD_ONE,
    PATTERNS
};

uint32_t key_of(enum pattern pattern, uint32_t i, uint32_t count);

/* By key, then place: the stable order. */
int by_pair(const void *a, const void *b);

#endif
