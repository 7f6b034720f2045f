/* Defines the vectors of the gas solver: a row of a brick is 8 cells, and a traced cell 8 floats.
 */
#ifndef KILN_SIM_GAS_LANES_H
#define KILN_SIM_GAS_LANES_H

#include "base/eight.h"

/* Returns whether a lane of sums of zeros is NaN. */
SIMD bool has_nan(vf zeros)
{
    return any(~(zeros == 0.0f));
}

#endif
