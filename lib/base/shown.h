/* Declares two functions by which texts from untrusted files are made safe to show. kiln_shown
 * (kiln_program.h) escapes a whole text with them for a terminal; the writers of JSON, XML, HTML
 * and GitHub annotations, and the parser of scenes, call them as well. */
#ifndef KILN_BASE_SHOWN_H
#define KILN_BASE_SHOWN_H

#include "kiln_program.h"

/* Decodes the character at the start of a zero-terminated text and returns the number of its bytes.
 * Returns 0 if the bytes there are not valid UTF-8; `character` is then the first byte. The empty
 * text gives the character 0, of 1 byte. */
size_t kiln_shown_character(const char *text, uint32_t *character);

/* Returns whether a character must be escaped, because it does more than show its glyph, or has
 * none: controls (C0 with line ends and ESC, DEL, C1), line and paragraph separators, bidirectional
 * marks and overrides, which make neighbouring text look different, spaces other than the usual
 * one, and what has no width. */
bool kiln_shown_needs_escape(uint32_t character);

/* Writes the code of a character, such as "\u00a0", or of a byte that is no valid UTF-8. */
void kiln_shown_escape(uint32_t character, bool is_byte, char out[12]);

#endif
