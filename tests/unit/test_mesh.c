/* lib/asset/mesh: what is read of a mesh file, and what is refused. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "asset/geometry/mesh.h"
#include "asset/loader/loader.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

static struct kiln_mesh *parse(const char *text, const char *name)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(text, strlen(text), name, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    return mesh;
}

static void refuse(const void *bytes, size_t size, const char *name, const char *reason)
{
    struct kiln_error error = {0};
    assert_null(kiln_mesh_parse(bytes, size, name, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s: %s", name, reason);
}

static void refuse_text(const char *text, const char *name, const char *reason)
{
    refuse(text, strlen(text), name, reason);
}

static const char CUBE[] = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
                           "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

/* Twelve triangles; at creases, every face has corners of its own, whose normals are the face's. */
static void cube_is_read(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = parse(CUBE, "cube.OBJ");
    assert_int_equal(mesh->triangle_count, 12);
    assert_int_equal(mesh->vertex_count, 24);
    for (int c = 0; c < 3; c++)
        assert_true(mesh->min[c] == -1.0f && mesh->max[c] == 1.0f);
    double area = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *p = mesh->vertices[mesh->triangles[i][0]];
        const float *q = mesh->vertices[mesh->triangles[i][1]];
        const float *r = mesh->vertices[mesh->triangles[i][2]];
        double cross[3], along = 0;
        for (int c = 0; c < 3; c++) {
            int d = (c + 1) % 3, e = (c + 2) % 3;
            cross[c] = (double)(q[d] - p[d]) * (double)(r[e] - p[e]) -
                       (double)(q[e] - p[e]) * (double)(r[d] - p[d]);
            along += cross[c] * (double)p[3 + c];
        }
        area += 0.5 * along; /* the normal is that of the winding, of length 1 */
    }
    assert_true(fabs(area - 24.0) < 1e-4);
    kiln_mesh_destroy(&mesh);
    assert_null(mesh);
}

/* Flatter edges are smoothed: on a finely turned cylinder, normals point away from the axis,
 * however its rectangles are divided. */
static void round_things_are_smooth(void **state)
{
    (void)state;
    enum { SIDES = 24 };
    char text[8192] = "";
    size_t length = 0;
    for (int i = 0; i < SIDES; i++) {
        double a = 2 * acos(-1.0) * i / SIDES;
        length += (size_t)snprintf(text + length, sizeof text - length, "v %f 0 %f\nv %f 1 %f\n",
                                   cos(a), sin(a), cos(a), sin(a));
    }
    for (int i = 0; i < SIDES; i++) {
        int next = (i + 1) % SIDES;
        length += (size_t)snprintf(text + length, sizeof text - length, "f %d %d %d %d\n",
                                   2 * i + 1, 2 * i + 2, 2 * next + 2, 2 * next + 1);
    }
    struct kiln_mesh *mesh = parse(text, "tube.obj");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *v = mesh->vertices[i];
        assert_true(v[0] * v[3] + v[2] * v[5] > 0.999999f && v[4] == 0.0f);
    }
    assert_int_equal(mesh->vertex_count, 2 * SIDES);
    kiln_mesh_destroy(&mesh);
}

/* Triangles that all meet at one place are looked at once each, not once for each other. */
static void a_fan_of_many_triangles_takes_no_time(void **state)
{
    (void)state;
    enum { TRIANGLES = 200000 };
    char *text = malloc((size_t)TRIANGLES * 80), *end = text;
    assert_non_null(text);
    end += sprintf(end, "v 0 0 0\n");
    for (int i = 0; i < 2 * TRIANGLES; i++)
        end += sprintf(end, "v %d %d %d\n", 1 + i % 900, 1 + i / 900, 900 + i % 7);
    for (int i = 0; i < TRIANGLES; i++)
        end += sprintf(end, "f 1 %d %d\n", 2 * i + 2, 2 * i + 3);
    struct kiln_mesh *mesh = parse(text, "fan.obj");
    assert_int_equal(mesh->triangle_count, TRIANGLES);
    kiln_mesh_destroy(&mesh);
    free(text);
}

/* ---- glTF ------------------------------------------------------------------------------------ */

