/* Measures by how many levels two pictures differ, and where pixels that differ lie most densely.
 */
#ifndef KILN_COMPARE_LEVELS_H
#define KILN_COMPARE_LEVELS_H

#include "compare/picture.h"

/* The difference of two pictures. A pixel's difference is that of its worst channel, alpha
 * included. */
struct kiln_level_difference {
    double maximum;     /* levels */
    double mean;        /* over all pixels and channels */
    double mean_square; /* mean of the squares, over all pixels and channels */
    uint64_t differing; /* pixels beyond the threshold */
    uint32_t x, y;      /* the first of the worst pixels */
    uint32_t window_width,
        window_height;           /* the window's edge, or the picture's where that is less */
    uint32_t window_x, window_y; /* the upper left corner of the densest window */
    uint64_t window_differing;   /* differing pixels in that window */
};

/* Measures the difference. A pixel counts as differing if it differs by more than threshold levels
 * (0 or more). The densest window is the one of window x window pixels (1 or more) with most
 * differing pixels. The two pictures must match. False with KILN_DEVICE_FAILED when memory is
 * short. */
bool kiln_level_difference_measure(const struct kiln_compare_picture *reference,
                                   const struct kiln_compare_picture *test, double threshold,
                                   uint32_t window, struct kiln_level_difference *difference,
                                   struct kiln_error *error);

#endif
