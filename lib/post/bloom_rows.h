/* This header declares the loops of bloom=cpu over rows. */
#ifndef KILN_POST_BLOOM_ROWS_H
#define KILN_POST_BLOOM_ROWS_H

#include "base/simd.h"
#include "post/bloom_kernels.h"
#include "post/compose.h"

enum { KILN_BLOOM_EDGE = 5 }; /* pixels that a filter reaches beyond a row, at most */

/* A picture that is read. */
struct kiln_bloom_view {
    const float *pixels;
    uint32_t width, height;
};

/* Describes one loop over the rows of the picture that it writes. */
struct kiln_bloom_pass {
    struct kiln_bloom_view from, level; /* level: the halved picture that `join` mixes in */
    float *to;
    uint32_t to_width, factor;
    float radius;
    float weights[KILN_BLOOM_TAPS];
    struct kiln_compose_light light; /* of the bright pass */
    float exposure, threshold;
    kiln_quad *rows; /* one a thread: the longest row that is read, with edges */
    size_t row_length;
};

/* Rows begin to end of the pass that context points to, for kiln_threads_for. */
typedef void kiln_bloom_rows_run(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_bloom_rows {
    kiln_bloom_rows_run *bright; /* post/bloom_bright.frag */
    kiln_bloom_rows_run *shrink; /* post/bloom_shrink.frag, then post/bloom_blur.frag along rows */
    kiln_bloom_rows_run *blur;   /* post/bloom_blur.frag down the columns */
    kiln_bloom_rows_run *halve;  /* post/bloom_down.frag */
    kiln_bloom_rows_run *join;   /* post/bloom_up.frag: `from` is what lies below */
};
KILN_SIMD_DECLARE(const struct kiln_bloom_rows, kiln_bloom_rows);

#endif
