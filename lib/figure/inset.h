/* Places insets: parts of pictures that a figure shows enlarged. */
#ifndef KILN_FIGURE_INSET_H
#define KILN_FIGURE_INSET_H

#include "kiln_program.h"

enum { KILN_MAX_INSETS = 4 };

struct kiln_rect {
    uint32_t x, y, width, height; /* pixels */
};

/* Returns the pixels of an inset that kiln_insets_check has passed. */
struct kiln_rect kiln_inset_rect(const struct kiln_figure_inset *inset, uint32_t width,
                                 uint32_t height);

/* Whether the insets lie in a picture of that size; KILN_USAGE names one that does not, or says how
 * many there may be. */
bool kiln_insets_check(const struct kiln_figure_params *params, uint32_t width, uint32_t height,
                       struct kiln_error *error);

#endif
