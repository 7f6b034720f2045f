/* lib/sim/world/voxels.c: which cells triangles touch, which of them a cell keeps, and that the
 * number of threads is of no account.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "sim/world/voxels.h"
#include "support/balls.h"
#include "support/cmocka.h"
#include "support/errors.h"

enum { TRIANGLES = 60 };

/* Triangles of all sizes, each with corners of its own. */
struct soup {
    float before[3 * TRIANGLES][3], after[3 * TRIANGLES][3];
    uint32_t triangles[TRIANGLES][3];
    uint32_t count;
};

static struct soup soup;

static void make_soup(uint32_t seed, uint32_t count, float motion)
{
    soup.count = count;
    for (uint32_t i = 0; i < count; i++) {
        const float reach = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 0.2f : 0.02f;
        float middle[3];
        for (int c = 0; c < 3; c++)
            middle[c] = balls_random(&seed);
        for (uint32_t k = 0; k < 3; k++) {
            soup.triangles[i][k] = 3 * i + k;
            for (int c = 0; c < 3; c++) {
                const float at = middle[c] + reach * balls_random(&seed);
                soup.after[3 * i + k][c] = at;
                soup.before[3 * i + k][c] = at - motion * balls_random(&seed);
            }
        }
    }
}

static struct kiln_voxels_input soup_input(float spacing)
{
    return (struct kiln_voxels_input){.before = (const float(*)[3])soup.before,
                                      .after = (const float(*)[3])soup.after,
                                      .vertex_count = 3 * soup.count,
                                      .triangles = (const uint32_t(*)[3])soup.triangles,
                                      .triangle_count = soup.count,
                                      .spacing = spacing,
                                      .heading = {0.0f, -1.0f, 0.0f}};
}

static void build(struct kiln_voxels *voxels, const struct kiln_voxels_input *input,
                  uint32_t threads)
{
    struct kiln_error error = {0};
    struct kiln_threads *pool = kiln_threads_create(threads);
    assert_non_null(pool);
    if (!kiln_voxels_build(voxels, input, pool, &error))
        fail_msg("%s", error.message);
    kiln_threads_destroy(&pool);
}

/* The same triangle over and over, as large as the lattice. */
static void what_would_take_long_is_refused(void **state)
{
    (void)state;
    static const float corners[3][3] = {{0, 0, 0}, {1, 1, 0}, {0, 1, 1}};
    static uint32_t triangles[100][3];
    struct kiln_voxels_input input = {.before = corners,
                                      .after = corners,
                                      .vertex_count = 3,
                                      .triangles = (const uint32_t(*)[3])triangles,
                                      .spacing = 1.0f / 155,
                                      .heading = {0.0f, -1.0f, 0.0f}};
    struct kiln_voxels voxels = {.plane_count = 0};
    struct kiln_threads *pool = kiln_threads_create(1);
    for (int i = 0; i < 100; i++)
        for (uint32_t k = 0; k < 3; k++)
            triangles[i][k] = k;
    input.triangle_count = 4;
    struct kiln_error error = {0};
    assert_true(kiln_voxels_build(&voxels, &input, pool, &error));
    assert_true(voxels.plane_count > 10000);
    input.triangle_count = 100;
    assert_false(kiln_voxels_build(&voxels, &input, pool, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "the 100 triangles of a volume lie in 386989300 cells altogether in a step; at "
                 "most 268435456 are allowed: set fewer cells");
    kiln_voxels_finish(&voxels);
    kiln_threads_destroy(&pool);
}

static size_t cells_of(const struct kiln_voxels *v)
{
    return (size_t)v->size[0] * v->size[1] * v->size[2];
}

/* The cell of a number, m; larger by a factor about its middle. */
static void box_of(const struct kiln_voxels *v, size_t cell, double factor, double low[3],
                   double high[3])
{
    const size_t at[3] = {cell % v->size[0], cell / v->size[0] % v->size[1],
                          cell / v->size[0] / v->size[1]};
    for (int c = 0; c < 3; c++) {
        const double middle = (double)v->origin[c] + ((double)at[c] + 0.5) * (double)v->spacing;
        low[c] = middle - 0.5 * factor * (double)v->spacing;
        high[c] = middle + 0.5 * factor * (double)v->spacing;
    }
}

/* Cuts off what is beyond one face of a box. Returns the corners that are left. */
static int cut(double (*p)[3], int count, int c, double at, double sign)
{
    double left[12][3];
    int n = 0;
    for (int i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count];
        const double da = sign * (a[c] - at), db = sign * (b[c] - at);
        if (da >= 0)
            memcpy(left[n++], a, sizeof left[0]);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            for (int k = 0; k < 3; k++)
                left[n][k] = a[k] + (b[k] - a[k]) * da / (da - db);
            n++;
        }
    }
    memcpy(p, left, (size_t)n * sizeof *p);
    return n;
}

