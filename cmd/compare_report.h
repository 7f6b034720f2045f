/* Prints the results of `kiln compare`. */
#ifndef KILN_CMD_COMPARE_REPORT_H
#define KILN_CMD_COMPARE_REPORT_H

#include "kiln_program.h"

/* Which pictures, as the person named them, and how to print. */
struct compare_report {
    const char *reference, *test;
    bool json; /* an object a line, whose "event" is frame or result */
    bool quiet;
    bool stats;                     /* with times */
    struct kiln_compare_frame only; /* of a pair of single pictures, for the text report */
};

/* After a frame. */
void compare_report_frame(struct compare_report *report, const struct kiln_compare_result *result,
                          const struct kiln_compare_frame *frame);

/* At the end. */
void compare_report_result(const struct compare_report *report,
                           const struct kiln_compare_result *result);

#endif
