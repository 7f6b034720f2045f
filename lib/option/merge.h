/* Lays one mapping under another, as `include` and `use` do: keys that the upper one has stay, and
 * the others are added. */
#ifndef KILN_OPTION_MERGE_H
#define KILN_OPTION_MERGE_H

#include "option/option.h"

/* Moves the entries of `under` into `own`, a mapping that the rows describe. Where both have a
 * mapping of keys or of names, the mappings merge; lists, values and kinds of another name stay as
 * they are in `own`. Entries are added at the end, in their order. `under` may not be used
 * afterwards. */
bool kiln_merge_members(struct kiln_node *own, struct kiln_node *under,
                        const struct kiln_option *rows, struct kiln_error *error);

/* Does the same for two entries of a mapping of names that the row describes. */
bool kiln_merge_entry(struct kiln_node *own, struct kiln_node *under, const struct kiln_option *row,
                      struct kiln_error *error);

/* Returns whether a row is a mapping of names in a tree: a map, or a list that is written as one.
 */
bool kiln_merge_is_of_names(const struct kiln_option *row, const struct kiln_node *node);

#endif