/* Is a part of a triangle of the soup in the box? `part`: of the step. */
static bool touches(uint32_t triangle, double part, const double low[3], const double high[3])
{
    double p[12][3];
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) {
            const double a = (double)soup.before[3 * triangle + (uint32_t)k][c];
            const double b = (double)soup.after[3 * triangle + (uint32_t)k][c];
            p[k][c] = a + (b - a) * part;
        }
    int count = 3;
    for (int c = 0; c < 3 && count > 0; c++) {
        count = cut(p, count, c, low[c], 1);
        count = count > 0 ? cut(p, count, c, high[c], -1) : 0;
    }
    return count > 0;
}

/* How far below a point the plane of a triangle is; it faces up where `up` says so. */
static double depth_below(uint32_t triangle, const double at[3], bool *up)
{
    double e[2][3], n[3];
    const float *p = soup.after[3 * triangle];
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            e[k][c] = (double)soup.after[3 * triangle + (uint32_t)k + 1][c] - (double)p[c];
    for (int c = 0; c < 3; c++)
        n[c] = e[0][(c + 1) % 3] * e[1][(c + 2) % 3] - e[0][(c + 2) % 3] * e[1][(c + 1) % 3];
    *up = n[1] > 0;
    double height = 0;
    for (int c = 0; c < 3; c++)
        height += n[c] * (at[c] - (double)p[c]);
    return height / n[1];
}

/* Of triangles that stand still: exactly the cells that they touch, up to the margin. */
static void cells_are_those_that_are_touched(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; seed++) {
        struct kiln_voxels v = {.plane_count = 0};
        make_soup(seed, 12, 0.0f);
        const struct kiln_voxels_input input = soup_input(0.11f);
        build(&v, &input, 2);
        uint32_t marked = 0, touched = 0, near = 0;
        for (size_t cell = 0; cell < cells_of(&v); cell++) {
            double low[3], high[3];
            bool within = false, around = false;
            box_of(&v, cell, 1.0, low, high);
            for (uint32_t i = 0; i < soup.count; i++)
                within = within || touches(i, 0, low, high);
            box_of(&v, cell, 1.01, low, high);
            for (uint32_t i = 0; i < soup.count; i++)
                around = around || touches(i, 0, low, high);
            const bool found = v.marks[cell] > 0.0f;
            assert_true(found || !within);
            assert_true(around || !found);
            marked += found;
            touched += within;
            near += around;
        }
        assert_int_equal(marked, v.plane_count);
        assert_true(touched > 100 && marked >= touched && marked <= near);
        assert_true(marked < touched + touched / 20);
        kiln_voxels_finish(&v);
        assert_null(v.marks);
    }
}

static void what_moves_marks_all_cells_on_its_way(void **state)
{
    (void)state;
    struct kiln_voxels v = {.plane_count = 0};
    make_soup(9, 8, 0.5f);
    const struct kiln_voxels_input input = soup_input(0.11f);
    build(&v, &input, 2);
    uint32_t touched = 0;
    for (size_t cell = 0; cell < cells_of(&v); cell++) {
        double low[3], high[3];
        bool within = false;
        box_of(&v, cell, 1.0, low, high);
        for (uint32_t i = 0; i < soup.count; i++)
            for (int part = 0; part <= 20; part++)
                within = within || touches(i, part / 20.0, low, high);
        assert_true(v.marks[cell] > 0.0f || !within);
        touched += within;
    }
    assert_true(touched > 300 && v.plane_count < 3 * touched);
    kiln_voxels_finish(&v);
}

