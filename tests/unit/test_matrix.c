/* lib/base/matrix.h: cglm gives the same bits at every level of vectors (matrix_simd.c), and they
 * are those of its plain C. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/matrix.h"
#include "support/cmocka.h"
#include "unit/matrix_simd.h"

enum { SETS = 400 };

/* ---- operands -------------------------------------------------------------------------------- */

/* From -2 to 2, with all digits of a float. */
static float any(void)
{
    return ldexpf((float)(rand() % (1 << 24)) - 8388608.0f, -22);
}

static void fill_any(float *out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        out[i] = any();
}

static void fill_unit(float out[4])
{
    float length2 = 0.0f;
    while (!(length2 > 0.01f)) {
        fill_any(out, 4);
        length2 = out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3];
    }
    for (int i = 0; i < 4; i++)
        out[i] /= sqrtf(length2);
}

/* The rotation by a quaternion, in double. */
static void rotation_of(const float q[4], double out[3][3])
{
    const double x = (double)q[0], y = (double)q[1], z = (double)q[2], w = (double)q[3];
    const double columns[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
        {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
        {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
    memcpy(out, columns, sizeof columns);
}

static struct matrix_operands make_operands(void)
{
    struct matrix_operands o;
    double turn[3][3];
    fill_any(&o.a[0][0], 16);
    fill_any(&o.b[0][0], 16);
    fill_any(&o.c[0][0], 9);
    fill_any(&o.d[0][0], 9);
    fill_any(&o.affine[0][0], 16);
    fill_any(&o.rigid[0][0], 16);
    fill_unit(o.p);
    fill_unit(o.q);
    rotation_of(o.p, turn);
    for (int c = 0; c < 4; c++) {
        for (int r = 0; r < 3 && c < 3; r++)
            o.rigid[c][r] = (float)turn[c][r];
        o.affine[c][3] = o.rigid[c][3] = c == 3 ? 1.0f : 0.0f;
    }
    return o;
}

/* ---- bits ------------------------------------------------------------------------------------ */

static void levels_agree(void **state)
{
    (void)state;
    const struct matrix_level *plain = KILN_SIMD_PICK(matrix_level, kiln_simd_narrowest());
    srand(1);
    for (int i = 0; i < SETS; i++) {
        const struct matrix_operands operands = make_operands();
        struct matrix_results expected, results;
        plain->compute(&operands, &expected);
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            KILN_SIMD_PICK(matrix_level, simd)->compute(&operands, &results);
            if (memcmp(&results, &expected, sizeof results) != 0)
                fail_msg("%s differs from %s", kiln_simd_name(simd),
                         kiln_simd_name(kiln_simd_narrowest()));
        }
    }
}

/* Structs with matrices are shared by files of all levels. */
static void types_are_laid_out_alike(void **state)
{
    (void)state;
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        const struct matrix_level *level = KILN_SIMD_PICK(matrix_level, simd);
        if (!kiln_simd_has(simd))
            continue;
        assert_int_equal(level->matrix_size, 64);
        assert_int_equal(level->matrix_alignment, 16);
        assert_int_equal(level->quaternion_alignment, sizeof(float));
    }
}

/* Column by column, each sum from the left. */
static void multiply(const float *a, const float *b, int rows, float *out)
{
    for (int c = 0; c < rows; c++) {
        for (int r = 0; r < rows; r++) {
            float sum = a[r] * b[c * rows];
            for (int k = 1; k < rows; k++)
                sum += a[k * rows + r] * b[c * rows + k];
            out[c * rows + r] = sum;
        }
    }
}

static void sums_go_from_the_left(void **state)
{
    (void)state;
    srand(2);
    for (int i = 0; i < SETS; i++) {
        struct matrix_operands o = make_operands();
        struct matrix_results r;
        float ab[4][4], affine[4][4], cd[3][3];
        const float *p = o.p, *q = o.q;
        KILN_SIMD_PICK(matrix_level, kiln_simd_narrowest())->compute(&o, &r);
        multiply(&o.a[0][0], &o.b[0][0], 4, &ab[0][0]);
        multiply(&o.affine[0][0], &o.rigid[0][0], 4, &affine[0][0]);
        multiply(&o.c[0][0], &o.d[0][0], 3, &cd[0][0]);
        const float pq[4] = {p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1],
                             p[3] * q[1] - p[0] * q[2] + p[1] * q[3] + p[2] * q[0],
                             p[3] * q[2] + p[0] * q[1] - p[1] * q[0] + p[2] * q[3],
                             p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]};
        assert_memory_equal(r.ab, ab, sizeof ab);
        for (int n = 0; n < 16; n++) /* of the last row, cglm leaves out a sum with 0 */
            assert_true(r.affine_rigid[n / 4][n % 4] == affine[n / 4][n % 4]);
        assert_memory_equal(r.cd, cd, sizeof cd);
        assert_memory_equal(r.pq, pq, sizeof pq);
        const float *a = o.a[0], *b = o.b[0], *t = o.rigid[3];
        assert_true(r.dot == a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
        for (int n = 0; n < 3; n++) {
            const float *axis = o.rigid[n];
            assert_true(r.rigid_inverse[3][n] ==
                        -(axis[0] * t[0] + axis[1] * t[1] + axis[2] * t[2]));
        }
    }
}

