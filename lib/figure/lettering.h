/* Checks that the font of figures has all characters of the texts of a figure. */
#ifndef KILN_FIGURE_LETTERING_H
#define KILN_FIGURE_LETTERING_H

#include "kiln_program.h"

/* Checks that the font has every character of a text. The message of KILN_USAGE begins with `place`
 * ("--title") and names the first character without a glyph, its code as U+XXXX, and its
 * position. */
bool kiln_lettering_check(const char *text, const char *place, struct kiln_error *error);

/* Checks the title and the labels of a request as kiln_lettering_check does, and that the text for
 * screen readers is UTF-8. */
bool kiln_lettering_check_request(const struct kiln_figure_params *params,
                                  struct kiln_error *error);

/* Checks a label that kiln itself gave to a panel, as kiln_lettering_check does. Panels count from
 * 0. */
bool kiln_lettering_check_label(const char *label, size_t panel, struct kiln_error *error);

#endif
