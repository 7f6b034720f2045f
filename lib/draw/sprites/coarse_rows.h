/* This header declares the loops of draw/sprites/coarse_cpu.c over rows. */
#ifndef KILN_DRAW_SPRITES_COARSE_ROWS_H
#define KILN_DRAW_SPRITES_COARSE_ROWS_H

#include "base/simd.h"
#include "draw/sprites/coarse_images.h"

/* A pixel, RGBA. */
typedef float kiln_coarse_quad __attribute__((vector_size(16)));

/* Holds colour and bloom of one pixel. */
struct kiln_coarse_shown {
    kiln_coarse_quad color, bloom;
};

/* Describes where a row or a column of the frame lies among coarse ones. */
struct kiln_coarse_place {
    int32_t taps[4];  /* two before it, two after it; beyond the edge, the edge's */
    float weights[4]; /* of a cubic spline through them */
    float part;       /* on the way from the second to the third */
    int32_t own;      /* the one that it lies in */
    float at;         /* its place; whole numbers are the middles of coarse pixels */
};

/* Holds what was measured of a coarse row, by columns of the frame. */
struct kiln_coarse_columns {
    float *farthest; /* m */
    uint32_t *bent;
};

struct kiln_coarse_rows {
    const struct kiln_coarse_images *images;        /* what sizes there are */
    const struct kiln_coarse_place *columns, *rows; /* of the frame; bloom NULL: none */
    const float *depth;                             /* of the frame, m */
    float *coarse_depth;
    uint8_t *bent;     /* 1 where a coarse pixel's depth is not that of a plane */
    float *edges;      /* 1 where there is one around a coarse pixel; else 0 */
    float *fine_depth; /* m; 0 away from edges */

    const float *coarse_color, *coarse_bloom;
    const float *fine_color, *fine_bloom; /* NULL unless mixed */
    float *color, *bloom;                 /* of the frame; bloom NULL: none */
    bool keep_bloom;
    float over; /* 1: what covers hides an earlier pass's bloom; 0: it is added to */
    struct kiln_coarse_shown *mixed;   /* a coarse row for each thread */
    struct kiln_coarse_columns *known; /* of each thread */
};

/* Rows begin to end of the kiln_coarse_rows that context points to, for kiln_threads_for. */
typedef void kiln_coarse_loop(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_coarse_loops {
    kiln_coarse_loop *measure, *find_edges; /* over coarse rows: depth and bent; then edges */
    kiln_coarse_loop *mask, *spread;        /* over the frame's: fine_depth; colour and bloom */
};
KILN_SIMD_DECLARE(const struct kiln_coarse_loops, kiln_coarse_loops);

#endif
