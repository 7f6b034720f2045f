/* Pools error maps into mean, extremes and weighted percentiles. Errors are not negative, so the
 * bits of floats have the order of their values: a percentile is found by two counts over 16 bits
 * each, without sorting. */
#include "compare/pool.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"

enum { BUCKETS = 1 << 16 };

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

bool kiln_pool_errors(const float *errors, size_t count, struct kiln_error_pool *pool,
                      struct kiln_error *error)
{
    if (count == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "no pixels: nothing was compared");
    double sum = 0;
    float least = errors[0], most = errors[0];
    for (size_t i = 0; i < count; i++) {
        sum += (double)errors[i];
        least = errors[i] < least ? errors[i] : least;
        most = errors[i] > most ? errors[i] : most;
    }
    *pool = (struct kiln_error_pool){
        .mean = sum / (double)count, .minimum = (double)least, .maximum = (double)most};
    return kiln_pool_percentile(errors, count, 0.5, &pool->weighted_median, error);
}

/* Adds each error to the bucket of its bits' upper half or, with `lower`, to the bucket of their
 * lower half if the upper half is `upper`. */
static void fill_buckets(const float *errors, size_t count, bool lower, uint32_t upper,
                         double *buckets)
{
    memset(buckets, 0, BUCKETS * sizeof *buckets);
    for (size_t i = 0; i < count; i++) {
        uint32_t bits = bits_of(errors[i]);
        if (!lower)
            buckets[bits >> 16] += (double)errors[i];
        else if (bits >> 16 == upper)
            buckets[bits & 0xffff] += (double)errors[i];
    }
}

/* Adds buckets to *sum and returns the first one that would make it exceed limit; if none does,
 * returns the last bucket that is not empty. *sum is without the bucket that is returned. */
static uint32_t find_bucket(const double *buckets, double limit, double *sum)
{
    uint32_t last = 0;
    for (uint32_t i = 0; i < BUCKETS; i++) {
        if (buckets[i] <= 0.0)
            continue;
        if (*sum + buckets[i] > limit)
            return i;
        *sum += buckets[i];
        last = i;
    }
    *sum -= buckets[last];
    return last;
}

bool kiln_pool_percentile(const float *errors, size_t count, double part, double *value,
                          struct kiln_error *error)
{
    if (!(part >= 0.0 && part <= 1.0))
        return kiln_error_set(error, KILN_USAGE, "found part %g of a percentile; expected 0 to 1",
                              part);
    if (count == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "no pixels: nothing was compared");
    double *buckets = malloc(BUCKETS * sizeof *buckets);
    if (!buckets)
        return kiln_error_no_memory(error, "pooling %zu errors", count);

    fill_buckets(errors, count, false, 0, buckets);
    double total = 0, below = 0;
    for (uint32_t i = 0; i < BUCKETS; i++)
        total += buckets[i];
    uint32_t upper = find_bucket(buckets, part * total, &below);
    fill_buckets(errors, count, true, upper, buckets);
    uint32_t bits = upper << 16 | find_bucket(buckets, part * total, &below);
    free(buckets);
    float found;
    memcpy(&found, &bits, sizeof found);
    *value = total > 0.0 ? (double)found : 0.0;
    return true;
}