/* Is a place above or below a triangle of the soup? */
static bool is_over(uint32_t triangle, const double at[3])
{
    int left = 0, right = 0;
    for (uint32_t k = 0; k < 3; k++) {
        const float *a = soup.after[3 * triangle + k], *b = soup.after[3 * triangle + (k + 1) % 3];
        const double side = ((double)b[0] - (double)a[0]) * (at[2] - (double)a[2]) -
                            ((double)b[2] - (double)a[2]) * (at[0] - (double)a[0]);
        left += side > 0;
        right += side < 0;
    }
    return left == 3 || right == 3;
}

/* Particles fall: of what faces up, the triangle that is highest in the middle of the cell, or if
 * none is there, whose plane is; what faces down only where nothing else is. */
static void check_kept(uint32_t seed, uint32_t *contested, uint32_t *over)
{
    struct kiln_voxels v = {.plane_count = 0};
    make_soup(seed, TRIANGLES, 0.0f);
    const double cell_m = 0.4;
    const struct kiln_voxels_input input = soup_input((float)cell_m);
    build(&v, &input, 2);
    for (size_t cell = 0; cell < cells_of(&v); cell++) {
        if (v.marks[cell] <= 0.0f)
            continue;
        const uint32_t kept = v.planes[(uint32_t)v.marks[cell] - 1].triangle;
        double low[3], high[3], middle[3];
        box_of(&v, cell, 1.0, low, high);
        for (int c = 0; c < 3; c++)
            middle[c] = 0.5 * (low[c] + high[c]);
        bool kept_up, up;
        const double kept_depth = depth_below(kept, middle, &kept_up);
        const bool kept_over = is_over(kept, middle) && fabs(kept_depth) < 0.505 * cell_m;
        for (uint32_t i = 0; i < soup.count; i++) {
            if (i == kept || !touches(i, 0, low, high))
                continue;
            const double depth = depth_below(i, middle, &up);
            const bool is_met = is_over(i, middle) && fabs(depth) < 0.495 * cell_m;
            assert_true(kept_up || !up);
            (*contested)++;
            if (kept_up != up)
                continue;
            *over += is_met;
            assert_true(kept_over || !is_met);
            if (kept_over == is_met && fabs(fabs(depth) - 0.5 * cell_m) > 0.005 * cell_m)
                assert_true(depth > kept_depth - 0.02 * (0.2 + fabs(depth)));
        }
    }
    kiln_voxels_finish(&v);
}

static void the_plane_that_is_met_first_is_kept(void **state)
{
    (void)state;
    uint32_t contested = 0, over = 0;
    for (uint32_t seed = 1; seed <= 8; seed++)
        check_kept(seed * 7919, &contested, &over);
    assert_true(contested > 1000 && over > 5);
}

static void of_the_same_triangles_the_first_is_kept(void **state)
{
    (void)state;
    struct kiln_voxels v = {.plane_count = 0};
    make_soup(5, 20, 0.1f);
    for (uint32_t i = 10; i < 20; i++)
        memcpy(soup.triangles[i], soup.triangles[i - 10], sizeof soup.triangles[i]);
    const struct kiln_voxels_input input = soup_input(0.2f);
    build(&v, &input, 2);
    for (uint32_t i = 0; i < v.plane_count; i++)
        assert_true(v.planes[i].triangle < 10);
    kiln_voxels_finish(&v);
}

/* A plane goes through the triangle at both ends, and its normal is that of the triangle. */
static void planes_are_those_of_their_triangles(void **state)
{
    (void)state;
    struct kiln_voxels v = {.plane_count = 0};
    make_soup(11, 30, 0.3f);
    const struct kiln_voxels_input input = soup_input(0.15f);
    build(&v, &input, 2);
    assert_true(v.plane_count > 200);
    for (uint32_t i = 0; i < v.plane_count; i++) {
        const struct kiln_voxel *plane = &v.planes[i];
        const uint32_t first = 3 * plane->triangle;
        const float3 normals[2] = {plane->normal, plane->normal_end};
        const float3 places[2] = {plane->start, plane->end};
        for (int end = 0; end < 2; end++) {
            const float(*p)[3] = (const float(*)[3])(end ? soup.after : soup.before) + first;
            const float3 n = normals[end], at = places[end];
            const double length = sqrt((double)n.x * (double)n.x + (double)n.y * (double)n.y +
                                       (double)n.z * (double)n.z);
            assert_true(fabs(length - 1) < 1e-6);
            for (int k = 0; k < 3; k++) {
                const double off = (double)n.x * ((double)p[k][0] - (double)at.x) +
                                   (double)n.y * ((double)p[k][1] - (double)at.y) +
                                   (double)n.z * ((double)p[k][2] - (double)at.z);
                assert_true(fabs(off) < 2e-5);
            }
        }
    }
    kiln_voxels_finish(&v);
}

