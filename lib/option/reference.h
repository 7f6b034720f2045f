/* Prints the reference of a table's keys, as text to read. */
#ifndef KILN_OPTION_REFERENCE_H
#define KILN_OPTION_REFERENCE_H

#include "kiln_program.h"
#include "option/option.h"

/* Writes the introduction and, for each key of the table and of the tables in it, what it is for,
 * what is allowed and the default. */
bool kiln_reference_write(FILE *out, const char *introduction, const struct kiln_option *rows);

/* Visits the keys in the same order; the texts last until the visit returns. False when memory is
 * short. */
bool kiln_reference_visit(const struct kiln_option *rows,
                          void (*visit)(void *user, const struct kiln_option_key *key), void *user);

#endif
