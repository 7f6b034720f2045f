/* If this fails, kiln reads glTF files beyond its limits, refuses files within them, or gives a
 * mesh other normals with an animation than without. tests/gltf has what other readers are asked.
 */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/skin.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"

enum { TEXT_SIZE = 1 << 20 };

/* A text that grows. */
struct text {
    char *bytes;
    size_t length;
};

static void add(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void add(struct text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int more =
        vsnprintf(text->bytes + text->length, TEXT_SIZE - text->length, format, arguments);
    va_end(arguments);
    assert_true(more >= 0 && (size_t)more < TEXT_SIZE - text->length);
    text->length += (size_t)more;
}

/* Begins a file with a tetrahedron without normals as mesh 0, whose four positions are accessor 0.
 * Accessor 2 has the times 0 s and 1 s, accessor 3 moves by 1 along x, and accessor 4 has zeros. */
static struct text begin(void)
{
    struct text text = {.bytes = malloc(TEXT_SIZE)};
    assert_non_null(text.bytes);
    add(&text, "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}],"
               "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"JOINTS_0\": 5, "
               "\"WEIGHTS_0\": 6}, \"indices\": 1}]}],"
               "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, "
               "\"type\": \"VEC3\"},"
               "{\"bufferView\": 1, \"componentType\": 5121, \"count\": 12, \"type\": \"SCALAR\"},"
               "{\"bufferView\": 2, \"componentType\": 5121, \"count\": 2, \"type\": \"SCALAR\"},"
               "{\"bufferView\": 3, \"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"},"
               "{\"componentType\": 5126, \"count\": 2500, \"type\": \"VEC3\"},"
               "{\"componentType\": 5121, \"count\": 4, \"type\": \"VEC4\"},"
               "{\"componentType\": 5126, \"count\": 4, \"type\": \"VEC4\"},"
               "{\"componentType\": 5126, \"count\": 1048576, \"type\": \"VEC3\"}],"
               "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}, {\"buffer\": 0, "
               "\"byteOffset\": 48, "
               "\"byteLength\": 12}, {\"buffer\": 0, \"byteOffset\": 60, \"byteLength\": 2}, "
               "{\"buffer\": 0, "
               "\"byteOffset\": 64, \"byteLength\": 24}],"
               "\"buffers\": [{\"byteLength\": 88, \"uri\": \"data:;base64,"
               "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
               "AAIBAAEDAAMCAQIDAAEAAAAAAAAA"
               "AAAAAAAAAAAAgD8AAAAAAAAAAA==\"}]");
    return text;
}

#define MOVES(node)                                                                                \
    ", \"animations\": [{\"channels\": [{\"sampler\": 0, \"target\": {\"node\": " node             \
    ", \"path\": \"translation\"}}], \"samplers\": [{\"input\": 2, \"output\": 3}]}]"

/* Adds nodes 0 to count - 1, each of which is the child of the one before; the last has the mesh.
 */
static void add_chain(struct text *text, int count)
{
    add(text, ", \"nodes\": [");
    for (int i = 0; i + 1 < count; i++)
        add(text, "{\"children\": [%d], \"translation\": [0, 0.25, 0]},", i + 1);
    add(text, "{\"mesh\": 0}]");
}

static struct kiln_skin *parse(struct text *text, struct kiln_error *error)
{
    add(text, "}");
    struct kiln_skin *skin = kiln_skin_parse(text->bytes, text->length, "t.gltf", error);
    free(text->bytes);
    return skin;
}

/* Each node of a file may move a mesh of its own. */
static void all_nodes_may_have_meshes(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct text text = begin();
    add(&text, ", \"nodes\": [{\"children\": [1");
    for (int i = 2; i < 4096; i++)
        add(&text, ", %d", i);
    add(&text, "]}");
    for (int i = 1; i < 4096; i++)
        add(&text, ", {\"mesh\": 0}");
    add(&text, "]" MOVES("7"));
    struct kiln_skin *skin = parse(&text, &error);
    if (!skin)
        fail_msg("%s", error.message);
    assert_int_equal(kiln_skin_mesh(skin)->triangle_count, 4095 * 4);
    kiln_skin_destroy(&skin);
}

/* A chain of nodes is as long as the limit says: the mesh lies at its end. */
static void nodes_have_a_limit(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    float vertices[12][6];
    struct text text = begin();
    add_chain(&text, 4096);
    add(&text, MOVES("0"));
    struct kiln_skin *skin = parse(&text, &error);
    if (!skin)
        fail_msg("%s", error.message);
    assert_int_equal(kiln_skin_mesh(skin)->vertex_count, 12);
    kiln_skin_pose(skin, 0, 1.0f, vertices);
    for (int i = 0; i < 12; i++)
        assert_true(fabsf(vertices[i][1] - 4094 * 0.25f) <= 1.0f && vertices[i][0] >= 1.0f);
    kiln_skin_destroy(&skin);
    text = begin();
    add_chain(&text, 4097);
    add(&text, MOVES("0"));
    assert_null(parse(&text, &error));
    expect_error(&error, KILN_INVALID_INPUT, "t.gltf: more than 4096 nodes; no more are allowed");
}