static void no_plane_is_nearer_than_marks_say(void **state)
{
    (void)state;
    struct kiln_voxels v = {.plane_count = 0};
    make_soup(3, 3, 0.0f);
    const struct kiln_voxels_input input = soup_input(0.12f);
    build(&v, &input, 2);
    const int size[3] = {(int)v.size[0], (int)v.size[1], (int)v.size[2]};
    for (int i = 0; i < (int)cells_of(&v); i++) {
        const int at[3] = {i % size[0], i / size[0] % size[1], i / size[0] / size[1]};
        int least = 8;
        for (int k = 0; k < (int)cells_of(&v); k++) {
            if (v.marks[k] <= 0.0f)
                continue;
            const int other[3] = {k % size[0], k / size[0] % size[1], k / size[0] / size[1]};
            int far = 0;
            for (int c = 0; c < 3; c++)
                far = abs(other[c] - at[c]) > far ? abs(other[c] - at[c]) : far;
            least = far < least ? far : least;
        }
        if (least > 0)
            assert_int_equal((int)v.marks[i], 1 - least);
    }
    kiln_voxels_finish(&v);
}

static void threads_are_of_no_account(void **state)
{
    (void)state;
    make_soup(21, TRIANGLES, 0.2f);
    struct kiln_voxels one = {.plane_count = 0}, many = {.plane_count = 0};
    for (int again = 0; again < 4; again++) {
        const struct kiln_voxels_input input = soup_input(again % 2 ? 0.04f : 0.07f);
        build(&one, &input, 1);
        build(&many, &input, (uint32_t)again + 2); /* also over what it has made before */
        assert_memory_equal(one.size, many.size, sizeof one.size);
        assert_int_equal(one.plane_count, many.plane_count);
        assert_memory_equal(one.marks, many.marks, cells_of(&one) * sizeof *one.marks);
        for (uint32_t i = 0; i < one.plane_count; i++)
            assert_memory_equal(&one.planes[i], &many.planes[i], sizeof one.planes[i]);
        kiln_voxels_finish(&one);
    }
    kiln_voxels_finish(&many);
}

/* Far out, vast and thin as nothing: within the limits, or nothing at all. */
static void absurd_triangles_are_borne(void **state)
{
    (void)state;
    static const float scales[] = {0.0f, 1e-6f, 1.0f, 1e3f, 9e5f};
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
        struct kiln_voxels v = {.plane_count = 0};
        make_soup(2, 12, 0.1f);
        for (uint32_t i = 0; i < 3 * soup.count; i++)
            for (int c = 0; c < 3; c++) {
                soup.before[i][c] *= scales[s];
                soup.after[i][c] *= scales[s];
            }
        for (int k = 0; k < 3; k++) /* a line */
            memcpy(soup.after[k], soup.after[0], sizeof soup.after[0]);
        struct kiln_voxels_input input = soup_input(0.01f);
        build(&v, &input, 2);
        assert_true(cells_of(&v) <= KILN_MAX_VOXEL_CELLS);
        for (int c = 0; c < 3; c++)
            assert_true(v.size[c] >= 3 && v.size[c] <= KILN_MAX_VOXEL_EDGE);
        assert_true(v.plane_count > 0 || scales[s] < 1e-3f);
        kiln_voxels_finish(&v);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_those_that_are_touched),
        cmocka_unit_test(what_moves_marks_all_cells_on_its_way),
        cmocka_unit_test(the_plane_that_is_met_first_is_kept),
        cmocka_unit_test(of_the_same_triangles_the_first_is_kept),
        cmocka_unit_test(planes_are_those_of_their_triangles),
        cmocka_unit_test(no_plane_is_nearer_than_marks_say),
        cmocka_unit_test(threads_are_of_no_account),
        cmocka_unit_test(absurd_triangles_are_borne),
        cmocka_unit_test(what_would_take_long_is_refused),
    };
    return cmocka_run_group_tests_name("voxels", tests, NULL, NULL);
}