/* A tetrahedron twice as large and 2 m up. */
static const char GLTF[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}],"
    " \"nodes\": [{\"translation\": [0, 2, 0], \"children\": [1]}, {\"mesh\": 0, \"scale\": [2, 2, "
    "2]}],"
    " \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}]}],"
    " \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": "
    "\"VEC3\","
    " \"min\": [0, 0, 0], \"max\": [1, 1, 1]},"
    " {\"bufferView\": 1, \"componentType\": 5123, \"count\": 12, \"type\": \"SCALAR\"}],"
    " \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48},"
    " {\"buffer\": 0, \"byteOffset\": 48, \"byteLength\": 24}],"
    " \"buffers\": [{\"byteLength\": 72, \"uri\": \"%s\"}]}";

static void write_gltf(const char *path, const char *uri)
{
    char text[2048];
    snprintf(text, sizeof text, GLTF, uri);
    test_write_file(path, text);
}

static void write_buffer(const char *path, float size)
{
    const float positions[12] = {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size};
    const uint16_t corners[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fwrite(positions, sizeof positions, 1, file) == 1 &&
                fwrite(corners, sizeof corners, 1, file) == 1);
    assert_int_equal(fclose(file), 0);
}

/* A file of the root, by its path in there. */
static struct kiln_mesh *load_below(const char *root, const char *path, struct kiln_error *error)
{
    char absolute[KILN_PATH_SIZE];
    const struct kiln_loader_params params = {.root = root};
    struct kiln_loader *loader = kiln_loader_create(&params);
    assert_non_null(loader);
    snprintf(absolute, sizeof absolute, "%s/%s", root, path);
    struct kiln_mesh *mesh = kiln_mesh_load(loader, absolute, error);
    kiln_loader_destroy(&loader);
    return mesh;
}

static struct kiln_mesh *load(const char *path, const char *root)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = load_below(root, path, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    return mesh;
}

static void buffers_below_are_read_and_hashed(void **state)
{
    const struct test_place *place = *state;
    test_write_file("files/deep/empty", "");
    write_gltf("files/t.gltf", "deep/t.bin");
    write_buffer("files/deep/t.bin", 1.0f);
    struct kiln_mesh *mesh = load("files/t.gltf", place->folder);
    assert_int_equal(mesh->triangle_count, 4);
    assert_true(mesh->min[1] == 2.0f && mesh->max[1] == 4.0f && mesh->max[0] == 2.0f);
    char hash[65];
    memcpy(hash, mesh->hash, sizeof hash);
    assert_int_equal(strlen(hash), 64);
    kiln_mesh_destroy(&mesh);

    mesh = load("files/t.gltf", place->folder);
    assert_string_equal(mesh->hash, hash);
    kiln_mesh_destroy(&mesh);
    write_buffer("files/deep/t.bin", 0.5f);
    mesh = load("files/t.gltf", place->folder);
    assert_true(mesh->max[0] == 1.0f);
    assert_string_not_equal(mesh->hash, hash);
    kiln_mesh_destroy(&mesh);
}

