/* This header declares the loops of bloom=cpu over rows. */
#ifndef KILN_POST_BLOOM_ROWS_H
#define KILN_POST_BLOOM_ROWS_H

#include "base/simd.h"
#include "post/bloom_kernels.h"
#include "post/compose.h"

enum { KILN_BLOOM_EDGE = 5 }; /* the most pixels that a filter reads beyond the end of a row */

/* Describes a picture that a pass reads: RGBA, rows from the top. */
struct kiln_bloom_view {
    const float *pixels;
    uint32_t width, height;
};

/* Holds the parameters of a pass, which loops over the rows of the picture that it writes. */
struct kiln_bloom_pass {
    struct kiln_bloom_view from, level; /* level: the halved picture that `join` mixes with
                                         * `from` */
    float *to;
    uint32_t to_width, factor;
    float radius;
    float weights[KILN_BLOOM_TAPS];
    struct kiln_compose_light light; /* of the bright pass */
    float exposure, threshold;
    kiln_quad *rows; /* a row for each thread, as long as the longest that is read, with edges */
    size_t row_length;
};

/* Computes rows begin .. end - 1 of the struct kiln_bloom_pass that context points to; it is a
 * function for kiln_threads_try. */
typedef void kiln_bloom_rows_run(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_bloom_rows {
    kiln_bloom_rows_run *bright; /* post/bloom_bright.frag */
    kiln_bloom_rows_run *shrink; /* post/bloom_shrink.frag, then post/bloom_blur.frag along rows */
    kiln_bloom_rows_run *blur;   /* post/bloom_blur.frag down the columns */
    kiln_bloom_rows_run *halve;  /* post/bloom_down.frag */
    kiln_bloom_rows_run *join;   /* post/bloom_up.frag; `from` is the smaller picture */
};
KILN_SIMD_DECLARE(const struct kiln_bloom_rows, kiln_bloom_rows);

#endif
