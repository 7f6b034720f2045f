/* lib/asset/geometry/mesh_measure.c against bodies whose mean shadow and thickness are known. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "asset/geometry/mesh_measure.h"
#include "support/cmocka.h"

static struct kiln_mesh_measure measure(const char *text)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(text, strlen(text), "test.obj", &error);
    if (!mesh)
        fail_msg("%s", error.message);
    const struct kiln_mesh_measure m = kiln_mesh_measure(mesh);
    kiln_mesh_destroy(&mesh);
    return m;
}

static bool is_near(float a, double b)
{
    return fabs((double)a - b) < 1e-5 * (1 + fabs(b));
}

/* A box of 2 x 1 x 1 in one corner of space: a quarter of its surface. */
static void a_box(void **state)
{
    (void)state;
    const struct kiln_mesh_measure m =
        measure("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\n"
                "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    assert_true(is_near(m.middle[0], 1) && is_near(m.middle[1], 0.5) && is_near(m.middle[2], 0.5));
    assert_true(is_near(m.edge, 2) && is_near(m.reach, sqrt(1.5)));
    assert_true(is_near(m.shadow_radius, sqrt(10 / (4 * 3.14159265358979))));
}

/* Of a sheet, seen from both sides, half of it; and the same with a triangle for each side. */
static void a_sheet(void **state)
{
    (void)state;
    static const char *const sheets[] = {
        "v 0 0 0\nv 3 0 0\nv 0 0 1\nf 1 2 3\n",
        "v 0 0 0\nv 3 0 0\nv 0 0 1\nv 0 0 0\nv 3 0 0\nv 0 0 1\nf 1 2 3\nf 6 5 4\n"};
    for (size_t i = 0; i < 2; i++) {
        const struct kiln_mesh_measure m = measure(sheets[i]);
        assert_true(is_near(m.edge, 3) && is_near(m.reach, sqrt(2.5)));
        assert_true(is_near(m.shadow_radius, sqrt(0.75 / 3.14159265358979)));
    }
}

/* Writes a cube between -half and half. inside_out: its triangles run the other way. */
static size_t write_cube(char *text, size_t size, double half, bool inside_out)
{
    static const int faces[6][4] = {{-5, -6, -7, -8}, {-4, -3, -2, -1}, {-8, -7, -3, -4},
                                    {-7, -6, -2, -3}, {-6, -5, -1, -2}, {-5, -8, -4, -1}};
    size_t used = 0;
    for (int i = 0; i < 8; i++) {
        const int x = i % 4 == 1 || i % 4 == 2, y = i % 4 >= 2, z = i >= 4;
        used += (size_t)snprintf(text + used, size - used, "v %g %g %g\n", x ? half : -half,
                                 y ? half : -half, z ? half : -half);
    }
    for (int i = 0; i < 6; i++) {
        const int *f = faces[i];
        used +=
            (size_t)snprintf(text + used, size - used, "f %d %d %d %d\n", f[inside_out ? 3 : 0],
                             f[inside_out ? 2 : 1], f[inside_out ? 1 : 2], f[inside_out ? 0 : 3]);
    }
    return used;
}

static double thinnest(const char *text)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(text, strlen(text), "test.obj", &error);
    double found = -1;
    if (!mesh)
        fail_msg("%s", error.message);
    assert_true(kiln_mesh_thinnest(mesh, &found));
    kiln_mesh_destroy(&mesh);
    return found;
}

/* A cube is as thin as its edge, whichever way its triangles run; a hollow one as its wall, which
 * is 0.1; a sheet has no other side. */
static void the_thinnest_part(void **state)
{
    (void)state;
    char text[2048];
    write_cube(text, sizeof text, 1, false);
    assert_true(fabs(thinnest(text) - 2) < 1e-6);
    write_cube(text, sizeof text, 1, true);
    assert_true(fabs(thinnest(text) - 2) < 1e-6);
    const size_t used = write_cube(text, sizeof text, 1, false);
    write_cube(text + used, sizeof text - used, 0.9, true);
    assert_true(fabs(thinnest(text) - 0.1) < 1e-6);
    assert_true(isinf(thinnest("v 0 0 0\nv 3 0 0\nv 0 0 1\nf 1 2 3\n")));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box),
        cmocka_unit_test(a_sheet),
        cmocka_unit_test(the_thinnest_part),
    };
    return cmocka_run_group_tests_name("mesh_measure", tests, NULL, NULL);
}
