/* Sorts by bitonic sort as UberFlow compares it (4.3.2, 4.3.3 and table 1): each pass is a kernel
 * over a field of pairs in rows. Three variants differ by how the comparator's constants reach the
 * kernel. All sort like technique `bitonic`; they exist to be measured. */
#ifndef KILN_BENCH_PAPERS_BITONIC_FIELD_H
#define KILN_BENCH_PAPERS_BITONIC_FIELD_H

#include "sort/network.h"

enum kiln_field_constants {
    KILN_FIELD_COMPUTED, /* each element computes the constants from the pass's number */
    KILN_FIELD_PASSED,   /* a table has the constants for each column and row */
    KILN_FIELD_PACKED,   /* like PASSED, with two pairs in an element */
};

struct kiln_bitonic_field;

/* Creates a field. Returns NULL with an error. */
struct kiln_bitonic_field *kiln_bitonic_field_create(struct kiln_device *device,
                                                     enum kiln_field_constants constants,
                                                     struct kiln_error *error);
void kiln_bitonic_field_destroy(struct kiln_bitonic_field **field);

/* Returns the network that lists the keys and sorts them; it lives as long as the field. */
struct kiln_network *kiln_bitonic_field_network(struct kiln_bitonic_field *field);

/* Makes later runs sort only within sets of `rows` consecutive rows, a power of two; 0: the whole
 * field (UberFlow, 5). */
void kiln_bitonic_field_restrict(struct kiln_bitonic_field *field, uint32_t rows);

/* Returns the length of a row in a field of `padded` pairs, a power of two. Fields are square, or
 * twice as wide as high. */
uint32_t kiln_bitonic_field_width(uint32_t padded);

#endif
