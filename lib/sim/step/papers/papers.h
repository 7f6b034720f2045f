/* Declares the techniques of the simulation that `auto` never takes. They are there to be compared
 * with the papers that describe them. */
#ifndef KILN_SIM_STEP_PAPERS_H
#define KILN_SIM_STEP_PAPERS_H

#include "sim/step/row.h"

extern const struct kiln_simulate_row kiln_simulate_pingpong_row; /* two buffers: pingpong.c */
extern const struct kiln_simulate_row kiln_simulate_feedback_row; /* a stream: feedback.c */
extern const struct kiln_simulate_row kiln_simulate_texels_row;   /* textures: texels.c */

#endif
