/* Makes a JSON schema smaller: what it says in several places becomes a definition. */
#ifndef KILN_OPTION_SCHEMA_SHARE_H
#define KILN_OPTION_SCHEMA_SHARE_H

#include "base/text.h"

/* Appends a schema, which is the text of a JSON object, to `out`. Schemas within it that stand
 * there more than once become references to definitions, which are appended to `definitions` as
 * members of an object, each with a comma before it. A definition is named by the key that it is of
 * first.
 */
void kiln_schema_share(const char *schema, struct kiln_text *out, struct kiln_text *definitions);

#endif
