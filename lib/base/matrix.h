/* Includes cglm for the host's matrices and quaternions, restricted to its plain C code.
 *
 * cglm's code for SSE, AVX and NEON adds in another order than its plain C code, and rounds
 * otherwise. cglm chooses it by macros of the compiler and has no switch for that, so this header
 * hides those macros while it reads cglm's headers. Then cglm's results are the same bits on every
 * machine and in files that are compiled for wide vectors, and its types have the same alignment
 * there.
 *
 * Functions of cglm that call the C library's mathematics (angles, perspective, rotations by an
 * angle, slerp) must not be called; shared/exact.h has sine and cosine. tests/tree/mathematics.sh
 * checks that.
 *
 * Matrices are columns, quaternions x, y, z, w. In plain C, glm_quat_mul and glm_mat4_transpose_to
 * write their result while they still read, so it must not be one of the operands. */
#ifndef KILN_BASE_MATRIX_H
#define KILN_BASE_MATRIX_H

/* Headers of the C library that cglm includes are read here first, while the macros are defined. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#pragma push_macro("__SSE__")
#pragma push_macro("__SSE2__")
#pragma push_macro("__SSE3__")
#pragma push_macro("__SSE4_1__")
#pragma push_macro("__SSE4_2__")
#pragma push_macro("__AVX__")
#pragma push_macro("__ARM_NEON")
#undef __SSE__
#undef __SSE2__
#undef __SSE3__
#undef __SSE4_1__
#undef __SSE4_2__
#undef __AVX__
#undef __ARM_NEON

/* Vectors of four need no alignment: rows of a block, keys of a track. */
#define CGLM_ALL_UNALIGNED

#include <cglm/affine.h>
#include <cglm/mat3.h>
#include <cglm/mat4.h>
#include <cglm/quat.h>
#include <cglm/vec3.h>
#include <cglm/vec4.h>

#pragma pop_macro("__ARM_NEON")
#pragma pop_macro("__AVX__")
#pragma pop_macro("__SSE4_2__")
#pragma pop_macro("__SSE4_1__")
#pragma pop_macro("__SSE3__")
#pragma pop_macro("__SSE2__")
#pragma pop_macro("__SSE__")

#ifdef CGLM_SIMD
#error "cglm has found vectors: a macro by which it picks them is missing above"
#endif

#include "shared/platform.h"

/* Convert between a matrix whose fourth row is (0, 0, 0, 1) and its three other rows, as std140
 * blocks have them. */
static inline void kiln_matrix_from_rows(const float4 rows[3], mat4 out)
{
    const float4 x = rows[0], y = rows[1], z = rows[2];
    glm_vec4_copy((vec4){x.x, y.x, z.x, 0.0f}, out[0]);
    glm_vec4_copy((vec4){x.y, y.y, z.y, 0.0f}, out[1]);
    glm_vec4_copy((vec4){x.z, y.z, z.z, 0.0f}, out[2]);
    glm_vec4_copy((vec4){x.w, y.w, z.w, 1.0f}, out[3]);
}

static inline void kiln_matrix_to_rows(mat4 m, float4 rows[3])
{
    for (int i = 0; i < 3; i++)
        rows[i] = FLOAT4(m[0][i], m[1][i], m[2][i], m[3][i]);
}

#endif
