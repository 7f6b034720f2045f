/* Finds the format of a figure by the end of its name. */
#ifndef KILN_FIGURE_FORMAT_H
#define KILN_FIGURE_FORMAT_H

#include "figure/drawing.h"

/* A file format. One of the two functions is set: raster formats are made of pixels, vector formats
 * of a drawing. */
struct kiln_figure_format {
    const char *suffix;
    bool (*of_pixels)(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                      uint8_t **bytes, size_t *size, struct kiln_error *error);
    bool (*of_drawing)(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                       struct kiln_error *error);
};

/* Returns the format that the suffix of a file's name stands for; NULL with KILN_USAGE, whose
 * message names all suffixes. */
const struct kiln_figure_format *kiln_figure_format_find(const char *path,
                                                         struct kiln_error *error);

#endif
