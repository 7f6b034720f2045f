/* Pools a map of errors into single numbers. No error may be negative. */
#ifndef KILN_COMPARE_POOL_H
#define KILN_COMPARE_POOL_H

#include "kiln.h"

/* Percentiles are weighted by the errors themselves: with errors in ascending order, a percentile
 * is the first error at which the running sum exceeds that part of the total sum. */
struct kiln_error_pool {
    double mean, weighted_median, minimum, maximum;
};

/* Pools errors into their mean, weighted median, minimum and maximum. Sums are in double. False
 * with KILN_INVALID_INPUT without any errors, because comparing nothing must never pass; with
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_pool_errors(const float *errors, size_t count, struct kiln_error_pool *pool,
                      struct kiln_error *error);

/* Finds a weighted percentile; part is 0 to 1. Fails as kiln_pool_errors does, and with KILN_USAGE
 * for another part. */
bool kiln_pool_percentile(const float *errors, size_t count, double part, double *value,
                          struct kiln_error *error);

#endif
