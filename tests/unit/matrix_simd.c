/* Calls cglm's functions that kiln uses, and some beside them, on one set of operands. */
#include "unit/matrix_simd.h"

#include <stdalign.h>

#include "base/matrix.h"

/* The macros that lib/base/matrix.h hides are back. */
#if defined __x86_64__ && !(defined __SSE__ && defined __SSE2__)
#error "lib/base/matrix.h has lost a macro of SSE"
#endif
#if (defined KILN_LEVEL_AVX2 || defined KILN_LEVEL_AVX512) &&                                      \
    !(defined __SSE4_1__ && defined __AVX__ && defined __AVX2__)
#error "lib/base/matrix.h has lost a macro of AVX"
#endif

static void compute(const struct matrix_operands *operands, struct matrix_results *results)
{
    struct matrix_operands o = *operands;
    struct matrix_results *r = results;
    glm_mat4_mul(o.a, o.b, r->ab);
    glm_mat3_mul(o.c, o.d, r->cd);
    glm_mul(o.affine, o.rigid, r->affine_rigid);
    glm_mat4_inv(o.a, r->a_inverse);
    glm_mat3_inv(o.c, r->c_inverse);
    glm_mat4_copy(o.rigid, r->rigid_inverse);
    glm_inv_tr(r->rigid_inverse);
    glm_mat4_transpose_to(o.a, r->a_transposed);
    glm_mat4_mulv(o.a, o.q, r->a_q);
    glm_mat4_mulv3(o.affine, o.p, 1.0f, r->affine_p);
    glm_mat3_mulv(o.c, o.p, r->c_p);
    glm_quat_mul(o.p, o.q, r->pq);
    glm_quat_inv(o.q, r->q_inverse);
    glm_quat_mat4(o.q, r->q_matrix);
    glm_quat_mat3(o.q, r->q_turn);
    glm_mat4_quat(o.rigid, r->quaternion);
    r->a_determinant = glm_mat4_det(o.a);
    r->c_determinant = glm_mat3_det(o.c);
    r->dot = glm_vec4_dot(o.a[0], o.b[0]);
    r->length = glm_vec4_norm(o.a[1]);
}

const struct matrix_level KILN_SIMD_NAME(matrix_level) = {
    .compute = compute,
    .matrix_alignment = alignof(mat4),
    .matrix_size = sizeof(mat4),
    .quaternion_alignment = alignof(versor),
};
