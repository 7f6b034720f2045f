/* lib/asset/skin: meshes that follow bones, and what is refused. A chain of bones a metre long each
 * stands along y, in a file of our own; what is expected is computed in double. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/closed.h"
#include "asset/geometry/skin.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/rig.h"

#define EIGHT(text) text text text text text text text text

/* ---- the reference --------------------------------------------------------------------------- */

static void slerp(const float a[4], const float b[4], double t, double out[4])
{
    double cosine = 0.0, length = 0.0;
    for (int c = 0; c < 4; c++)
        cosine += (double)a[c] * (double)b[c];
    const double sign = cosine < 0.0 ? -1.0 : 1.0;
    const double angle = acos(fmin(sign * cosine, 1.0));
    for (int c = 0; c < 4; c++) {
        out[c] =
            angle < 1e-9
                ? (double)a[c]
                : (sin((1.0 - t) * angle) * (double)a[c] + sign * sin(t * angle) * (double)b[c]) /
                      sin(angle);
        length += out[c] * out[c];
    }
    for (int c = 0; c < 4; c++)
        out[c] /= sqrt(length);
}

static void turn(const double q[4], const double v[3], double out[3])
{
    double t[3];
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        t[c] = 2.0 * (q[d] * v[e] - q[e] * v[d]);
    }
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        out[c] = v[c] + q[3] * t[c] + q[d] * t[e] - q[e] * t[d];
    }
}

/* Where a vertex would be if it followed one joint alone: out through the chain. */
static void follow(const struct rig *rig, int joint, int key, double t, const double at[3],
                   double out[3])
{
    memcpy(out, at, 3 * sizeof *out);
    out[1] -= joint;
    for (int j = joint; j >= 0; j--) {
        double q[4], turned[3];
        slerp(rig->turns[j][key], rig->turns[j][key + 1], t, q);
        turn(q, out, turned);
        for (int c = 0; c < 3; c++)
            out[c] = turned[c] + (j > 0 ? (c == 1 ? 1.0 : 0.0)
                                        : (1.0 - t) * (double)rig->moves[key][c] +
                                              t * (double)rig->moves[key + 1][c]);
    }
}

static void expect_pose(const struct rig *rig, const struct kiln_skin *skin, double seconds)
{
    float vertices[VERTICES][6];
    int key = 0;
    while (key < KEYS - 2 && (double)rig->times[key + 1] <= seconds)
        key++;
    const double t = (seconds - (double)rig->times[key]) /
                     ((double)rig->times[key + 1] - (double)rig->times[key]);
    kiln_skin_pose(skin, 0, (float)seconds, vertices);
    for (int i = 0; i < VERTICES; i++) {
        const float *p = rig->positions[i];
        const double at[3] = {(double)p[0], (double)p[1], (double)p[2]};
        double sum[3] = {0};
        for (int j = 0; j < JOINTS; j++) {
            double there[3];
            follow(rig, rig->joints[i][j], key, t, at, there);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)rig->weights[i][j] * there[c];
        }
        for (int c = 0; c < 3; c++) {
            if (!(fabs((double)vertices[i][c] - sum[c]) < 4e-6))
                fail_msg("vertex %d at %g s: %.9g instead of %.9g", i, seconds,
                         (double)vertices[i][c], sum[c]);
        }
    }
}

static void poses_are_those_of_the_reference(void **state)
{
    (void)state;
    const struct rig rig = waving_rig();
    struct kiln_skin *skin = parse(&rig, &SOUND);
    assert_true(kiln_skin_clip_length(skin, 0) == 2.0f);
    for (int i = 0; i <= 64; i++)
        expect_pose(&rig, skin, i / 32.0);
    kiln_skin_destroy(&skin);
    assert_null(skin);
}

