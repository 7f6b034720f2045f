/* Checks that the font of figures has all characters of the texts of a figure. */
#ifndef KILN_FIGURE_LETTERING_H
#define KILN_FIGURE_LETTERING_H

#include "kiln_program.h"

/* Checks that the font has every character of a text. KILN_USAGE names the first one that it does
 * not have as itself and as U+XXXX, and where it stands; `place` ("--title") starts the message. */
bool kiln_lettering_check(const char *text, const char *place, struct kiln_error *error);

/* Checks in the same way the title and the labels that a figure was given, and that its text for
 * screen readers is UTF-8. */
bool kiln_lettering_check_request(const struct kiln_figure_params *params,
                                  struct kiln_error *error);

/* Checks in the same way a label that a panel has without being given one; panels count from 0. */
bool kiln_lettering_check_label(const char *label, size_t panel, struct kiln_error *error);

#endif
