/* Lays out the panels of a figure, with their labels and insets, as a drawing. */
#ifndef KILN_FIGURE_LAYOUT_H
#define KILN_FIGURE_LAYOUT_H

#include "figure/panels.h"
#include "kiln_program.h"

/* Returns the colour of the paper, 0xRRGGBB. */
uint32_t kiln_layout_paper(bool dark);

/* Fills a drawing whose arena the caller has set. KILN_USAGE for an inset outside of a picture, for
 * a number of labels other than that of the panels, and for a figure that is too large. */
bool kiln_layout_make(struct kiln_drawing *drawing, const struct kiln_panels *panels,
                      const struct kiln_figure_params *params, struct kiln_error *error);

#endif
