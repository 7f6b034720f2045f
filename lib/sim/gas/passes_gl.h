/* Declares the passes of a substep of gas in GL. */
#ifndef KILN_SIM_GAS_PASSES_GL_H
#define KILN_SIM_GAS_PASSES_GL_H

#include "sim/gas/fields.h"

/* Solves for the pressure of a substep, whose right side is in GL, as job->cycles and job->residual
 * say. */
bool gas_solve_gl(struct gas_job *job);

#endif
