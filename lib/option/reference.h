/* Declares functions that print and visit the reference of a table's keys. */
#ifndef KILN_OPTION_REFERENCE_H
#define KILN_OPTION_REFERENCE_H

#include "kiln_program.h"
#include "option/option.h"

/* Writes the introduction as plain text and then, for each key of the table and of the tables
 * nested in it, its help, its allowed values and its default. */
bool kiln_reference_write(FILE *out, const char *introduction, const struct kiln_option *rows);

/* Writes those keys, as kiln_reference_write does, that lie at or below `below`, such as
 * systems.fire.look, and mention a text in their name, help or values; NULL: all. *count: how many
 * were written. */
bool kiln_reference_write_some(FILE *out, const struct kiln_option *rows, const char *below,
                               const char *text, size_t *count);

/* Visits the keys in the order of the reference. The texts are valid until `visit` returns. Returns
 * false when memory is short. */
bool kiln_reference_visit(const struct kiln_option *rows,
                          void (*visit)(void *user, const struct kiln_option_key *key), void *user);

#endif
