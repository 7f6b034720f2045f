/* Declares how texts from untrusted files are made safe to show: kiln_shown of kiln_program.h uses
 * these functions on characters. */
#ifndef KILN_BASE_SHOWN_H
#define KILN_BASE_SHOWN_H

#include "kiln_program.h"

/* Decodes the character at the start of a zero-terminated text and returns the number of its bytes;
 * 0 where it is not UTF-8. */
size_t kiln_shown_character(const char *text, uint32_t *character);

/* Returns whether a character has an effect other than its glyph: controls (C0 with line ends and
 * ESC, DEL, C1), line and paragraph separators, and marks and overrides of direction, which make
 * neighbouring text look different. */
bool kiln_shown_acts(uint32_t character);

#endif
