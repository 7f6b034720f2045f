/* The reader of OBJ (decode/obj.c). If this fails, kiln refuses or garbles OBJ files that other
 * programs write. The spellings below all say one mesh; the mesh that is expected stands here as
 * numbers, which come from no reader. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh.h"
#include "support/cmocka.h"
#include "support/errors.h"

static struct kiln_mesh *parse(const char *text)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(text, strlen(text), "test.obj", &error);
    if (!mesh)
        fail_msg("%s\nin\n%s", error.message, text);
    return mesh;
}

static void refuse(const char *text, const char *reason)
{
    struct kiln_error error = {0};
    assert_null(kiln_mesh_parse(text, strlen(text), "test.obj", &error));
    expect_error(&error, KILN_INVALID_INPUT, "test.obj: %s", reason);
}

/* Checks that the mesh has these triangles, in this order, by the positions of their corners. */
static void expect_triangles(const char *text, const float (*expected)[3][3], size_t count)
{
    struct kiln_mesh *mesh = parse(text);
    if (mesh->triangle_count != count)
        fail_msg("%u triangles, not %zu, in\n%s", mesh->triangle_count, count, text);
    for (size_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const float *found = mesh->vertices[mesh->triangles[i][c]];
            if (memcmp(found, expected[i][c], sizeof expected[i][c]) != 0)
                fail_msg("corner %d of triangle %zu is %g %g %g, not %g %g %g, in\n%s", c, i,
                         (double)found[0], (double)found[1], (double)found[2],
                         (double)expected[i][c][0], (double)expected[i][c][1],
                         (double)expected[i][c][2], text);
        }
    }
    kiln_mesh_destroy(&mesh);
}

/* ---- spellings ------------------------------------------------------------------------------- */

#define A                                                                                          \
    {                                                                                              \
        -1, 0, 0.5f                                                                                \
    }
#define B                                                                                          \
    {                                                                                              \
        1, 0, 0                                                                                    \
    }
#define C                                                                                          \
    {                                                                                              \
        0, 2.25f, 0                                                                                \
    }
#define D                                                                                          \
    {                                                                                              \
        0, 0, 100                                                                                  \
    }

static const float PAIR[2][3][3] = {{A, B, C}, {A, B, D}};

#define V  "v -1 0 0.5\nv 1 0 0\nv 0 2.25 0\nv 0 0 100\n"
#define F  "f 1 2 3\nf 1 2 4\n"
#define VT "vt 0 0\nvt 1 0\nvt 0 1\n"
#define VN "vn 0 0 1\nvn 0 1 0\n"

