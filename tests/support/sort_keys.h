/* Makes lists of keys that are hard to sort (key_of), and compares pairs of a key and an index
 * (by_pair), so that qsort gives the order that every sort of kiln must give. */
#ifndef KILN_TESTS_SORT_KEYS_H
#define KILN_TESTS_SORT_KEYS_H

#include <stdint.h>

/* Names the patterns of a list's keys; the last constant is their number. */
enum pattern {
    RANDOM,
    SORTED,
    REVERSED,
    EQUAL,
    LOW_BITS,    /* keys that differ only in the lowest two bits */
    HIGH_BITS,   /* keys that differ only in the highest two bits */
    FEW,         /* 12 different keys, at the borders between a radix sort's digits */
    LARGEST,     /* UINT32_MAX, with which sorts pad a list, and UINT32_MAX - 1 */
    ONE_ODD_ONE, /* equal keys, except for a smaller one in the middle */
    PATTERNS
};

/* Returns key i of a list of `count` keys. */
uint32_t key_of(enum pattern pattern, uint32_t i, uint32_t count);

/* Compares two values of kiln_sort_pair for qsort: by the key, then by the lower 32 bits. If these
 * bits are the index in the list, the order is that of a stable sort. */
int by_pair(const void *a, const void *b);

#endif
