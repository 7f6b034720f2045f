/* The formats of figures, by the ends of their names. */
#ifndef KILN_FIGURE_FORMAT_H
#define KILN_FIGURE_FORMAT_H

#include "figure/drawing.h"

/* One of the two is set. */
struct kiln_figure_format {
    const char *suffix;
    bool (*of_pixels)(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                      uint8_t **bytes, size_t *size, struct kiln_error *error);
    bool (*of_drawing)(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                       struct kiln_error *error);
};

/* The format of a file by its name; NULL with KILN_USAGE, naming those that there are. */
const struct kiln_figure_format *kiln_figure_format_find(const char *path,
                                                         struct kiln_error *error);

#endif
