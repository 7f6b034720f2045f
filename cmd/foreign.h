/* Suggests kiln's option for an option of another program that a user typed. */
#ifndef KILN_CMD_FOREIGN_H
#define KILN_CMD_FOREIGN_H

#include "options.h"

/* Writes what kiln has in place of a foreign option: " (did you mean '--force'?)", or "; " and a
 * sentence. `typed` is the argument with its dashes, without '=' and a value. Returns false when
 * the table has no row for it, or when the command has no option that the row names. */
enum { FOREIGN_SIZE = 192 };
bool foreign_suggest(char out[FOREIGN_SIZE], const char *typed, const struct option *options,
                     size_t option_count);

#endif