static const char *const spellings[] = {
    V F,
    "\xef\xbb\xbf" V F,
    "\xef\xbb\xbf# exported\n" V F,
    "# a comment\n#\n\n" V "\n   \n# faces\n" F,
    "v -1 0 0.5 # left\nv 1 0 0# right\nv 0 2.25 0 #\nv 0 0 100\t# far\nf 1 2 3 # 1\nf 1 2 4 #2\n",
    "  v -1 0 0.5\n\tv 1 0 0\n \t v 0 2.25 0\n v 0 0 100\n  f 1 2 3\n\tf 1 2 4\n",
    "v\t-1\t0\t0.5\nv\t1\t0\t0\nv\t0\t2.25\t0\nv\t0\t0\t100\nf\t1\t2\t3\nf\t1\t2\t4\n",
    "v   -1   0  0.5  \nv 1 0 0 \nv 0 2.25 0\t\nv 0 0 100 \nf  1   2  3  \nf 1 2 4 \n",
    "v -1 0 0.5\r\nv 1 0 0\r\nv 0 2.25 0\r\nv 0 0 100\r\nf 1 2 3\r\nf 1 2 4\r\n",
    "v -1 0 0.5\rv 1 0 0\rv 0 2.25 0\rv 0 0 100\rf 1 2 3\rf 1 2 4\r",
    V "f 1 2 3\nf 1 2 4",
    "v -1 \\\n0 0.5\nv 1 0 0\nv 0 2.25 0\nv 0 0 100\nf 1 \\\n 2 \\\n3\nf 1 2\\\n 4\n",
    "v -1 \\\r\n0 0.5\r\nv 1 0 0\r\nv 0 2.25 0\r\nv 0 0 100\r\nf 1 2 \\\r\n3\r\nf 1 2 4\r\n",
    "v -1. +0 .5\nv +1 0.0 -0\nv 0e0 2.25 0\nv 0 0 1e2\n" F,
    "v -1.000000 0.000000 5e-1\nv 1E0 0 0\nv 0 225e-2 0\nv 0 0 1.0E+02\n" F,
    "v -1 0 0.5 1\nv 1 0 0 1.0\nv 0 2.25 0 2\nv 0 0 100 0\n" F,
    "v -1 0 0.5 1 0 0\nv 1 0 0 0 1 0\nv 0 2.25 0 0 0 1\nv 0 0 100 0.5 0.5 0.5\n" F,
    "v -1 0 0.5 1 1 0 0\nv 1 0 0 1 0 1 0\nv 0 2.25 0 1 0 0 1\nv 0 0 100 1 1 1 1\n" F,
    "v -1 0 0.5 255 0 0 255\nv 1 0 0\nv 0 2.25 0\nv 0 0 100 0 0\n" F,
    V VT "f 1/1 2/2 3/3\nf 1/1 2/2 4/3\n",
    V "vt 0\nvt 1\nvt 0.5\nf 1/1 2/2 3/3\nf 1/1 2/2 4/3\n",
    V "vt 0 0 0\nvt 1 0 0\nvt 0 1 0\nf 1/1 2/2 3/3\nf 1/1 2/2 4/3\n",
    V "vt 0 0\nvt 1\nvt nan -nan(ind)\nf 1/1 2/2 3/3\nf 1/1 2/2 4/3\n",
    V VN "f 1//1 2//1 3//1\nf 1//2 2//2 4//2\n",
    V VT VN "f 1/1/1 2/2/1 3/3/1\nf 1/1/2 2/2/2 4/3/2\n",
    V VT VN "f 1/1/1 2//1 3/3\nf 1 2/2 4/3/2\n",
    V VN "f 1/1/1 2/2/1 3/3/1\nf 1/1/2 2/2/2 4/4/2\n",
    V "f 1/1/1 2/2/2 3/3/3\nf 1/1/1 2/2/2 4/4/4\n",
    V "f 1/1 2/2 3/3\nf 1/1 2/2 4/4\n",
    V "f 1/ 2/ 3/\nf 1// 2// 4//\n",
    V "f -4 -3 -2\nf -4 -3 -1\n",
    V VT "f -4/-3 -3/-2 -2/-1\nf -4/-3 -3/-2 -1/-1\n",
    "v -1 0 0.5\nv 1 0 0\nv 0 2.25 0\nf -3 -2 -1\nv 0 0 100\nf 1 2 -1\n",
    "f 1 2 3\nf 1 2 4\n" V,
    "f 1 2 3\n" V "v 7 7 7\nf 1 2 -2\n",
    V "f 1\nf 1 2\nf 1 2 3\nf\nf 3 4\nf 1 2 4\n",
    V "p 1\nl 1 2\np 1 2 3 4\nl 1/1 2/1 3/1\n" F,
    "mtllib a b.mtl\no thing\ng one two\ns 1\nusemtl red\n" V "f 1 2 3\ns off\ng\nf 1 2 4\n",
    "mg 1 0.5\nvp 0.1 0.2\ncstype bspline\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\nlod 1\n" V F,
    V "fo 1 2 3\nf 1 2 4\n",
    V "F 9 9 9\nfoo 1 2 3\nV 1\n$ f 1 2 3\n" F,
    "\n\n\f\v" V "\v" F "\n\n\n",
    V "f 01 02 +3\nf 1 2 4 #\\\n",
};

