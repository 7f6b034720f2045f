/* This header declares a stable radix sort of few pairs by one thread. */
#ifndef KILN_SORT_BUCKET_H
#define KILN_SORT_BUCKET_H

#include "base/simd.h"
#include "sort/pairs.h"

/* Sorts `count` pairs, at least one, whose keys are within the span, by ascending key; pairs of
 * equal keys keep their order. The lower words of the pairs are written to list[0], list[step], ...
 * (step: 1 or -1). scratch has room for `count` pairs. The pairs are overwritten. */
typedef void kiln_sort_bucket(kiln_sort_pair *pairs, size_t count, struct kiln_sort_span span,
                              kiln_sort_pair *scratch, uint32_t *list, int step);
KILN_SIMD_DECLARE(kiln_sort_bucket, kiln_sort_bucket);

#endif
