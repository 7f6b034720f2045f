/* Prints the results of `kiln compare`. */
#ifndef KILN_CMD_COMPARE_REPORT_H
#define KILN_CMD_COMPARE_REPORT_H

#include "kiln_program.h"

/* The paths of the compared pictures, as the user typed them, and how to print the results. */
struct compare_report {
    const char *reference, *test;
    bool json; /* an object a line, whose "event" is frame or result */
    bool quiet;
    bool stats;                     /* print times, too */
    struct kiln_compare_frame only; /* the last frame; printed for a pair of single pictures */
    char note[256];                 /* its message, if it was measured */
    bool colors_equal;              /* of that frame: no number of a layer of colours differs */
    bool has_layers;                /* of that frame: print_layers printed its layers */
};

/* Prints the result of a frame; called after each compared frame. */
void compare_report_frame(struct compare_report *report, const struct kiln_compare_result *result,
                          const struct kiln_compare_frame *frame);

/* Prints the result of the comparison; called once at its end, also after an error. */
void compare_report_result(const struct compare_report *report,
                           const struct kiln_compare_result *result);

#endif
