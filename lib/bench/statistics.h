/* Times in short: medians and quartiles, which a few disturbed turns do not move. */
#ifndef KILN_BENCH_STATISTICS_H
#define KILN_BENCH_STATISTICS_H

#include <stddef.h>
#include <stdint.h>

struct kiln_spread {
    uint32_t count; /* 0: nothing was measured, and the rest is 0 */
    double least, first_quartile, median, third_quartile, most;
};

/* Quartiles lie between neighbours where they fall between them (R's type 7). At most
 * KILN_BENCH_MAX_REPETITIONS values. */
struct kiln_spread kiln_spread_of(const double *values, size_t count);

/* Of over[i] / under[i]: what was measured in the same turn. Pairs without a positive divisor do
 * not count. */
struct kiln_spread kiln_spread_of_ratios(const double *over, const double *under, size_t count);

/* The p of y ~ x^p by least squares over logarithms; 1 is linear. Points that have none do not
 * count; NaN with fewer than two. */
double kiln_growth(const double *x, const double *y, size_t count);

#endif