/* The upper bone of two swings through a right angle and back to where it was. */
static void two_bones_in_closed_form(void **state)
{
    (void)state;
    const double quarter = acos(0.0), axis[3] = {0.0, 0.0, 1.0};
    struct rig rig = still_rig();
    const float tip[3] = {0.0f, 2.0f, 0.0f}, elbow[3] = {0.0f, 1.5f, 0.0f};
    memcpy(rig.positions[0], tip, sizeof tip);
    memcpy(rig.positions[1], elbow, sizeof elbow);
    rig.joints[0][0] = 1;
    rig.joints[1][1] = 1;
    rig.weights[1][0] = rig.weights[1][1] = 0.5f;
    for (int k = 1; k < KEYS; k++)
        set_turn(rig.turns[1][k], axis, quarter);
    struct kiln_skin *skin = parse(&rig, &SOUND);
    for (int i = 0; i <= 40; i++) {
        float vertices[VERTICES][6];
        const double seconds = i / 40.0, angle = fmin(seconds / 0.5, 1.0) * quarter;
        kiln_skin_pose(skin, 0, (float)seconds, vertices);
        assert_true(fabs((double)vertices[0][0] + sin(angle)) < 1e-6);
        assert_true(fabs((double)vertices[0][1] - (1.0 + cos(angle))) < 1e-6);
        assert_true(fabs((double)vertices[1][0] + 0.25 * sin(angle)) < 1e-6);
        assert_true(fabs((double)vertices[1][1] - (1.25 + 0.25 * cos(angle))) < 1e-6);
        assert_true(memcmp(vertices[2], rig.positions[2], sizeof rig.positions[2]) == 0);
    }
    kiln_skin_destroy(&skin);
}

/* A triangle's own normal stays across it, and of length 1. */
static void normals_turn_along(void **state)
{
    (void)state;
    struct rig rig = waving_rig();
    for (int i = 0; i < VERTICES; i++) { /* triangles move as a whole */
        memset(rig.weights[i], 0, sizeof rig.weights[i]);
        rig.weights[i][i / 3 % JOINTS] = 1.0f;
    }
    struct kiln_skin *skin = parse(&rig, &SOUND);
    struct kiln_mesh *mesh = kiln_mesh_copy(kiln_skin_mesh(skin));
    assert_non_null(mesh);
    for (int i = 0; i < 20; i++) {
        kiln_skin_pose_mesh(skin, 0, (float)i * 0.1f, mesh);
        for (uint32_t t = 0; t < TRIANGLES; t++) {
            const float *a = mesh->vertices[mesh->triangles[t][0]];
            const float *b = mesh->vertices[mesh->triangles[t][1]];
            float along = 0.0f, square = 0.0f;
            for (int c = 0; c < 3; c++) {
                along += (b[c] - a[c]) * a[3 + c];
                square += a[3 + c] * a[3 + c];
                assert_true(mesh->min[c] <= a[c] && a[c] <= mesh->max[c]);
            }
            assert_true(fabsf(along) < 2e-6f && fabsf(square - 1.0f) < 1e-6f);
        }
    }
    kiln_mesh_destroy(&mesh);
    kiln_skin_destroy(&skin);
}