static void spellings_say_the_same(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof spellings / sizeof *spellings; i++)
        expect_triangles(spellings[i], PAIR, 2);
}

static void other_encodings_are_named(void **state)
{
    static const struct {
        const char *name, *bytes;
    } cases[] = {{"UTF-16", "\xff\xfev\0 \0001\0"}, {"UTF-16", "\xfe\xff\0v\0 \0001"},
                 {"UTF-16", "v\0 \0001\0 \0"},      {"UTF-16", "\0v\0 \0001\0 "},
                 {"UTF-32", "\xff\xfe\0\0v\0\0\0"}, {"UTF-32", "\0\0\xfe\xff\0\0\0v"}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error = {0};
        assert_null(kiln_mesh_parse(cases[i].bytes, 8, "wide.obj", &error));
        expect_error(&error, KILN_INVALID_INPUT,
                     "wide.obj: the mesh file is text in %s; allowed are ASCII and UTF-8",
                     cases[i].name);
    }
}

/* ---- materials and normals ------------------------------------------------------------------- */

/* Triangles are in the order in which their materials are first used, then in that of the file. */
static void materials_order_triangles(void **state)
{
    static const float expected[5][3][3] = {{C, B, A}, {A, B, C}, {A, B, D}, {B, C, D}, {A, C, D}};
    (void)state;
    expect_triangles(V "f 3 2 1\nusemtl first\nf 1 2 3\nusemtl a b  c\nf 2 3 4\nusemtl first \n"
                       "f 1 2 4\no other\nusemtl\ta b  c\nf 1 3 4\n",
                     expected, 5);
}

/* A face without normals gets computed ones, also beside faces that have them. */
static void normals_may_be_missing(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 0 0\nv 9 1 0\nv 9 0 1\n"
                                   "vn 0 3 4\nf 1//1 2//1 3//1\nf 4 5 6\n");
    const float *given = mesh->vertices[mesh->triangles[0][0]] + 3;
    const float *computed = mesh->vertices[mesh->triangles[1][0]] + 3;
    assert_true(given[0] == 0.0f && given[1] == 0.6f && given[2] == 0.8f);
    assert_true(computed[0] == 1.0f && computed[1] == 0.0f && computed[2] == 0.0f);
    kiln_mesh_destroy(&mesh);
}

/* ---- polygons -------------------------------------------------------------------------------- */

/* Computes twice the area of each triangle by its projection to the plane z = 0. Returns the sum.
 */
static double sum_areas(const struct kiln_mesh *mesh, double *smallest)
{
    double sum = 0;
    *smallest = INFINITY;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *p = mesh->vertices[mesh->triangles[i][0]];
        const float *q = mesh->vertices[mesh->triangles[i][1]];
        const float *r = mesh->vertices[mesh->triangles[i][2]];
        const double area = (double)(q[0] - p[0]) * (double)(r[1] - p[1]) -
                            (double)(q[1] - p[1]) * (double)(r[0] - p[0]);
        sum += area;
        *smallest = area < *smallest ? area : *smallest;
    }
    return sum;
}

/* Polygons of any shape become as many triangles as they have corners, less two, of which none is
 * turned over and whose areas add up to that of the polygon (by the shoelace formula). */
