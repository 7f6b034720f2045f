/* Resolves the key `use` of named entries: a copy of another entry lies under those that have it.
 */
#ifndef KILN_OPTION_USE_H
#define KILN_OPTION_USE_H

#include "option/reader.h"

/* Resolves all uses in a mapping that the rows describe. A copy has all keys of the entry but
 * `enabled`. The reader has `counts`. */
bool kiln_use(struct kiln_reader *reader, const struct kiln_option *rows, struct kiln_node *root);

#endif
