/* Places insets, which are parts of pictures that a figure shows enlarged. */
#ifndef KILN_FIGURE_INSET_H
#define KILN_FIGURE_INSET_H

#include "kiln_program.h"

enum { KILN_MAX_INSETS = 4 };

struct kiln_rect {
    uint32_t x, y, width, height; /* pixels */
};

/* Returns the rectangle of an inset in pixels of a picture of that size. kiln_insets_check must
 * have passed the inset. */
struct kiln_rect kiln_inset_rect(const struct kiln_figure_inset *inset, uint32_t width,
                                 uint32_t height);

/* Checks that all insets lie in a picture of that size. The message of KILN_USAGE names an inset
 * that does not, or says how many insets there may be. */
bool kiln_insets_check(const struct kiln_figure_params *params, uint32_t width, uint32_t height,
                       struct kiln_error *error);

#endif
