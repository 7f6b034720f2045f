/* The readers of OBJ, PLY and STL (decode/obj.c, ply.c, stl.c). If this fails, kiln refuses or
 * misreads scans and models for printing. What is expected of the files in tests/meshes is what
 * three.js reads in them (tests/meshes/expect.mjs); the small texts here have their triangles
 * beside them.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh.h"
#include "asset/geometry/skin.h"
#include "support/cmocka.h"
#include "support/errors.h"

#define FOLDER KILN_SOURCE_DIR "/tests/meshes/"

enum { POSITION = 3, NORMAL = 6, ALL = 8 }; /* the first numbers of a corner that are compared */

/* ---- files ----------------------------------------------------------------------------------- */

static void expect_corner(const struct kiln_mesh *mesh, uint32_t vertex, const float *expected,
                          int compared, const char *name)
{
    float found[ALL] = {0};
    memcpy(found, mesh->vertices[vertex], sizeof mesh->vertices[vertex]);
    if (mesh->uvs)
        memcpy(found + NORMAL, mesh->uvs[vertex], sizeof mesh->uvs[vertex]);
    for (int i = 0; i < compared; i++) {
        if (fabsf(found[i] - expected[i]) > 1e-6f)
            fail_msg("%s: number %d of a corner is %g, not %g", name, i, (double)found[i],
                     (double)expected[i]);
    }
}

