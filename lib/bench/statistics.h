/* Summarizes measured times by medians and quartiles, which a few disturbed turns do not move. */
#ifndef KILN_BENCH_STATISTICS_H
#define KILN_BENCH_STATISTICS_H

#include <stddef.h>
#include <stdint.h>

struct kiln_spread {
    uint32_t count; /* 0: nothing was measured, and all other members are 0 */
    double least, first_quartile, median, third_quartile, most;
};

/* Returns the spread of up to KILN_BENCH_MAX_REPETITIONS values. Quartiles are interpolated between
 * neighbours (R's type 7). */
struct kiln_spread kiln_spread_of(const double *values, size_t count);

/* Returns the spread of the ratios over[i] / under[i], whose two values were measured in the same
 * turn. Pairs whose divisor is not positive do not count. */
struct kiln_spread kiln_spread_of_ratios(const double *over, const double *under, size_t count);

/* Fits y ~ x^p by least squares over logarithms and returns p; 1 is linear growth. Points with a
 * value that is not positive do not count. Returns NaN where the points have fewer than two values
 * of x. */
double kiln_growth(const double *x, const double *y, size_t count);

#endif