static void polygons_are_covered_once(void **state)
{
    static const char *const polygons[] = {
        "0 0 4 0 4 4 0 4",
        "0 0 4 0 1 1 0 4",                 /* an arrow, with its bend at the third corner */
        "1 1 0 4 0 0 4 0",                 /* the same, from the bend */
        "0 0 5 0 5 5 4 5 4 1 1 1 1 5 0 5", /* a U */
        "0 0 6 0 6 6 2 6 2 4 4 4 4 2 1 2 1 6 0 6",
        "0 0 1 0 2 0 3 0 3 3 0 3",                 /* straight corners */
        "0 0 2 1 4 0 3 2 4 4 2 3 0 4 1 2",         /* a star */
        "0 0 8 0 8 8 0 8 0 1 1 1 1 7 7 7 7 1 0 1", /* a ring that is cut open */
    };
    (void)state;
    for (size_t i = 0; i < sizeof polygons / sizeof *polygons; i++) {
        double x[16], y[16], area = 0, smallest = 0;
        char text[1024] = "";
        size_t count = 0, length = 0;
        for (const char *at = polygons[i]; *at; count++) {
            char *end;
            x[count] = strtod(at, &end);
            y[count] = strtod(end, &end);
            at = end;
            length += (size_t)snprintf(text + length, sizeof text - length, "v %g %g 0\n", x[count],
                                       y[count]);
        }
        length += (size_t)snprintf(text + length, sizeof text - length, "f");
        for (size_t k = 0; k < count; k++) {
            length += (size_t)snprintf(text + length, sizeof text - length, " %zu", k + 1);
            area += x[k] * y[(k + 1) % count] - x[(k + 1) % count] * y[k];
        }
        struct kiln_mesh *mesh = parse(text);
        assert_int_equal(mesh->triangle_count, count - 2);
        if (fabs(sum_areas(mesh, &smallest) - area) > 1e-6 || smallest < -1e-6)
            fail_msg("polygon %s: areas %g, smallest %g; not %g", polygons[i],
                     sum_areas(mesh, &smallest), smallest, area);
        kiln_mesh_destroy(&mesh);
    }
}

/* Quads are divided from the first corner, others around the last one (as assimp 5.2 did it). */
static void convex_polygons_are_divided_as_ever(void **state)
{
    static const float quad[2][3][3] = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}},
                                        {{0, 0, 0}, {4, 4, 0}, {0, 4, 0}}};
    static const float pentagon[3][3][3] = {{{-1, 2, 0}, {0, 0, 0}, {4, 0, 0}},
                                            {{5, 2, 0}, {-1, 2, 0}, {4, 0, 0}},
                                            {{-1, 2, 0}, {5, 2, 0}, {2, 4, 0}}};
    (void)state;
    expect_triangles("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n", quad, 2);
    expect_triangles("v 0 0 0\nv 4 0 0\nv 5 2 0\nv 2 4 0\nv -1 2 0\nf 1 2 3 4 5\n", pentagon, 3);
}

/* A polygon of many corners takes no time that matters. */
static void large_polygons_are_divided(void **state)
{
    enum { CORNERS = 10000 };
    (void)state;
    char *text = malloc((size_t)CORNERS * 60), *end = text;
    double smallest = 0;
    assert_non_null(text);
    for (int i = 0; i < CORNERS; i++) {
        const double a = 2 * acos(-1.0) * i / CORNERS;
        end += sprintf(end, "v %.9f %.9f 0\n", 1000 * cos(a), 1000 * sin(a));
    }
    end += sprintf(end, "f");
    for (int i = 0; i < CORNERS; i++)
        end += sprintf(end, " %d", i + 1);
    struct kiln_mesh *mesh = parse(text);
    assert_int_equal(mesh->triangle_count, CORNERS - 2);
    assert_true(fabs(sum_areas(mesh, &smallest) - 2e6 * acos(-1.0)) < 10);
    kiln_mesh_destroy(&mesh);
    free(text);
}

/* ---- numbers --------------------------------------------------------------------------------- */

/* Decimals are rounded once, to the nearest float, ties to the even one. The middle cases are those
 * that go wrong when a double is rounded again. */
