/* Declares functions that write the JSON schema of a table and the parts of schemas that several
 * types share. */
#ifndef KILN_OPTION_SCHEMA_H
#define KILN_OPTION_SCHEMA_H

#include "option/option.h"

/* Writes the schema of the files that the table reads. */
bool kiln_schema_write(FILE *out, const char *title, const struct kiln_option *rows);

/* Appends the schema of a number with or without its unit, from the option's dimension and
 * limits. */
void kiln_schema_number(const struct kiln_option *option, struct kiln_text *out);

/* Appends the schema of a mapping whose keys are exactly the members of a table and, unless variant
 * is NULL, `field: variant`. variant_required: `field` must be given. */
void kiln_schema_members(const struct kiln_option *members, const char *variant,
                         bool variant_required, struct kiln_text *out);

/* Appends a regular expression for a number in a dimension, as used in the names of keys: "0.5", "3
 * s". */
void kiln_schema_number_pattern(enum kiln_dimension dimension, struct kiln_text *out);

#endif
