/* This header declares the loops over rows that draw/sprites/coarse_cpu.c runs on threads;
 * coarse_rows_simd.c defines them for each width of vectors. */
#ifndef KILN_DRAW_SPRITES_COARSE_ROWS_H
#define KILN_DRAW_SPRITES_COARSE_ROWS_H

#include "base/simd.h"
#include "draw/sprites/coarse_images.h"

/* One RGBA pixel. */
typedef float kiln_coarse_quad __attribute__((vector_size(16)));

/* Holds colour and bloom of one pixel. */
struct kiln_coarse_pixel {
    kiln_coarse_quad color, bloom;
};

/* Describes where a row or a column of the frame lies among the rows or columns of the coarse
 * picture. */
struct kiln_coarse_place {
    int32_t taps[4];  /* the two coarse ones before it and the two after it, clamped at the edge */
    float weights[4]; /* weights of the taps for a cubic spline */
    float part;       /* the place between the second and the third tap, 0 to 1 */
    int32_t containing; /* the coarse one in which it lies */
    float at;           /* the place in coarse pixels; whole numbers are their middles */
};

/* Holds measurements over the frame's pixels in a coarse row, by column of the frame. */
struct kiln_coarse_columns {
    float *farthest;     /* the farthest depth, m */
    uint32_t *nonplanar; /* 1 where depths do not lie on a plane, else 0 */
};

/* Holds the pictures that the loops read and write. Each loop uses only some of them. */
struct kiln_coarse_rows {
    const struct kiln_coarse_images *images;        /* the sizes */
    const struct kiln_coarse_place *columns, *rows; /* by column and by row of the frame */
    const float *depth;                             /* depth of the frame, m */
    float *coarse_depth;
    uint8_t *nonplanar; /* 1 where the depths in a coarse pixel do not lie on a plane */
    float *edges;       /* 1 where `nonplanar` is 1 in a coarse pixel or in one around it; else 0 */
    float *fine_depth;  /* m; 0 away from edges */

    const float *coarse_color, *coarse_bloom;
    const float *fine_color, *fine_bloom; /* NULL unless mixed */
    float *color, *bloom;                 /* pictures of the frame; bloom NULL: none */
    bool keep_bloom;
    float over; /* 1: alpha covers the bloom of an earlier pass; 0: bloom is added to it */
    struct kiln_coarse_pixel *mixed;      /* scratch: a coarse row for each thread */
    struct kiln_coarse_columns *measured; /* scratch: one for each thread */
};

/* Processes rows begin to end - 1 of the struct kiln_coarse_rows that context points to; for
 * kiln_threads_try. */
typedef void kiln_coarse_loop(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_coarse_loops {
    /* The first two loops run over rows of the coarse picture, the other two over the frame's. */
    kiln_coarse_loop *measure, *find_edges; /* write coarse_depth and nonplanar; edges */
    kiln_coarse_loop *mask, *enlarge;       /* write fine_depth; color and bloom */
};
KILN_SIMD_DECLARE(const struct kiln_coarse_loops, kiln_coarse_loops);

#endif
