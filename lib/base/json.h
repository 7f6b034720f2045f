/* Declares the JSON writer that writes into a text in memory. The library calls it for JSON that it
 * builds as a whole before it stores it: manifests, lines of a journal, results of tests, layouts
 * of flipbooks. kiln_json.h has the writer into a file and the functions that add to either. */
#ifndef KILN_BASE_JSON_H
#define KILN_BASE_JSON_H

#include "base/text.h"
#include "kiln_program.h"

/* Returns a writer that adds to a text. The writer keeps the pointer, so the text must not be moved
 * before kiln_json_finish. The writer fails when memory for the text is short. */
struct kiln_json kiln_json_to_text(struct kiln_text *text);

#endif
