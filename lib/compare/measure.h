/* Takes all measures of the difference of two pictures. The table in metric.c turns them into named
 * metrics. */
#ifndef KILN_COMPARE_MEASURE_H
#define KILN_COMPARE_MEASURE_H

#include "compare/levels.h"
#include "compare/pool.h"

struct kiln_measure_params {
    bool hdr;                 /* HDR-FLIP at several exposures, instead of clamped values */
    double pixels_per_degree; /* 4 to 400 */
    double threshold;         /* levels; a pixel that differs by more is a differing one */
    uint32_t window;          /* pixels, at least 1 */
};

struct kiln_measurement {
    uint32_t width, height;
    float *errors; /* FLIP's, one a pixel */
    struct kiln_error_pool flip;
    struct kiln_level_difference levels;
    double ssim;
    double flip_s; /* wall-clock time of FLIP */
};

/* Measures two pictures. FLIP and SSIM of pictures with alpha are taken on black and on white, and
 * the worse of the two counts. Returns false when the pictures do not match (KILN_FRAME_FAILED), or
 * when a part of the measurement fails. In either case, the caller must call
 * kiln_measurement_finish. */
bool kiln_measurement_take(struct kiln_measurement *measurement,
                           const struct kiln_compare_picture *reference,
                           const struct kiln_compare_picture *test,
                           const struct kiln_measure_params *params, struct kiln_threads *threads,
                           struct kiln_error *error);
void kiln_measurement_finish(struct kiln_measurement *measurement);

#endif
