/* Draws the accepted side of a frame with another kiln. */
#ifndef KILN_SUITE_AGAINST_H
#define KILN_SUITE_AGAINST_H

#include "suite/trial.h"

/* Draws the frame with the program that the parameters name, into a picture of the test's results,
 * and notes where its pixels are not those that were accepted. A program that cannot be run,
 * refuses the scene or writes no picture is a note, and leaves no picture. KILN_IO,
 * KILN_DEVICE_FAILED. */
bool kiln_trial_draw_against(struct kiln_trial *trial, struct kiln_result_frame *frame,
                             const char *picture, struct kiln_error *error);

#endif
