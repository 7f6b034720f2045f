/* Applies --set key=value to a tree. */
#ifndef KILN_OPTION_OVERRIDE_H
#define KILN_OPTION_OVERRIDE_H

#include "option/reader.h"

/* Puts the value of "dotted.key=value" into a tree that the table describes, before anything of it
 * is read; mappings that are missing on the way are made, entries of lists and named entries are
 * not. The text need not outlive the call. */
bool kiln_override(struct kiln_reader *reader, const struct kiln_option *rows,
                   struct kiln_node *root, const char *text);

#endif
