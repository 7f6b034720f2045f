/* Declares the metrics of comparisons. The table in metric.c makes the columns of reports, the
 * names of limits and the help. */
#ifndef KILN_COMPARE_METRIC_H
#define KILN_COMPARE_METRIC_H

#include "compare/measure.h"

struct kiln_metric;

/* The columns of a report, and how each is computed. */
struct kiln_metric_set {
    size_t count;
    struct kiln_compare_column columns[KILN_MAX_COLUMNS];
    const struct kiln_metric *metrics[KILN_MAX_COLUMNS];
    double percentiles[KILN_MAX_COLUMNS]; /* 0 to 100 */
};

/* Makes a set of all metrics, with limits such as "flip.mean=0.01,flip.p99.5=0.3". A percentile
 * that is not in the table gets a column of its own, and of two limits of one metric the last
 * counts. KILN_USAGE for anything else, with the nearest name. */
bool kiln_metric_set_make(struct kiln_metric_set *set, const char *const *limits,
                          size_t limit_count, struct kiln_error *error);

/* Fills the values of a layer, the flags of values beyond their limits, its score and its verdict.
 */
bool kiln_metric_set_judge(const struct kiln_metric_set *set,
                           const struct kiln_measurement *measurement,
                           struct kiln_compare_layer *layer, struct kiln_error *error);

/* Returns whether value a of column i is worse than b. */
bool kiln_metric_set_is_worse(const struct kiln_metric_set *set, size_t i, double a, double b);

#endif