/* From the end of a clip whose last key is its first, it goes on; elsewhere it holds still. */
static void loops_join(void **state)
{
    (void)state;
    const struct rig rig = waving_rig();
    struct kiln_skin *skin = parse(&rig, &SOUND);
    float start[VERTICES][6], end[VERTICES][6];
    kiln_skin_pose(skin, 0, 0.0f, start);
    kiln_skin_pose(skin, 0, 2.0f, end);
    assert_memory_equal(start, end, sizeof start);
    kiln_skin_pose(skin, 0, -1.0f, end);
    assert_memory_equal(start, end, sizeof start);
    kiln_skin_pose(skin, 0, 1e6f, end);
    assert_memory_equal(start, end, sizeof start);
    kiln_skin_destroy(&skin);

    struct kiln_animation animation = {
        .start = {.constant = 0.5f}, .speed = {.constant = 2.0f}, .loop = true, .length = 2.0f};
    assert_true(kiln_scene_animation_s(&animation, 0.0f) == 0.5f);
    assert_true(kiln_scene_animation_s(&animation, 0.75f) == 0.0f);
    assert_true(kiln_scene_animation_s(&animation, 100.0f) == 0.5f);
    assert_true(kiln_scene_animation_s(&animation, -0.5f) == 1.5f);
    float end_s = 0.0f;
    assert_false(kiln_scene_animation_ends(&animation, 0.0f, 0.7f, &end_s));
    assert_true(kiln_scene_animation_ends(&animation, 0.7f, 0.75f, &end_s) && end_s == 2.0f);
    animation.speed.constant = -2.0f;
    assert_true(kiln_scene_animation_ends(&animation, 0.2f, 0.3f, &end_s) && end_s == 0.0f);
    animation.speed.constant = 2.0f;
    animation.loop = false;
    assert_false(kiln_scene_animation_ends(&animation, 0.7f, 0.75f, &end_s));
    assert_true(kiln_scene_animation_s(&animation, 0.75f) == 2.0f);
    assert_true(kiln_scene_animation_s(&animation, -0.5f) == 0.0f);
    animation.length = 0.0f;
    animation.loop = true;
    assert_true(kiln_scene_animation_s(&animation, 3.0f) == 0.0f);
}

/* The same on every machine: a sum over the bits of poses, of which one is as good as another. */
static void bits_are_known(void **state)
{
    (void)state;
    const struct rig rig = waving_rig();
    struct kiln_skin *skin = parse(&rig, &SOUND);
    uint32_t sum = 2166136261u;
    for (int i = 0; i < 50; i++) {
        float vertices[VERTICES][6];
        kiln_skin_pose(skin, 0, (float)i / 32.0f, vertices);
        const unsigned char *bytes = (const unsigned char *)vertices;
        for (size_t k = 0; k < sizeof vertices; k++)
            sum = (sum ^ bytes[k]) * 16777619u;
    }
    kiln_skin_destroy(&skin);
    assert_int_equal(sum, 0x9dde39cau);
}

/* Without bones, a mesh goes where its node does. */
static void parts_follow_their_nodes(void **state)
{
    (void)state;
    struct rig rig = still_rig();
    for (int k = 0; k < KEYS; k++)
        rig.moves[k][0] = 2.0f * rig.times[k];
    struct variant variant = SOUND;
    variant.skin = "";
    variant.attributes = "";
    variant.animations =
        "\"animations\": [{\"name\": \"go\", \"channels\": [{\"sampler\": 0, \"target\": "
        "{\"node\": 4, \"path\": \"translation\"}}], \"samplers\": [{\"input\": 3, \"output\": "
        "7, \"interpolation\": \"%s\"}]}],";
    struct kiln_skin *skin = parse(&rig, &variant);
    float vertices[VERTICES][6];
    kiln_skin_pose(skin, 0, 0.75f, vertices);
    for (int i = 0; i < VERTICES; i++) {
        assert_true(fabsf(vertices[i][0] - rig.positions[i][0] - 1.5f) < 1e-6f);
        assert_true(vertices[i][1] == rig.positions[i][1]);
    }
    kiln_skin_destroy(&skin);
}

/* Returns how far a vertex moves in the first second. */
static float way_of(const struct kiln_skin *skin, uint32_t vertex)
{
    float vertices[VERTICES][6];
    kiln_skin_pose(skin, 0, 1.0f, vertices);
    const float moved = vertices[vertex][0];
    kiln_skin_pose(skin, 0, 0.0f, vertices);
    return moved - vertices[vertex][0];
}

/* Weights that do not sum to 1 are scaled, a vertex without weights follows its first joint, and
 * the user is told. */