/* ---- meaning --------------------------------------------------------------------------------- */

/* The largest difference of a product from the identity. */
static double not_inverse(const float *a, const float *b, int rows)
{
    double most = 0.0;
    for (int c = 0; c < rows; c++) {
        for (int r = 0; r < rows; r++) {
            double sum = r == c ? -1.0 : 0.0;
            for (int k = 0; k < rows; k++)
                sum += (double)a[k * rows + r] * (double)b[c * rows + k];
            most = fmax(most, fabs(sum));
        }
    }
    return most;
}

/* Those of a determinant near 0 have few digits. */
static void inverses_invert(void **state)
{
    (void)state;
    int tried = 0;
    srand(3);
    for (int i = 0; i < SETS; i++) {
        const struct matrix_operands o = make_operands();
        struct matrix_results r;
        KILN_SIMD_PICK(matrix_level, kiln_simd_narrowest())->compute(&o, &r);
        assert_true(not_inverse(&o.rigid[0][0], &r.rigid_inverse[0][0], 4) < 2e-6);
        if (fabsf(r.a_determinant) > 1.0f && fabsf(r.c_determinant) > 1.0f) {
            assert_true(not_inverse(&o.a[0][0], &r.a_inverse[0][0], 4) < 2e-4);
            assert_true(not_inverse(&o.c[0][0], &r.c_inverse[0][0], 3) < 2e-5);
            tried++;
        }
    }
    assert_true(tried > SETS / 4);
}

static void quaternions_are_rotations(void **state)
{
    (void)state;
    srand(4);
    for (int i = 0; i < SETS; i++) {
        const struct matrix_operands o = make_operands();
        struct matrix_results r;
        double p[3][3], q[3][3], pq[3][3], same = 0.0;
        KILN_SIMD_PICK(matrix_level, kiln_simd_narrowest())->compute(&o, &r);
        rotation_of(o.p, p);
        rotation_of(o.q, q);
        rotation_of(r.pq, pq);
        for (int n = 0; n < 9; n++) {
            const int c = n / 3, k = n % 3;
            double sum = 0.0;
            for (int j = 0; j < 3; j++)
                sum += p[j][k] * q[c][j];
            assert_true(fabs(sum - pq[c][k]) < 1e-6);
            assert_true(fabs((double)r.q_turn[c][k] - q[c][k]) < 1e-6);
            assert_true(r.q_turn[c][k] == r.q_matrix[c][k]);
        }
        for (int c = 0; c < 4; c++) {
            assert_true(fabsf(r.q_inverse[c] - (c < 3 ? -o.q[c] : o.q[c])) < 1e-6f);
            same += (double)(r.quaternion[c] * o.p[c]); /* or the opposite, which turns alike */
        }
        assert_true(fabs(fabs(same) - 1.0) < 1e-6);
    }
}

/* ---- rows ------------------------------------------------------------------------------------ */

static void rows_become_a_matrix_and_back(void **state)
{
    (void)state;
    const float4 rows[3] = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}};
    float4 back[3];
    mat4 m;
    vec3 at = {1.0f, 10.0f, 100.0f};
    kiln_matrix_from_rows(rows, m);
    kiln_matrix_to_rows(m, back);
    assert_memory_equal(back, rows, sizeof rows);
    glm_mat4_mulv3(m, at, 1.0f, at);
    assert_true(at[0] == 325.0f && at[1] == 773.0f && at[2] == 1221.0f);
    assert_true(m[0][3] == 0.0f && m[1][3] == 0.0f && m[2][3] == 0.0f && m[3][3] == 1.0f);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_agree),
        cmocka_unit_test(types_are_laid_out_alike),
        cmocka_unit_test(sums_go_from_the_left),
        cmocka_unit_test(inverses_invert),
        cmocka_unit_test(quaternions_are_rotations),
        cmocka_unit_test(rows_become_a_matrix_and_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
