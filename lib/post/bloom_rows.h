/* This header declares the loops of bloom=cpu over rows. */
#ifndef KILN_POST_BLOOM_ROWS_H
#define KILN_POST_BLOOM_ROWS_H

#include "base/simd.h"
#include "post/bloom_plan.h"
#include "post/compose.h"

enum {
    /* the most pixels that a filter reads beyond the end of a row */
    KILN_BLOOM_EDGE = KILN_BLOOM_MAX_TAPS - 1,
};

/* Describes a picture that a pass reads: RGBA, rows from the top. */
struct kiln_bloom_view {
    const float *pixels;
    uint32_t width, height;
};

/* Says which pixels of a row make one pixel of the reduced row. */
struct kiln_bloom_column {
    uint32_t first, count;
    const float *weights; /* `count` of them */
};

/* Holds the parameters of a pass, which loops over the rows of the picture that it writes. */
struct kiln_bloom_pass {
    struct kiln_bloom_view from, level; /* level: the halved picture that `join` mixes with
                                         * `from` */
    float *to;
    uint32_t to_width;
    float ratio;                             /* of `shrink` and `reduce`: how many pixels of `from`
                                              * are one pixel along an axis; whole for `shrink` */
    const struct kiln_bloom_column *columns; /* of `reduce`, one for each pixel of a row */
    float radius;                            /* of `join` */
    const struct kiln_bloom_plan *plan;      /* has the taps of `across` and `down` */
    struct kiln_compose_light light;         /* of the bright pass */
    float exposure, threshold;
    kiln_quad *rows; /* a row for each thread, as long as the longest that is read, with edges */
    size_t row_length;
};

/* Computes rows begin .. end - 1 of the struct kiln_bloom_pass that context points to; it is a
 * function for kiln_threads_try. */
typedef void kiln_bloom_rows_run(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_bloom_rows {
    kiln_bloom_rows_run *bright; /* post/bloom_bright.frag */
    kiln_bloom_rows_run *shrink; /* post/bloom_shrink.frag */
    kiln_bloom_rows_run *reduce; /* post/bloom_reduce.frag */
    kiln_bloom_rows_run *across; /* post/bloom_blur.frag along rows */
    kiln_bloom_rows_run *down;   /* post/bloom_blur.frag down the columns */
    kiln_bloom_rows_run *halve;  /* post/bloom_down.frag */
    kiln_bloom_rows_run *join;   /* post/bloom_up.frag; `from` is the smaller picture */
};
KILN_SIMD_DECLARE(const struct kiln_bloom_rows, kiln_bloom_rows);

#endif
