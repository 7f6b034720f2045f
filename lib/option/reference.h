/* The reference of a table's keys, for people. */
#ifndef KILN_SCENE_REFERENCE_H
#define KILN_SCENE_REFERENCE_H

#include "option/option.h"

/* Writes the introduction and, for each key of the table and of the tables in it, what it is for,
 * what is allowed and the default. */
bool kiln_reference_write(FILE *out, const char *introduction, const struct kiln_option *rows);

#endif