static void weights_are_scaled(void **state)
{
    (void)state;
    struct rig rig = still_rig();
    for (int k = 0; k < KEYS; k++)
        rig.moves[k][0] = rig.times[k];
    for (int c = 0; c < 4; c++)
        rig.weights[7][c] *= 3.0f;
    memset(rig.weights[3], 0, sizeof rig.weights[3]);
    struct kiln_skin *skin = parse(&rig, &SOUND);
    for (uint32_t i = 0; i < VERTICES; i++)
        assert_true(fabsf(way_of(skin, i) - 1.0f) < 1e-6f);
    assert_string_equal(kiln_skin_mesh(skin)->notes,
                        "the weights of some vertices do not sum to 1, and are scaled so that "
                        "they do");
    kiln_skin_destroy(&skin);
}

/* Nodes are known by their numbers, so that two may have one name. */
static void names_may_come_twice(void **state)
{
    (void)state;
    const struct rig rig = waving_rig();
    struct variant variant = SOUND;
    variant.second = "body";
    struct kiln_skin *skin = parse(&rig, &variant);
    expect_pose(&rig, skin, 0.75);
    kiln_skin_destroy(&skin);
}

/* Rotations that are no unit quaternions are scaled to length 1. */
static void turns_are_scaled(void **state)
{
    (void)state;
    const struct rig rig = waving_rig();
    struct rig longer = rig;
    for (int k = 0; k < KEYS; k++) {
        for (int c = 0; c < 4; c++)
            longer.turns[1][k][c] *= 5.0f;
    }
    struct kiln_skin *skin = parse(&longer, &SOUND);
    expect_pose(&rig, skin, 0.75);
    kiln_skin_destroy(&skin);
}

/* A node that mirrors turns what is left to the right, and nothing inside out. */
static void mirrored_parts_face_outwards(void **state)
{
    (void)state;
    const struct rig rig = still_rig();
    struct variant variant = SOUND;
    variant.attributes = "";
    variant.animations =
        "\"animations\": [{\"name\": \"go\", \"channels\": [{\"sampler\": 0, \"target\": "
        "{\"node\": 4, \"path\": \"translation\"}}], \"samplers\": [{\"input\": 3, \"output\": "
        "7, \"interpolation\": \"%s\"}]}],";
    variant.skin = "";
    struct kiln_skin *plain = parse(&rig, &variant);
    variant.skin = ", \"scale\": [-1, 1, 1]";
    struct kiln_skin *mirrored = parse(&rig, &variant);
    const struct kiln_mesh *from = kiln_skin_mesh(plain), *to = kiln_skin_mesh(mirrored);
    float posed[VERTICES][6];
    kiln_skin_pose(mirrored, 0, 0.75f, posed);
    for (int i = 0; i < VERTICES; i++) {
        for (int c = 0; c < 6; c++) {
            const float expected = c % 3 == 0 ? -from->vertices[i][c] : from->vertices[i][c];
            assert_true(fabsf(to->vertices[i][c] - expected) < 1e-6f);
            assert_true(c < 3 || fabsf(posed[i][c] - expected) < 1e-6f);
        }
    }
    for (int i = 0; i < TRIANGLES; i++) {
        assert_int_equal(to->triangles[i][0], from->triangles[i][0]);
        assert_int_equal(to->triangles[i][1], from->triangles[i][2]);
        assert_int_equal(to->triangles[i][2], from->triangles[i][1]);
    }
    kiln_skin_destroy(&plain);
    kiln_skin_destroy(&mirrored);
}

