/* Judges whether a figure that was drawn again is what its sidecar says. */
#ifndef KILN_FIGURE_VERDICT_H
#define KILN_FIGURE_VERDICT_H

#include "figure/format.h"
#include "figure/record.h"
#include "kiln_program.h"

/* A figure as it is drawn now. */
struct kiln_fresh_figure {
    const struct kiln_panels *panels;
    const struct kiln_pixels *pixels;
    const char *hash;
    const struct kiln_figure_format *format;
    const char *path;    /* path of the figure's file, for messages */
    const uint8_t *file; /* bytes of that file */
    size_t file_size;
    uint32_t threads;
};

/* Fills in whether the figure is stale and why. If the same device, driver and processor drew it,
 * the hash of its pixels decides; else, if scene and simulation are the same, the default limits of
 * kiln compare do. */
bool kiln_figure_judge(const struct kiln_record *record, const struct kiln_fresh_figure *fresh,
                       struct kiln_figure_result *result, struct kiln_error *error);

#endif
