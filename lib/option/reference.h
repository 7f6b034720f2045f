/* Declares functions that print and visit the reference of a table's keys. */
#ifndef KILN_OPTION_REFERENCE_H
#define KILN_OPTION_REFERENCE_H

#include "kiln_program.h"
#include "option/option.h"

/* Writes the introduction as plain text and then, for each key of the table and of the tables
 * nested in it, its help, its allowed values and its default. */
bool kiln_reference_write(FILE *out, const char *introduction, const struct kiln_option *rows);

/* Visits the keys in the order of the reference. The texts are valid until `visit` returns. Returns
 * false when memory is short. */
bool kiln_reference_visit(const struct kiln_option *rows,
                          void (*visit)(void *user, const struct kiln_option_key *key), void *user);

#endif