static void add_joints(struct text *text, int count)
{
    add(text, ", \"nodes\": [{\"mesh\": 0, \"skin\": 0, \"children\": [1]}, {\"children\": [");
    for (int i = 2; i < count + 1; i++)
        add(text, "%s%d", i > 2 ? ", " : "", i);
    add(text, "]}");
    for (int i = 2; i < count + 1; i++)
        add(text, ", {}");
    add(text, "], \"skins\": [{\"joints\": [");
    for (int i = 1; i < count + 1; i++)
        add(text, "%s%d", i > 1 ? ", " : "", i);
    add(text, "]}]" MOVES("1"));
}

static void bones_have_a_limit(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct text text = begin();
    add_joints(&text, 1024);
    struct kiln_skin *skin = parse(&text, &error);
    if (!skin)
        fail_msg("%s", error.message);
    kiln_skin_destroy(&skin);
    text = begin();
    add_joints(&text, 1025);
    assert_null(parse(&text, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "t.gltf: skin 0 has 1025 joints; allowed are 1 to 1024");
}

static struct kiln_mesh *parse_instances(int accessor, struct kiln_error *error)
{
    struct text text = begin();
    add(&text,
        ", \"nodes\": [{\"mesh\": 0, \"extensions\": {\"EXT_mesh_gpu_instancing\": "
        "{\"attributes\": "
        "{\"TRANSLATION\": %d}}}}]}",
        accessor);
    struct kiln_mesh *mesh = kiln_mesh_parse(text.bytes, text.length, "t.gltf", error);
    free(text.bytes);
    return mesh;
}

static void instances_have_a_limit(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = parse_instances(4, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    assert_int_equal(mesh->triangle_count, 4 * 2500);
    kiln_mesh_destroy(&mesh);
    assert_null(parse_instances(7, &error));
    expect_error(
        &error, KILN_INVALID_INPUT,
        "t.gltf: the mesh is too large; allowed are 1048576 vertices and 1048576 triangles");
}

/* A tetrahedron is all creases: each corner has the normal of its triangle, turned and mirrored by
 * its node, whether an animation moves it or not. */
static void creases_are_those_of_a_still_mesh(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct text text = begin();
    add(&text, ", \"nodes\": [{\"mesh\": 0, \"scale\": [-1, 2, 0.5], \"rotation\": [0.5, 0.5, 0.5, "
               "0.5]}]");
    add(&text, MOVES("0") "}");
    struct kiln_mesh *mesh = kiln_mesh_parse(text.bytes, text.length, "t.gltf", &error);
    struct kiln_skin *skin = kiln_skin_parse(text.bytes, text.length, "t.gltf", &error);
    free(text.bytes);
    if (!mesh || !skin)
        fail_msg("%s", error.message);
    const struct kiln_mesh *moving = kiln_skin_mesh(skin);
    assert_int_equal(mesh->vertex_count, 12);
    assert_int_equal(moving->vertex_count, 12);
    for (uint32_t i = 0; i < 4; i++) {
        for (int c = 0; c < 3; c++) {
            const float *a = mesh->vertices[mesh->triangles[i][c]];
            const float *b = moving->vertices[moving->triangles[i][c]];
            for (int k = 0; k < 6; k++)
                assert_true(fabsf(a[k] - b[k]) < 1e-6f);
        }
    }
    kiln_mesh_destroy(&mesh);
    kiln_skin_destroy(&skin);
}

static void keep_line(void *user, enum kiln_log_level level, const char *line)
{
    assert_int_equal(level, KILN_LOG_WARNING);
    snprintf(user, KILN_MESSAGE_SIZE, "%s", line);
}

/* What was changed of a file is a warning with its place in the scene. */
static void changes_are_warnings(void **state)
{
    (void)state;
    static const char scene_text[] =
        "kiln: 1\nbackdrop:\n  objects:\n  - mesh: {file: weights-that-do-not-fit.gltf}\n";
    char line[KILN_MESSAGE_SIZE] = "";
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = KILN_SOURCE_DIR "/tests/gltf/set";
    params.log = (struct kiln_log){keep_line, line};
    struct kiln_scene *scene =
        kiln_scene_parse(scene_text, sizeof scene_text - 1, "s", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    assert_string_equal(line, "s:4:18: backdrop.objects.0.mesh.file: "
                              "'weights-that-do-not-fit.gltf': the weights of some vertices do not "
                              "sum to 1, and are scaled so that they do");
    kiln_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_have_a_limit),
        cmocka_unit_test(all_nodes_may_have_meshes),
        cmocka_unit_test(bones_have_a_limit),
        cmocka_unit_test(instances_have_a_limit),
        cmocka_unit_test(creases_are_those_of_a_still_mesh),
        cmocka_unit_test(changes_are_warnings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