/* Compares a file, triangle for triangle, with what three.js reads in it or in another one. */
static void expect_file(const char *name, const char *as, int compared)
{
    struct kiln_error error = {0};
    char path[512];
    snprintf(path, sizeof path, FOLDER "%s", name);
    struct kiln_mesh *mesh = compared == ALL ? kiln_mesh_load_unwrapped(NULL, path, &error)
                                             : kiln_mesh_load(NULL, path, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    snprintf(path, sizeof path, FOLDER "%s.expect", as);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    uint32_t triangle = 0;
    for (char line[1024]; fgets(line, sizeof line, file); triangle++) {
        char *at = line;
        assert_true(triangle < mesh->triangle_count);
        for (int c = 0; c < 3; c++) {
            float expected[ALL];
            for (int i = 0; i < ALL; i++)
                expected[i] = strtof(at, &at);
            expect_corner(mesh, mesh->triangles[triangle][c], expected, compared, name);
        }
        assert_string_equal(at, "\n");
    }
    fclose(file);
    assert_int_equal(triangle, mesh->triangle_count);
    assert_int_equal(triangle, 12);
    kiln_mesh_destroy(&mesh);
}

static void files_are_read_as_by_three_js(void **state)
{
    (void)state;
    expect_file("mixed.obj", "mixed.obj", ALL);
    expect_file("plain.ply", "plain.ply", POSITION);
    expect_file("quads.ply", "plain.ply", POSITION); /* divided as the triangles of the other are */
    expect_file("more.ply", "more.ply", NORMAL);
    expect_file("more.ply", "more.ply", ALL);
    expect_file("little.ply", "little.ply", ALL);
    expect_file("big.ply", "big.ply", ALL);
    expect_file("little_types.ply", "little_types.ply", POSITION);
    expect_file("big_types.ply", "big_types.ply", POSITION);
    expect_file("text.stl", "text.stl", POSITION);
    expect_file("two.stl", "two.stl", POSITION);
    expect_file("capitals.stl", "text.stl", POSITION);
    expect_file("binary.stl", "binary.stl", POSITION);
    expect_file("solid.stl", "solid.stl", POSITION);
}

/* ---- texts ----------------------------------------------------------------------------------- */

static struct kiln_mesh *parse(const void *bytes, size_t size, const char *name)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(bytes, size, name, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    return mesh;
}

static void refuse(const char *text, const char *name, const char *reason)
{
    struct kiln_error error = {0};
    assert_null(kiln_mesh_parse(text, strlen(text), name, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s: %s", name, reason);
}

#define SQUARE       "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
#define FACES(count) "element face " count "\nproperty list uchar int vertex_indices\n"
#define POINTS       "0 0 0\n4 0 0\n4 4 0\n0 4 0\n"
#define PLY          "ply\nformat ascii 1.0\n"

static void expect_corners(const char *text, const char *corners)
{
    struct kiln_mesh *mesh = parse(text, strlen(text), "test.ply");
    char found[256] = "";
    size_t length = 0;
    for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const float *v = mesh->vertices[mesh->triangles[i / 3][i % 3]];
        length += (size_t)snprintf(found + length, sizeof found - length, "%s%g%g",
                                   i % 3 > 0 ? " "
                                   : i > 0   ? ", "
                                             : "",
                                   (double)v[0], (double)v[1]);
    }
    assert_string_equal(found, corners);
    kiln_mesh_destroy(&mesh);
}

static void faces_and_strips_become_triangles(void **state)
{
    (void)state;
    expect_corners(PLY SQUARE FACES("1") "end_header\n" POINTS "4 0 1 2 3\n", "00 40 44, 00 44 04");
    expect_corners(
        PLY "Created by Blender3D 247\ncomment element vertex 9\nobj_info a\n\n" SQUARE FACES(
            "1") "end_header\n" POINTS "3 0 1 2\n",
        "00 40 44");
    /* numbers may stand on any line, and faces of two corners count for nothing */
    expect_corners(
        PLY SQUARE FACES("3") "end_header\n0 0 0 4 0 0\n4 4 0 0\n4 0\n2 0 1 1\n0 3 0 1\n2",
        "00 40 44");
    /* a strip, one more, and one that goes on by way of a triangle without an area */
    expect_corners(PLY SQUARE "element tristrips 1\nproperty list int int vertex_indices\n"
                              "end_header\n" POINTS "13 0 1 3 2 -1 0 1 2 -1 0 0 1 2\n",
                   "00 40 04, 04 40 44, 00 40 44, 40 00 44");
}

/* Lines of the header may end with '\r' alone; the first number behind it may have the byte of
 * '\n'. */
static void headers_end_where_they_say(void **state)
{
    static const unsigned char little[] =
        "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar x\r"
        "property uchar y\rproperty uchar z\relement face 1\r"
        "property list uchar uchar vertex_index\rend_header\r\n\0\0\0\n\0\0\0\n\3\0\1\2";
    (void)state;
    struct kiln_mesh *mesh = parse(little, sizeof little - 1, "mac.ply");
    assert_int_equal(mesh->triangle_count, 1);
    assert_true(mesh->max[0] == 10.0f && mesh->max[1] == 10.0f && mesh->max[2] == 10.0f);
    kiln_mesh_destroy(&mesh);
}

static void faults_of_ply_are_named(void **state)
{
    (void)state;
    refuse("plx\n", "a.ply", "the contents of the file are not those of a .ply file");
    refuse("ply\n" SQUARE "end_header\n", "a.ply", "the header does not say the format");
    refuse(PLY SQUARE, "a.ply", "the header has no end_header");
    refuse("ply\nformat text 1.0\n", "a.ply",
           "line 2: 'text'; allowed is a format: ascii, binary_little_endian or binary_big_endian");
    refuse(PLY "element vertex -1\n", "a.ply",
           "line 3: '-1'; allowed is how many there are of an element");
    refuse(PLY "property float x\n", "a.ply", "line 3: a property stands before the first element");
    refuse(
        PLY "element vertex 3\nproperty real x\n", "a.ply",
        "line 4: 'real'; allowed is a type: char, uchar, short, ushort, int, uint, float, double, "
        "int8, uint8, int16, uint16, int32, uint32, float32 or float64");
    refuse(PLY "element face 3\nproperty list float int vertex_index\n", "a.ply",
           "line 4: 'float'; allowed is a type of integers, for the length of a list");
    refuse(PLY "element vertex 1048577\nproperty float x\nend_header\n", "a.ply",
           "the mesh has 1048577 of the element 'vertex'; allowed are 1048576");
    refuse(PLY "element vertex 3\nproperty float x\nproperty float y\nend_header\n", "a.ply",
           "the vertices lack a property x, y or z");
    refuse(PLY FACES("1") SQUARE "end_header\n3 0 1 2\n" POINTS, "a.ply",
           "the element 'face' stands before 'vertex'; allowed is behind it");
    refuse(PLY SQUARE SQUARE FACES("1") "end_header\n" POINTS POINTS, "a.ply",
           "the file has two elements 'vertex'; allowed is one");
    refuse(PLY SQUARE FACES("1") "end_header\n" POINTS "3 0 1 4\n", "a.ply",
           "a face names vertex 4; allowed are 0 to 3");
    refuse(PLY SQUARE FACES("1") "end_header\n" POINTS "3 0 1 -1\n", "a.ply",
           "a face names vertex -1; allowed are 0 to 3");
    refuse(PLY SQUARE FACES("1") "end_header\n" POINTS "3 0 1\n", "a.ply",
           "the file ends within the element 'face'");
    refuse(PLY SQUARE FACES("1") "end_header\n" POINTS "300000000 0 1\n", "a.ply",
           "a list of the element 'face' has 300000000 numbers, which the file has not");
    refuse(PLY SQUARE FACES("1") "end_header\n0 0 0\n4 0 a\n", "a.ply",
           "line 11: 'a' is not a number");
    refuse(PLY SQUARE "end_header\n" POINTS, "a.ply",
           "the mesh has no triangles, only points or lines");
}

static void faults_of_stl_are_named(void **state)
{
    (void)state;
    refuse("solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
           "a.stl", "line 7: a facet has 2 vertices; allowed are 3");
    refuse("solid\nfacet\nouter loop\nvertex 0 0 x\n", "a.stl",
           "line 4: 'x' of a vertex is not a number");
    refuse("solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1", "a.stl",
           "the file ends within a facet");
    refuse("solid of nothing\nendsolid\n", "a.stl", "the mesh has no triangles");
    refuse(
        "facet", "a.stl",
        "the file has 5 bytes and does not begin with 'solid'; allowed are at least 84 bytes, or "
        "text");
    char cut[200];
    memset(cut, 'b', sizeof cut);
    memset(cut + 80, 0, 4);
    cut[80] = 3;
    struct kiln_error error = {0};
    assert_null(kiln_mesh_parse(cut, sizeof cut, "cut.stl", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "cut.stl: the file has 200 bytes; its 3 triangles take 234");
    assert_null(kiln_skin_parse(cut, sizeof cut, "cut.stl", &error));
    expect_error(&error, KILN_INVALID_INPUT, "cut.stl: the file has no animation");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_read_as_by_three_js),
        cmocka_unit_test(faces_and_strips_become_triangles),
        cmocka_unit_test(headers_end_where_they_say),
        cmocka_unit_test(faults_of_ply_are_named),
        cmocka_unit_test(faults_of_stl_are_named),
    };
    return cmocka_run_group_tests_name("scans", tests, NULL, NULL);
}