static void numbers_are_rounded_once(void **state)
{
    static const struct {
        const char *text;
        float value;
    } cases[] = {
        {"0.1", 0x1.99999ap-4f},
        {"-.3", -0x1.333334p-2f},
        {"524288.03125", 0x1p19f},              /* a tie, to even */
        {"524288.09375", 0x1.000004p19f},       /* a tie, to even */
        {"1.00000005960464477539062500", 1.0f}, /* a tie: 1 + 2^-24 */
        {"1.00000005960464477539062501", 0x1.000002p0f},
        {"1.000000059604644775390625000000000000000000000000001", 0x1.000002p0f},
        {"1.00000005960464477539062499", 1.0f},
        {"1.00000017881393432617187499", 0x1.000002p0f},
        {"1.00000017881393432617187500", 0x1.000004p0f},
        {"0.000000000000000000000000000000000000001e39", 1.0f},
        {"1e-50", 0.0f},
        {"1.401298464324817e-45", 0x1p-149f},
        {"123456.789012345678901234567890", 0x1.e240cap16f},
        {"0e99999999999999999999", 0.0f},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        snprintf(text, sizeof text, "v %s 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", cases[i].text);
        struct kiln_mesh *mesh = parse(text);
        const float found = mesh->vertices[mesh->triangles[0][0]][0];
        if (found != cases[i].value)
            fail_msg("%s is read as %a, not %a", cases[i].text, (double)found,
                     (double)cases[i].value);
        kiln_mesh_destroy(&mesh);
    }
}

/* ---- what is refused ------------------------------------------------------------------------- */

static void faults_are_named(void **state)
{
    (void)state;
    refuse("# v\n\nv 0 0\n" F, "line 3: a vertex has 2 numbers; needed are 3");
    refuse("v 0 0 # 0\n" F, "line 1: a vertex has 2 numbers; needed are 3");
    refuse(V "vt\n" F, "line 5: a texture coordinate has 0 numbers; needed are 1");
    refuse(V "vn 0 1\n" F, "line 5: a normal has 2 numbers; needed are 3");
    refuse("v 0 0,5 0\n" F, "line 1: '0,5' of a vertex is not a number");
    refuse("v 0 0x1 0\n" F, "line 1: '0x1' of a vertex is not a number");
    refuse("v 0 1e 0\n" F, "line 1: '1e' of a vertex is not a number");
    refuse("v 0 . 0\n" F, "line 1: '.' of a vertex is not a number");
    refuse("v 1 \\\n2 \\\n\nv 0 - 0\n" F, "line 1: a vertex has 2 numbers; needed are 3");
    refuse("v 1 \\\n2 \\\n3\nv 0 - 0\n" F, "line 4: '-' of a vertex is not a number");
    refuse(V "f 1 2 5\n", "line 5: a face names vertex 5; the file has 4, and 4 up to this line");
    refuse(V "f 1 2 0\n", "line 5: a face names vertex 0; the file has 4, and 4 up to this line");
    refuse("v 0 0 0\nf -1 -2 -3\nv 1 1 1\n",
           "line 2: a face names vertex -2; the file has 2, and 1 up to this line");
    refuse(V VT "f 1/1 2/2 3/4\n",
           "line 8: a face names texture coordinate 4; the file has 3, and 3 up to this line");
    refuse(V VN "f 1//1 2//2 3//-3\n",
           "line 7: a face names normal -3; the file has 2, and 2 up to this line");
    refuse(V "f 1 2 x\n", "line 5: 'x' in a face is not a number of a vertex");
    refuse(V "f 1 2 /3\n", "line 5: '' in a face is not a number of a vertex");
    refuse(V "f 1 2 3/1/1/1\n",
           "line 5: a corner '3/1/1/1' has more than 3 numbers; no more are allowed");
    refuse("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
           "vertex 0 lies at nan nan nan; allowed are numbers within -1e+06 and 1e+06");
    refuse(V "f 1 2\nf 3\n", "the mesh has no triangles, only points or lines");
    refuse(V, "the mesh has no triangles");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spellings_say_the_same),
        cmocka_unit_test(other_encodings_are_named),
        cmocka_unit_test(materials_order_triangles),
        cmocka_unit_test(normals_may_be_missing),
        cmocka_unit_test(polygons_are_covered_once),
        cmocka_unit_test(convex_polygons_are_divided_as_ever),
        cmocka_unit_test(large_polygons_are_divided),
        cmocka_unit_test(numbers_are_rounded_once),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests_name("obj", tests, NULL, NULL);
}