static void buffers_elsewhere_are_refused(void **state)
{
    static const char BELOW[] = "; its files must lie in its folder or below";
    const struct test_place *place = *state;
    test_write_file("files/empty", "");
    test_write_file("elsewhere/empty", "");
    write_buffer("elsewhere/t.bin", 1.0f);
    write_buffer("files/t.bin", 1.0f);
    assert_int_equal(symlink("../elsewhere/t.bin", "files/link.bin"), 0);
    char root[64], absolute[64];
    snprintf(root, sizeof root, "%s/files", place->folder);
    snprintf(absolute, sizeof absolute, "%s/files/t.bin", place->folder);
    const struct {
        const char *uri, *reason;
    } cases[] = {
        {"../elsewhere/t.bin", BELOW},
        {"./../files/t.bin", BELOW},
        {absolute, BELOW},
        {"file:///etc/passwd", BELOW},
        {"http://localhost/t.bin", BELOW},
        {"link.bin", ": the path leads outside the asset root"},
        {"missing.bin", ": the buffer cannot be opened: No such file or directory"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error = {0};
        write_gltf("files/t.gltf", cases[i].uri);
        struct kiln_mesh *mesh = load_below(root, "t.gltf", &error);
        if (mesh)
            fail_msg("%s was read", cases[i].uri);
        expect_error(&error, KILN_INVALID_INPUT, "%s/t.gltf: the mesh file names the file '%s'%s",
                     root, cases[i].uri, cases[i].reason);
    }
    write_gltf("files/t.gltf", "t.bin");
    struct kiln_mesh *mesh = load("t.gltf", root);
    kiln_mesh_destroy(&mesh);
    char text[2048];
    snprintf(text, sizeof text, GLTF, "t.bin");
    refuse_text(
        text, "memory.gltf",
        "the mesh file names the file 't.bin'; a file of this name must not name other files");
}

/* A tetrahedron around the origin, whose volume is 8/3, under a node with a scale; its normals,
 * which a primitive may take, are its positions. */
static const char MIRRORED[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}],"
    " \"nodes\": [{\"mesh\": 0, \"scale\": [%s]}],"
    " \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0%s}, \"indices\": 1}]}],"
    " \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4,"
    " \"type\": \"VEC3\", \"min\": [-1, -1, -1], \"max\": [1, 1, 1]},"
    " {\"bufferView\": 1, \"componentType\": 5123, \"count\": 12, \"type\": \"SCALAR\"},"
    " {\"bufferView\": 2, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\"}],"
    " \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48},"
    " {\"buffer\": 0, \"byteOffset\": 48, \"byteLength\": 24},"
    " {\"buffer\": 0, \"byteOffset\": 72, \"byteLength\": 48}],"
    " \"buffers\": [{\"byteLength\": 120, \"uri\": "
    "\"data:application/octet-stream;base64,AACAPwAAgD8AAIA/AACAvwAAgL8AAIA/A"
    "ACAvwAAgD8AAIC/AACAPwAAgL8AAIC/AAACAAEAAAABAAMAAAADAAIAAQACAAMAOs0TPzr"
    "NEz86zRM/Os0TvzrNE786zRM/Os0TvzrNEz86zRO/Os0TPzrNE786zRO/\"}]}";

/* A mesh under a node that mirrors it faces outwards: its volume by the divergence theorem is that
 * of the file's tetrahedron, with its sign, and normals point outwards, computed or from the file.
 */
static void mirrored_nodes_are_not_inside_out(void **state)
{
    static const char *const scales[] = {"-1, 1, 1", "1, -1.1, 0.9090909", "-1, -1, -1"};
    static const char *const normals[] = {"", ", \"NORMAL\": 2"};
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        char text[4096];
        snprintf(text, sizeof text, MIRRORED, scales[i % 3], normals[i / 3]);
        struct kiln_mesh *mesh = parse(text, "mirrored.gltf");
        double volume = 0;
        for (uint32_t k = 0; k < mesh->triangle_count; k++) {
            const float *p = mesh->vertices[mesh->triangles[k][0]];
            const float *q = mesh->vertices[mesh->triangles[k][1]];
            const float *r = mesh->vertices[mesh->triangles[k][2]];
            double cross[3];
            for (int c = 0; c < 3; c++) {
                const int d = (c + 1) % 3, e = (c + 2) % 3;
                cross[c] = (double)(q[d] - p[d]) * (double)(r[e] - p[e]) -
                           (double)(q[e] - p[e]) * (double)(r[d] - p[d]);
                volume += cross[c] * (double)p[c] / 6;
            }
            for (int v = 0; v < 3; v++) {
                const float *n = mesh->vertices[mesh->triangles[k][v]] + 3;
                assert_true(cross[0] * (double)n[0] + cross[1] * (double)n[1] +
                                cross[2] * (double)n[2] >
                            0);
            }
        }
        assert_true(fabs(volume - 8.0 / 3) < 1e-5);
        kiln_mesh_destroy(&mesh);
    }
}

/* ---- what is no mesh ------------------------------------------------------------------------- */

static void numbers_need_no_zero_before_their_point(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = parse("v 0 -.5 0\nv .75 0\t0\nv 0 0\t.25\nf 1 2 3\n", "short.obj");
    assert_true(mesh->min[1] == -0.5f && mesh->max[0] == 0.75f && mesh->max[2] == 0.25f);
    assert_true(mesh->min[0] == 0.0f && mesh->max[1] == 0.0f && mesh->min[2] == 0.0f);
    kiln_mesh_destroy(&mesh);
}

#define FIRST_GLTF                                                                                 \
    "the file is of glTF version 1; kiln reads version 2, to which the program gltf-pipeline of "  \
    "npm converts it: gltf-pipeline -i OLD -o NEW"

