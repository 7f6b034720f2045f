/* Reads colours that are written as the web writes them. */
#ifndef KILN_OPTION_COLOR_H
#define KILN_OPTION_COLOR_H

#include <stdbool.h>
#include <stddef.h>

/* Reads "#rrggbb", "#rgb" or a name of CSS, in upper or lower case. linear: red, green and blue, 0
 * to 1. Returns false for any other text, such as "transparent". */
bool kiln_color_parse(const char *text, float linear[3]);

enum { KILN_COLOR_NAMES = 148 };

/* Returns a name by its index, which is less than KILN_COLOR_NAMES. They are sorted. */
const char *kiln_color_name_at(size_t index);

#endif