/* A clip that turns what its node mirrors half around does so: two axes are turned about. */
static void mirrored_parts_turn(void **state)
{
    (void)state;
    struct rig rig = still_rig();
    for (int k = 0; k < KEYS; k++) {
        memcpy(rig.turns[0][k], (float[4]){0.0f, 0.0f, 1.0f, 0.0f}, sizeof rig.turns[0][k]);
        memcpy(rig.moves[k], (float[3]){-1.0f, 1.0f, 1.0f}, sizeof rig.moves[k]);
    }
    struct variant variant = SOUND;
    variant.attributes = "";
    variant.skin = ", \"scale\": [-1, 1, 1]";
    for (int turned = 0; turned < 2; turned++) {
        /* accessors 10 and 11: the first keys alone */
        variant.animations =
            turned ? "\"animations\": [{\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 4, "
                     "\"path\": \"rotation\"}}, {\"sampler\": 1, \"target\": {\"node\": 4, "
                     "\"path\": \"scale\"}}], \"samplers\": [{\"input\": 10, \"output\": 11, "
                     "\"interpolation\": \"%s\"}, {\"input\": 3, \"output\": 7}]}],"
                   : "\"animations\": [{\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 4, "
                     "\"path\": \"scale\"}}], \"samplers\": [{\"input\": 3, \"output\": 7, "
                     "\"interpolation\": \"%s\"}]}],";
        struct kiln_skin *skin = parse(&rig, &variant);
        float posed[VERTICES][6];
        kiln_skin_pose(skin, 0, 0.75f, posed);
        for (int i = 0; i < VERTICES; i++) {
            const float *p = rig.positions[i];
            assert_true(fabsf(posed[i][0] - (turned ? p[0] : -p[0])) < 1e-5f);
            assert_true(fabsf(posed[i][1] - (turned ? -p[1] : p[1])) < 1e-5f);
            assert_true(fabsf(posed[i][2] - p[2]) < 1e-5f);
        }
        kiln_skin_destroy(&skin);
    }
}

/* What an exporter adds for itself may say a thing twice. */
static void keys_may_come_twice(void **state)
{
    (void)state;
    const struct rig rig = waving_rig();
    struct variant variant = SOUND;
    variant.skin = SKIN ", \"extras\": {\"by\": 1, \"by\": {\"by\": 2}, \"by\": []}";
    struct kiln_skin *skin = parse(&rig, &variant);
    expect_pose(&rig, skin, 0.75);
    kiln_skin_destroy(&skin);
    variant.skin = SKIN;
    variant.animations = WAVE "\"extras\": {\"by\": " EIGHT(EIGHT("[")) EIGHT(EIGHT("]")) "},";
    skin = parse(&rig, &variant);
    expect_pose(&rig, skin, 0.75);
    kiln_skin_destroy(&skin);
}

