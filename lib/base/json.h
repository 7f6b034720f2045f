/* Makes a JSON writer that writes into memory, for JSON that must be complete before it is stored:
 * manifests, lines of a journal, result.json of `kiln test`, layouts of flipbooks. kiln_json.h,
 * which is part of kiln_program.h, declares the writer, its functions, and a way to write into a
 * file instead. */
#ifndef KILN_BASE_JSON_H
#define KILN_BASE_JSON_H

#include "base/text.h"
#include "kiln_program.h"

/* Returns a writer that adds to a text. The writer keeps the pointer, so the struct must stay where
 * it is until kiln_json_finish, which returns false if memory was short. */
struct kiln_json kiln_json_to_text(struct kiln_text *text);

#endif
