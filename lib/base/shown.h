/* Texts out of files that strangers may have written, on their way to a person: kiln_shown of
 * kiln_program.h, and what it knows of characters. */
#ifndef KILN_BASE_SHOWN_H
#define KILN_BASE_SHOWN_H

#include "kiln_program.h"

/* The character at the start of a zero-terminated text, and its bytes; 0 where it is no UTF-8. */
size_t kiln_shown_character(const char *text, uint32_t *character);

/* Whether a character does something else than to show itself: controls (C0 with line ends and ESC,
 * DEL, C1), line and paragraph separators, marks and overrides of direction, which make what stands
 * beside them look like something else. */
bool kiln_shown_acts(uint32_t character);

#endif
