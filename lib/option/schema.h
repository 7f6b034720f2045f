/* Pieces of JSON schema that several types share. */
#ifndef KILN_SCENE_SCHEMA_H
#define KILN_SCENE_SCHEMA_H

#include "option/option.h"

/* A number with or without its unit, by the option's dimension and limits. */
void kiln_schema_number(const struct kiln_option *option, struct kiln_text *out);

/* A mapping of exactly the members of a table and, unless variant is NULL, of `field: variant`. */
void kiln_schema_members(const struct kiln_option *members, const char *variant,
                         bool variant_required, struct kiln_text *out);

/* A regular expression for a number in a dimension, as used in the names of keys: "0.5", "3 s". */
void kiln_schema_number_pattern(enum kiln_dimension dimension, struct kiln_text *out);

#endif