#define NO_MESH                                                                                    \
    "the name is not that of a mesh; allowed are OBJ, glTF, GLB, PLY or STL files (.obj, .gltf, "  \
    ".glb, .ply, .stl)"

static void nonsense_is_refused(void **state)
{
    (void)state;
    refuse_text(CUBE, "cube.3ds", NO_MESH);
    refuse_text(CUBE, "cube", NO_MESH);
    refuse_text("", "empty.obj", "the mesh file is empty");
    refuse_text(CUBE, "cube.glb", "the contents of the file are not those of a .glb file");
    refuse_text(CUBE, "cube.gltf", "the contents of the file are not those of a .gltf file");
    refuse("v 0 0 0\0", 8, "zero.obj", "the contents of the file are not those of a .obj file");
    refuse_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "points.obj", "the mesh has no triangles");
    refuse_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n", "lines.obj",
                "the mesh has no triangles, only points or lines");
    refuse_text("v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n", "far.obj",
                "vertex 1 lies at 1e+09 0 0; allowed are numbers within -1e+06 and 1e+06");
    refuse_text("v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n", "flat.obj",
                "the mesh has no triangle with an area");
    refuse_text("{\"asset\": {\"version\": \"2.0\"}", "cut.gltf", "the JSON is cut short");
    refuse_text("{\"asset\": {\"version\": \"2.0\"},\n\n nodes: []}", "yaml.gltf",
                "line 3 of the JSON is broken: string or '}' expected near 'nodes'");
    refuse_text("{}", "none.gltf",
                "the file does not say of which version of glTF it is: 'asset.version' is missing; "
                "allowed is \"2.0\"");
    refuse_text("{\"asset\": {\"version\": \"1.0\"}}", "first.gltf", FIRST_GLTF);
    refuse_text("{\"asset\": {\"version\": \"3.0\"}}", "later.gltf",
                "the file is of glTF version 3.0; kiln reads version 2");
    refuse_text("{\"meshes\": {\"mesh\": {}}}", "oldest.gltf", FIRST_GLTF);
    refuse("glTF\1\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0", 20, "first.glb", FIRST_GLTF);
}

/* Formats that Blender converts are refused with the command that does it. */
static void other_formats_are_refused_with_a_command(void **state)
{
    (void)state;
    refuse_text(
        "Kaydara", "things/a-1.FBX",
        "FBX is not read; allowed are OBJ, glTF, GLB, PLY or STL files. Blender converts it: "
        "blender -b --python-expr \"import bpy; "
        "bpy.ops.wm.read_factory_settings(use_empty=True); "
        "bpy.ops.import_scene.fbx(filepath='things/a-1.FBX'); "
        "bpy.ops.export_scene.gltf(filepath='things/a-1.glb')\"");
    refuse_text(
        "<", "it's $(x).dae",
        "COLLADA is not read; allowed are OBJ, glTF, GLB, PLY or STL files. Blender converts "
        "it: blender -b --python-expr \"import bpy; "
        "bpy.ops.wm.read_factory_settings(use_empty=True); "
        "bpy.ops.wm.collada_import(filepath='FILE.dae'); "
        "bpy.ops.export_scene.gltf(filepath='FILE.glb')\"");
    refuse_text("BLENDER", "a.blend",
                "a file of Blender is not read; allowed are OBJ, glTF, GLB, PLY or STL files. "
                "Blender converts it: blender -b a.blend --python-expr \"import bpy; "
                "bpy.ops.export_scene.gltf(filepath='a.glb')\"");
    static const char *const usd[] = {"usd", "usda", "usdc", "usdz"};
    for (size_t i = 0; i < sizeof usd / sizeof *usd; i++) {
        char name[16], text[512];
        snprintf(name, sizeof name, "a.%s", usd[i]);
        snprintf(text, sizeof text,
                 "USD is not read; allowed are OBJ, glTF, GLB, PLY or STL files. Blender converts "
                 "it: blender -b --python-expr \"import bpy; "
                 "bpy.ops.wm.read_factory_settings(use_empty=True); "
                 "bpy.ops.wm.usd_import(filepath='%s'); "
                 "bpy.ops.export_scene.gltf(filepath='a.glb')\"",
                 name);
        refuse_text("#usda 1.0", name, text);
    }
}

