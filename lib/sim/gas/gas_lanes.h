/* Defines the vectors of the gas solver: a row of a brick is 8 cells, and a traced cell 8 floats.
 */
#ifndef KILN_SIM_GAS_LANES_H
#define KILN_SIM_GAS_LANES_H

#include "base/eight.h"

/* The arithmetic of cells, for a vector of them. */
#define REAL                        vf
#define REAL_FN                     SIMD
#define REAL_ALL(x)                 vf_all(x)
#define REAL_SELECT(holds, yes, no) vf_select(holds, yes, no)
#define REAL_BOTH(a, b)             ((a) & (b))
#define REAL_MIN(a, b)              vf_min(a, b)
#define REAL_MAX(a, b)              vf_max(a, b)
#define REAL_ABS(x)                 vf_abs(x)
#define REAL_RCP(x)                 vf_rcp_within(x)
#define REAL_RSQRT(x)               vf_rsqrt(x)
#include "shared/gas_cell.h"
#include "shared/gas_move.h"

/* Returns whether a lane of sums of zeros is NaN. */
SIMD bool has_nan(vf zeros)
{
    return any(~(zeros == 0.0f));
}

#endif
