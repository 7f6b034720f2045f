/* Finds the format of a figure by the end of its name. */
#ifndef KILN_FIGURE_FORMAT_H
#define KILN_FIGURE_FORMAT_H

#include "figure/drawing.h"

/* A format, which is made either of pixels or of a drawing: one of the two functions is set. */
struct kiln_figure_format {
    const char *suffix;
    bool (*of_pixels)(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                      uint8_t **bytes, size_t *size, struct kiln_error *error);
    bool (*of_drawing)(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                       struct kiln_error *error);
};

/* Returns the format of a file by its name; NULL with KILN_USAGE, which names all formats. */
const struct kiln_figure_format *kiln_figure_format_find(const char *path,
                                                         struct kiln_error *error);

#endif