static void cut_files_are_refused(void **state)
{
    (void)state;
    char *glb = NULL;
    long size = 0;
    FILE *file = fopen(KILN_SOURCE_DIR "/tests/fuzz/corpus/mesh/good/tetrahedron.glb", "rb");
    assert_non_null(file);
    glb = malloc(65536);
    assert_non_null(glb);
    size = (long)fread(glb, 1, 65536, file);
    assert_true(size > 64 && size < 65536);
    fclose(file);
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(glb, (size_t)size, "whole.glb", &error);
    assert_non_null(mesh);
    assert_int_equal(mesh->triangle_count, 4);
    kiln_mesh_destroy(&mesh);
    for (int i = 1; i < 8; i++) {
        char reason[128];
        const long left = size * i / 8;
        snprintf(reason, sizeof reason,
                 "the file is cut short: it has %ld bytes, and its header says %ld", left, size);
        refuse(glb, (size_t)left, "cut.glb", reason);
    }
    free(glb);
}

static bool at_once(void *user)
{
    ++*(int *)user;
    return true;
}

/* The importer is not waited for when nobody wants the mesh any more. */
static void importing_can_be_stopped(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    int asked = 0;
    size_t triangles = KILN_MAX_MESH_TRIANGLES, length = strlen("f 1 2 3\n");
    char *text = malloc(triangles * length + 64);
    assert_non_null(text);
    char *end = stpcpy(text, "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for (size_t i = 0; i < triangles; i++)
        end = stpcpy(end, "f 1 2 3\n");
    test_write_file("slow.obj", text);
    free(text);
    const struct kiln_loader_params params = {.stop = at_once, .user = &asked};
    struct kiln_loader *loader = kiln_loader_create(&params);
    assert_non_null(loader);
    assert_null(kiln_mesh_load(loader, "slow.obj", &error));
    kiln_loader_destroy(&loader);
    expect_error(&error, KILN_INTERRUPTED, "stopped while reading the files of a scene");
    assert_int_equal(asked, 1);
    assert_true(waitpid(-1, NULL, WNOHANG) < 0); /* nobody is left */
}

static void large_files_are_refused(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    test_write_file("huge.obj", CUBE);
    assert_int_equal(truncate("huge.obj", KILN_MAX_MESH_BYTES + 1), 0);
    assert_null(kiln_mesh_load(NULL, "huge.obj", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "huge.obj: the mesh file has 67108865 bytes; allowed are at most 67108864");

    const char *face = "f 1 2 3\n";
    size_t faces = KILN_MAX_MESH_TRIANGLES + 1, length = strlen(face);
    const char *corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    char *text = malloc(strlen(corners) + faces * length + 1);
    assert_non_null(text);
    char *end = stpcpy(text, corners);
    for (size_t i = 0; i < faces; i++)
        end = stpcpy(end, face);
    refuse_text(text, "many.obj",
                "the mesh has 3 vertices and 1048577 faces; allowed are 1048576 vertices and "
                "1048576 triangles");
    free(text);
}

static void files_must_be_files(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    test_write_file("folder.obj/file", "");
    assert_null(kiln_mesh_load(NULL, "folder.obj", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "folder.obj: the path is not a file but a folder; allowed are OBJ, glTF, GLB, PLY "
                 "or STL files");
    assert_null(kiln_mesh_load(NULL, "missing.obj", &error));
    expect_error(&error, KILN_IO,
                 "missing.obj: the mesh cannot be opened: No such file or directory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_is_read),
        cmocka_unit_test(round_things_are_smooth),
        cmocka_unit_test(a_fan_of_many_triangles_takes_no_time),
        cmocka_unit_test_setup_teardown(buffers_below_are_read_and_hashed, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(buffers_elsewhere_are_refused, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test(mirrored_nodes_are_not_inside_out),
        cmocka_unit_test(numbers_need_no_zero_before_their_point),
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(other_formats_are_refused_with_a_command),
        cmocka_unit_test(cut_files_are_refused),
        cmocka_unit_test_setup_teardown(importing_can_be_stopped, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(large_files_are_refused, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(files_must_be_files, test_enter_folder, test_leave_folder),
    };
    return cmocka_run_group_tests_name("mesh", tests, NULL, NULL);
}
