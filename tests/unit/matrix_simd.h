/* What cglm computes through lib/base/matrix.h, in a file compiled for each level of vectors. */
#ifndef KILN_TESTS_MATRIX_SIMD_H
#define KILN_TESTS_MATRIX_SIMD_H

#include <stddef.h>

#include "base/simd.h"

/* Matrices are columns, quaternions x, y, z, w. */
struct matrix_operands {
    float a[4][4], b[4][4]; /* of any numbers */
    float c[3][3], d[3][3]; /* of any numbers */
    float affine[4][4];     /* the last row is 0 0 0 1 */
    float rigid[4][4];      /* a rotation and a translation */
    float p[4], q[4];       /* quaternions of length 1 */
};

struct matrix_results {
    float ab[4][4], cd[3][3], affine_rigid[4][4]; /* products */
    float a_inverse[4][4], c_inverse[3][3], rigid_inverse[4][4];
    float a_transposed[4][4];
    float a_q[4], affine_p[3], c_p[3]; /* of vectors; the first three numbers of p are a point */
    float pq[4], q_inverse[4];
    float q_matrix[4][4], q_turn[3][3], quaternion[4]; /* the last is that of rigid */
    float a_determinant, c_determinant, dot, length;
};

struct matrix_level {
    void (*compute)(const struct matrix_operands *operands, struct matrix_results *results);
    size_t matrix_alignment, matrix_size, quaternion_alignment;
};

KILN_SIMD_DECLARE(const struct matrix_level, matrix_level);

#endif
