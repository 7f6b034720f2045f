/* Lets the arithmetic of cells of gas be of single numbers. */
#ifndef KILN_SIM_GAS_NUMBERS_GLSL
#define KILN_SIM_GAS_NUMBERS_GLSL

#include "shared/exact.h"

#define REAL                        float
#define REAL_FN                     FN
#define REAL_ALL(x)                 (x)
#define REAL_SELECT(holds, yes, no) ((holds) ? (yes) : (no))
#define REAL_BOTH(a, b)             ((a) && (b))
#define REAL_MIN(a, b)              exact_min(a, b)
#define REAL_MAX(a, b)              exact_max(a, b)
#define REAL_ABS(x)                 exact_abs(x)
#define REAL_RCP(x)                 exact_rcp_within(x)
#define REAL_RSQRT(x)               exact_rsqrt_within(x)
#include "shared/gas_move.h"

#endif
