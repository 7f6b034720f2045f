/* Declares the order of names of numbered files. */
#ifndef KILN_BASE_ORDER_H
#define KILN_BASE_ORDER_H

#include <stdint.h>

/* Compares two names as strcmp does, but runs of digits as numbers: "2.png" comes before "10.png".
 * A minus sign belongs to a number at the start of a name and behind a separator that is neither a
 * letter nor a digit: "a.-2.png" comes before "a.1.png", but "a-2.png" after "a-1.png". Names that
 * are equal so far are ordered by their bytes, so that the order of different names is strict. */
int kiln_order_names(const char *a, const char *b);

/* Returns how many numbers lie between those of two names that differ in one number alone, at most
 * 999,999; 0 for other names. */
uint32_t kiln_order_gap(const char *a, const char *b);

#endif
