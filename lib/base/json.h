/* Declares a JSON writer that adds to a growing text; kiln.h declares the other functions of the
 * writer. */
#ifndef KILN_BASE_JSON_H
#define KILN_BASE_JSON_H

#include "base/text.h"
#include "kiln_program.h"

/* A writer that adds to a text, which must stay where it is. It fails when the text does. */
struct kiln_json kiln_json_to_text(struct kiln_text *text);

#endif
