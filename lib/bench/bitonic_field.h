/* Sorts by bitonic sort as UberFlow compares it (4.3.2, 4.3.3 and table 1): each pass is a kernel
 * over a field of pairs in rows. Three variants differ by how the comparator's constants reach the
 * kernel. All sort like technique `bitonic`; they exist to be measured. */
#ifndef KILN_BENCH_BITONIC_FIELD_H
#define KILN_BENCH_BITONIC_FIELD_H

#include "sort/network.h"

enum kiln_field_constants {
    KILN_FIELD_COMPUTED, /* from the number of the pass, by each element */
    KILN_FIELD_PASSED,   /* from tables of columns and of rows */
    KILN_FIELD_PACKED,   /* the same, two pairs an element */
};

struct kiln_bitonic_field;

/* NULL with an error. */
struct kiln_bitonic_field *kiln_bitonic_field_create(struct kiln_device *device,
                                                     enum kiln_field_constants constants,
                                                     struct kiln_error *error);
void kiln_bitonic_field_destroy(struct kiln_bitonic_field **field);

/* The network that makes the list and sorts; it lives as long as the field. */
struct kiln_network *kiln_bitonic_field_network(struct kiln_bitonic_field *field);

/* Sorts only within sets of so many consecutive rows, a power of two; 0: all of the field
 * (UberFlow, 5). */
void kiln_bitonic_field_restrict(struct kiln_bitonic_field *field, uint32_t rows);

/* Returns the length of the rows of a field of so many pairs, a power of two. Fields are square, or
 * twice as wide as high. */
uint32_t kiln_bitonic_field_width(uint32_t padded);

#endif
