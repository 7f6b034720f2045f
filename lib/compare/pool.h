/* Numbers that stand for a map of errors, none of them negative. */
#ifndef KILN_COMPARE_POOL_H
#define KILN_COMPARE_POOL_H

#include "kiln.h"

/* Percentiles are weighted by the errors themselves: the first error, from the smallest, at which
 * the sum of those up to it exceeds that part of the sum of all. */
struct kiln_error_pool {
    double mean, weighted_median, minimum, maximum;
};

/* Sums are in double. False with KILN_INVALID_INPUT for no errors at all: nothing compared is never
 * a pass; with KILN_DEVICE_FAILED when memory is short. */
bool kiln_pool_errors(const float *errors, size_t count, struct kiln_error_pool *pool,
                      struct kiln_error *error);

/* part: 0 to 1. Errors as above, and KILN_USAGE for another part. */
bool kiln_pool_percentile(const float *errors, size_t count, double part, double *value,
                          struct kiln_error *error);

#endif
