/* Computes medians, quartiles, ratios and powers of growth from measured values. */
#include "bench/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kiln_program.h"

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the quantile `part`, 0 to 1, of ascending values; it is interpolated between
 * neighbours. */
static double value_at(const double *values, size_t count, double part)
{
    double place = part * (double)(count - 1);
    size_t below = (size_t)place;
    if (below + 1 >= count)
        return values[count - 1];
    double between = place - (double)below;
    return values[below] + between * (values[below + 1] - values[below]);
}

struct kiln_spread kiln_spread_of(const double *values, size_t count)
{
    double sorted[KILN_BENCH_MAX_REPETITIONS];
    if (count > KILN_BENCH_MAX_REPETITIONS)
        count = KILN_BENCH_MAX_REPETITIONS;
    if (count == 0)
        return (struct kiln_spread){.count = 0};
    memcpy(sorted, values, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare);
    return (struct kiln_spread){
        .count = (uint32_t)count,
        .least = sorted[0],
        .first_quartile = value_at(sorted, count, 0.25),
        .median = value_at(sorted, count, 0.5),
        .third_quartile = value_at(sorted, count, 0.75),
        .most = sorted[count - 1],
    };
}

struct kiln_spread kiln_spread_of_ratios(const double *over, const double *under, size_t count)
{
    double ratios[KILN_BENCH_MAX_REPETITIONS];
    size_t pairs = 0;
    for (size_t i = 0; i < count && pairs < KILN_BENCH_MAX_REPETITIONS; i++) {
        if (under[i] > 0.0)
            ratios[pairs++] = over[i] / under[i];
    }
    return kiln_spread_of(ratios, pairs);
}

double kiln_growth(const double *x, const double *y, size_t count)
{
    double n = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (!(x[i] > 0.0 && y[i] > 0.0))
            continue;
        double u = log(x[i]), v = log(y[i]);
        n += 1.0;
        sum_x += u;
        sum_y += v;
        sum_xx += u * u;
        sum_xy += u * v;
    }
    double spread = n * sum_xx - sum_x * sum_x;
    return n >= 2.0 && spread > 0.0 ? (n * sum_xy - sum_x * sum_y) / spread : (double)NAN;
}
