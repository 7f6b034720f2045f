/* Declares the function that applies --set key=value to a tree. */
#ifndef KILN_OPTION_OVERRIDE_H
#define KILN_OPTION_OVERRIDE_H

#include "option/reader.h"

/* Sets the value of "dotted.key=value" in a tree that the table describes, before the tree is read
 * into a struct. Missing mappings along the key are added. Entries of lists and named entries must
 * exist. The text need not outlive the call. */
bool kiln_override(struct kiln_reader *reader, const struct kiln_option *rows,
                   struct kiln_node *root, const char *text);

/* Parses "key=value" and returns the value. *origin becomes the origin for messages, "--set key".
 * NULL with an error, with KILN_USAGE for a text of another form. */
struct kiln_node *kiln_override_value(struct kiln_reader *reader, const char *text,
                                      const struct kiln_origin **origin);

#endif
