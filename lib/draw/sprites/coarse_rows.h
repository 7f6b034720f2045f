/* This header declares the loops over rows that draw/sprites/coarse_cpu.c runs on threads, for
 * sprites that are drawn at a coarse resolution and enlarged to that of the frame;
 * coarse_rows_simd.c defines the loops for each width of vectors. A `fine` picture has the
 * resolution of the frame. It shows the sprites near edges alone. */
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
    /* The two coarse rows (or columns) whose middles lie before its middle, and the two after it.
     * At the edge of the coarse picture, the outermost one stands for those beyond. */
    int32_t taps[4];
    float weights[4];   /* weights of the taps for a cubic spline */
    float at;           /* its middle, in coarse pixels: n is the middle of coarse row n */
    float part;         /* the fraction of `at`: 0 at the second tap, 1 at the third */
    int32_t containing; /* the coarse row in which its middle lies */
};

/* Holds, for each column of the frame, measurements over the pixels of that column that lie in one
 * coarse row. */
struct kiln_coarse_columns {
    float *farthest;     /* the farthest depth, m */
    uint32_t *nonplanar; /* 1 where depths do not lie on a plane, else 0 */
};

/* Holds the pictures that the loops read and write. Each loop uses only some of them. */
struct kiln_coarse_rows {
    const struct kiln_coarse_images *images; /* has the sizes of the pictures below */
    /* the place of each column and of each row of the frame */
    const struct kiln_coarse_place *columns, *rows;
    const float *depth; /* depth of the frame, m */
    float *coarse_depth;
    uint8_t *nonplanar; /* 1 where the depths in a coarse pixel do not lie on a plane */
    float *edges;       /* 1 where `nonplanar` is 1 in a coarse pixel or in one around it; else 0 */
    float *fine_depth;  /* m; 0 away from edges */

    const float *coarse_color, *coarse_bloom;
    const float *fine_color, *fine_bloom; /* NULL unless images->mixed */
    float *color, *bloom; /* pictures of the frame, which are written; bloom NULL: there is none */
    bool keep_bloom;      /* `bloom` has the bloom of an earlier pass, which is kept */
    float over; /* with keep_bloom: 1: the sprites cover the earlier bloom by their alpha; 0: they
                 * do not */
    struct kiln_coarse_pixel *interpolated; /* scratch: a coarse row for each thread */
    struct kiln_coarse_columns *measured;   /* scratch: one for each thread */
};

/* Processes rows begin to end - 1 of the struct kiln_coarse_rows that context points to; for
 * kiln_threads_try. */
typedef void kiln_coarse_loop(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_coarse_loops {
    /* These two run over rows of the coarse picture. */
    kiln_coarse_loop *measure;    /* writes coarse_depth and nonplanar */
    kiln_coarse_loop *find_edges; /* writes edges */
    /* These two run over rows of the frame. */
    kiln_coarse_loop *mask;    /* writes fine_depth */
    kiln_coarse_loop *enlarge; /* writes color and bloom */
};
KILN_SIMD_DECLARE(const struct kiln_coarse_loops, kiln_coarse_loops);

#endif