static void clips_are_found(void **state)
{
    (void)state;
    const struct rig rig = still_rig();
    struct variant variant = SOUND;
    variant.animations = "\"animations\": [{\"name\": \"wave\", " CHANNELS(
        "1") "}, {\"name\": \"0\", "
             "\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": \"rotation\"}}], "
             "\"samplers\": [{\"input\": 3, \"output\": 4}]}],";
    struct kiln_skin *skin = parse(&rig, &variant);
    struct kiln_error error = {0};
    uint32_t number = 9;
    assert_true(kiln_skin_find_clip(skin, "wave", "f", &number, &error) && number == 0);
    assert_true(kiln_skin_find_clip(skin, "1", "f", &number, &error) && number == 1);
    assert_true(kiln_skin_find_clip(skin, "0", "f", &number, &error) && number == 1);
    assert_false(kiln_skin_find_clip(skin, "2", "f", &number, &error));
    assert_false(kiln_skin_find_clip(skin, "walk", "f", &number, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "f: no animation is called 'walk'; the file has 'wave', '0', by number 0 to 1");
    kiln_skin_destroy(&skin);
}

static void put_word(char *at, size_t word)
{
    for (int i = 0; i < 4; i++)
        at[i] = (char)(word >> 8 * i & 255);
}

/* A GLB whose JSON has a length with a quotation mark among its bytes, and a zero after it. */
static size_t to_glb(const struct rig *rig, const struct variant *variant, char *glb, size_t size)
{
    const char *text = to_gltf(rig, variant);
    const size_t json = 0x2200, all = 28 + json + (sizeof *rig + 3) / 4 * 4;
    assert_true(strlen(text) < json && all <= size);
    memset(glb, ' ', all);
    memcpy(glb, "glTF", 4);
    put_word(glb + 4, 2);
    put_word(glb + 8, all);
    put_word(glb + 12, json);
    memcpy(glb + 16, "JSON", 4);
    memcpy(glb + 20, text, strlen(text));
    glb[20 + json - 1] = '\0';
    put_word(glb + 20 + json, all - 28 - json);
    memcpy(glb + 24 + json, "BIN", 4);
    memcpy(glb + 28 + json, rig, sizeof *rig);
    return all;
}

static void binary_files_are_asked_too(void **state)
{
    (void)state;
    static char glb[16384];
    const struct rig rig = waving_rig();
    struct variant variant = SOUND;
    struct kiln_error error = {0};
    size_t size = to_glb(&rig, &variant, glb, sizeof glb);
    struct kiln_skin *skin = kiln_skin_parse(glb, size, "rig.glb", &error);
    if (!skin)
        fail_msg("%s", error.message);
    kiln_skin_destroy(&skin);
    variant.interpolation = "ST\\u0045P";
    size = to_glb(&rig, &variant, glb, sizeof glb);
    skin = kiln_skin_parse(glb, size, "rig.glb", &error);
    assert_non_null(skin);
    kiln_skin_destroy(&skin);
    variant.interpolation = "ST\\u0045PS";
    size = to_glb(&rig, &variant, glb, sizeof glb);
    assert_null(kiln_skin_parse(glb, size, "rig.glb", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "rig.glb: a sampler's interpolation is 'STEPS'; allowed are LINEAR, STEP and "
                 "CUBICSPLINE");
}

static void what_is_unsound_is_refused(void **state)
{
    (void)state;
#define ALLOWED_KEYS                                                                               \
    "allowed are numbers within -1e+06 and 1e+06, and quaternions other than 0 for "               \
    "rotations"
    char text[256];
    struct rig rig = waving_rig();
    struct variant variant = SOUND;
    variant.interpolation = "CUBICSPLINE"; /* three values for each key */
    refuse(&rig, &variant, "accessor 6 has 4 elements; at least 12 are needed");
    variant = SOUND;
    variant.animations = "%.0s";
    refuse(&rig, &variant, "the file has no animation");
    rig = waving_rig();
    rig.times[2] = 0.25f;
    refuse(&rig, &SOUND,
           "a key lies at 0.25 s; allowed are times from 0 s to 1e+06 s, each later than the time "
           "of the key before it");
    rig = waving_rig();
    rig.moves[1][0] = INFINITY;
    snprintf(text, sizeof text, "the key at 0.5 s has the value inf %g %g 0; " ALLOWED_KEYS,
             (double)rig.moves[1][1], (double)rig.moves[1][2]);
    refuse(&rig, &SOUND, text);
    rig = waving_rig();
    memset(rig.turns[2][1], 0, sizeof rig.turns[2][1]);
    refuse(&rig, &SOUND, "the key at 0.5 s has the value 0 0 0 0; " ALLOWED_KEYS);
    rig = waving_rig();
    rig.inverse[1][3] = 0.5f;
    refuse(&rig, &SOUND, "a matrix has the last row 0.5 0 0 1; allowed is 0 0 0 1");

    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    struct kiln_error error = {0};
    assert_null(kiln_skin_parse(obj, sizeof obj - 1, "flat.obj", &error));
    expect_error(&error, KILN_INVALID_INPUT, "flat.obj: the file has no animation");
}

/* ---- scenes ---------------------------------------------------------------------------------- */

static void expect_scene_error(const char *mesh, const char *message)
{
    char text[512];
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = KILN_SOURCE_DIR "/tests/mutation";
    snprintf(text, sizeof text, "kiln: 1\nbackdrop:\n  objects:\n  - mesh: {%s}\n", mesh);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "s", &params, &error);
    assert_null(scene);
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
}

static void scenes_say_what_is_wrong(void **state)
{
    (void)state;
    expect_scene_error(
        "file: moving.gltf, animation: {clip: run}",
        "s:4:49: backdrop.objects.0.mesh.animation.clip: 'moving.gltf': no animation is "
        "called 'run'; the file has 'turn', 'go', by number 0 to 1");
    expect_scene_error("file: tetrahedron.obj, animation: {}",
                       "s:4:18: backdrop.objects.0.mesh.file: 'tetrahedron.obj': the file has no "
                       "animation");
    expect_scene_error(
        "file: moving.gltf, animation: {}, collide: true",
        "s:4:55: backdrop.objects.0.mesh.collide: a mesh with an animation needs the "
        "collider volume");
    expect_scene_error(
        "file: moving.gltf, animation: {clip: []}",
        "s:4:49: backdrop.objects.0.mesh.animation.clip: expected the name of an animation "
        "in the file, or its number from 0, found a list");
}

/* The figure of tools/walker: what touches the ground stays, for one who goes at its speed. */
static void feet_that_stand_do_not_slide(void **state)
{
    (void)state;
    const float speed = 1.1f, dt = 0.01f;
    struct kiln_error error = {0};
    struct kiln_skin *skin =
        kiln_skin_load(NULL, KILN_SOURCE_DIR "/scenes/meshes/walker.gltf", &error);
    if (!skin)
        fail_msg("%s", error.message);
    struct kiln_mesh *now = kiln_mesh_copy(kiln_skin_mesh(skin)),
                     *then = kiln_mesh_copy(kiln_skin_mesh(skin));
    assert_non_null(now);
    assert_non_null(then);
    assert_true(kiln_mesh_check_closed(now, "walker", &error));
    const float length = kiln_skin_clip_length(skin, 0);
    for (float seconds = 0.0f; seconds + dt < length; seconds += 0.05f) {
        uint32_t standing = 0;
        double slip = 0.0;
        kiln_skin_pose_mesh(skin, 0, seconds, now);
        kiln_skin_pose_mesh(skin, 0, seconds + dt, then);
        if (!(now->min[1] > -0.003f && now->min[1] < 0.012f && now->max[1] < 1.78f))
            fail_msg("at %g s, it reaches from %g to %g m", (double)seconds, (double)now->min[1],
                     (double)now->max[1]);
        for (uint32_t i = 0; i < now->vertex_count; i++) {
            const float *a = now->vertices[i], *b = then->vertices[i];
            if (a[1] > now->min[1] + 0.004f)
                continue;
            standing++;
            slip += fabs((double)(b[2] - a[2]) / (double)dt + (double)speed);
        }
        if (standing == 0 || slip / standing > 0.08)
            fail_msg("at %g s, %u vertices on the ground at %g m slide by %g m/s", (double)seconds,
                     standing, (double)now->min[1], slip / standing);
    }
    kiln_mesh_destroy(&now);
    kiln_mesh_destroy(&then);
    kiln_skin_destroy(&skin);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_are_those_of_the_reference),
        cmocka_unit_test(two_bones_in_closed_form),
        cmocka_unit_test(normals_turn_along),
        cmocka_unit_test(loops_join),
        cmocka_unit_test(bits_are_known),
        cmocka_unit_test(parts_follow_their_nodes),
        cmocka_unit_test(weights_are_scaled),
        cmocka_unit_test(names_may_come_twice),
        cmocka_unit_test(turns_are_scaled),
        cmocka_unit_test(mirrored_parts_face_outwards),
        cmocka_unit_test(mirrored_parts_turn),
        cmocka_unit_test(keys_may_come_twice),
        cmocka_unit_test(clips_are_found),
        cmocka_unit_test(binary_files_are_asked_too),
        cmocka_unit_test(what_is_unsound_is_refused),
        cmocka_unit_test(scenes_say_what_is_wrong),
        cmocka_unit_test(feet_that_stand_do_not_slide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
