/* Draws a frame with another kiln program, for `kiln test --against PROGRAM`. */
#ifndef KILN_SUITE_AGAINST_H
#define KILN_SUITE_AGAINST_H

#include "suite/test_case.h"

/* Draws the frame with the program params->against into the file `picture`, and adds a note if its
 * pixels differ from the accepted ones. If the program cannot be run, refuses the scene or writes
 * no picture, it adds a note instead, leaves no file and returns true. Returns false only if there
 * is no path for the program's output or memory is short: KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_test_case_draw_against(struct kiln_test_case *test_case, struct kiln_result_frame *frame,
                                 const char *picture, struct kiln_error *error);

#endif
