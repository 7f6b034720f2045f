/* Nodes of glTF files (lib/asset/geometry/rig.h) and nodes of scenes that follow them: rates
 * against differences, joints against vertices that are bound to them alone, cameras against
 * three.js, and what is refused. If this fails, what is attached to a file's node is elsewhere, or
 * a hostile file gets through. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/geometry/rig.h"
#include "base/text.h"
#include "scene/motion.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/rig.h"
#include "support/scenes.h"

#define NODES KILN_SOURCE_DIR "/tests/gltf/nodes"

/* ---- scenes whose files lie in a folder ------------------------------------------------------ */

static char folder[] = "/tmp/kiln-rig-XXXXXX";

static void write_file(const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_true(file && fputs(text, file) >= 0);
    fclose(file);
}

/* Loads a scene whose files lie in a folder; NULL with an error. */
static struct kiln_scene *try_in(const char *root, const char *text, struct kiln_error *error)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = root;
    return kiln_scene_parse(text, strlen(text), SCENE_NAME, &params, error);
}

static struct kiln_scene *load_in(const char *root, const char *text)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = try_in(root, text, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static double distance(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static void turned(const struct kiln_node_frame *frame, const double v[3], double y[3])
{
    const double *q = frame->turn;
    const double t[3] = {2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]),
                         2 * (q[0] * v[1] - q[1] * v[0])};
    y[0] = v[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1];
    y[1] = v[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2];
    y[2] = v[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0];
}

/* ---- rates ----------------------------------------------------------------------------------- */

/* Compares the rates of a node in the middle between keys with differences of its frames. */
static void expect_rates(const char *text)
{
    struct kiln_scene *scene = load_in(NODES, text);
    const double h = 1.0 / 2048;
    for (int i = 0; i < 160; i++) {
        const double time_s = 0.26 + i / 66.7;
        if (fabs(remainder(time_s - 0.25, 0.25)) < 2 * h)
            continue; /* a key */
        struct kiln_node_frame f[3];
        for (int k = 0; k < 3; k++) {
            const float at_s = (float)(time_s + (k - 1) * h);
            f[k] = kiln_node_frame_at(scene, 1, at_s, at_s);
        }
        const double step = 2 * h;
        double rate[3], x[3], before[3], after[3], speed = 0;
        for (int c = 0; c < 3; c++) {
            rate[c] = (f[2].at[c] - f[0].at[c]) / step;
            speed += fabs(rate[c]);
        }
        if (!(distance(f[1].velocity, rate) < 2e-3 * (1 + speed)))
            fail_msg("at %g s: [%g, %g, %g], not [%g, %g, %g] m/s", time_s, f[1].velocity[0],
                     f[1].velocity[1], f[1].velocity[2], rate[0], rate[1], rate[2]);
        for (int axis = 0; axis < 3; axis++) {
            const double v[3] = {axis == 0, axis == 1, axis == 2};
            turned(&f[1], v, x);
            turned(&f[0], v, before);
            turned(&f[2], v, after);
            const double *w = f[1].spin;
            const double spun[3] = {w[1] * x[2] - w[2] * x[1], w[2] * x[0] - w[0] * x[2],
                                    w[0] * x[1] - w[1] * x[0]};
            for (int c = 0; c < 3; c++)
                rate[c] = (after[c] - before[c]) / step;
            if (!(distance(spun, rate) < 5e-3 * (1 + fabs(w[0]) + fabs(w[1]) + fabs(w[2]))))
                fail_msg("at %g s: the spin moves an axis by [%g, %g, %g], not [%g, %g, %g]",
                         time_s, spun[0], spun[1], spun[2], rate[0], rate[1], rate[2]);
        }
        assert_true(fabs(f[1].growth - (f[2].scale - f[0].scale) / step) < 5e-3);
    }
    kiln_scene_destroy(&scene);
}

#define SCENE "kiln: 1\noutput: {frames: 300, fps: 60}\n"

static void rates_are_those_of_the_frames(void **state)
{
    (void)state;
    static const char *const files[] = {"nodes-growing", "nodes-cubicspline", "nodes-linear",
                                        "nodes-step", "nodes-uneven"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 SCENE
                 "nodes:\n"
                 "  a: {rotation: {keys: {0 s: [0, 0, 0], 4 s: [40 deg, 300 deg, 0]}}}\n"
                 "  b: {parent: a, file: %s.gltf, node: %s, scale: 0.5, position: [1, 2, 0]}\n",
                 files[i], strcmp(files[i], "nodes-uneven") == 0 ? "Tip" : "Camera");
        expect_rates(text);
    }
    expect_rates(SCENE "nodes:\n"
                       "  a: {}\n"
                       "  b: {parent: a, file: nodes-growing.gltf, node: 3, animation: {clip: Take "
                       "1, speed: -1, start: 9 s}}\n");
}

static double speed_of(const struct kiln_scene *scene, float time_s, float rate_s)
{
    const double none[3] = {0, 0, 0};
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, 0, time_s, rate_s);
    return distance(frame.velocity, none);
}

/* A clip that moves 5 m in its 3 s by one straight line, and then stays or starts again. */
static void a_clip_ends_or_starts_again(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load_in(NODES, SCENE "nodes: {a: {file: nodes-linear.gltf, node: Camera, animation: {clip: "
                             "Take 2, loop: false, speed: 2, start: 1 s}}}\n");
    const double fast = speed_of(scene, 0.5f, 0.5f);
    assert_true(fast > 2 && fabs(speed_of(scene, -0.5f, -0.5f) - fast) < 1e-6);
    assert_true(speed_of(scene, -0.6f, -0.6f) == 0); /* before the clip */
    assert_true(speed_of(scene, 1.0f, 1.0f) == 0);
    assert_true(fabs(speed_of(scene, 1.0f, 0.999f) - fast) < 1e-6); /* as it comes to its end */
    assert_true(speed_of(scene, 7.0f, 7.0f) == 0);
    kiln_scene_destroy(&scene);
    scene = load_in(NODES, SCENE "nodes: {a: {file: nodes-linear.gltf, node: Camera, animation: "
                                 "{clip: 1, speed: -1}}}\n");
    const struct kiln_node_frame a = kiln_node_frame_at(scene, 0, 1.0f, 1.0f);
    const struct kiln_node_frame b = kiln_node_frame_at(scene, 0, 4.0f, 4.0f);
    assert_true(distance(a.at, b.at) < 1e-6 && fabs(speed_of(scene, 7.0f, 7.0f) - fast / 2) < 1e-6);
    kiln_scene_destroy(&scene);
}

/* ---- cameras --------------------------------------------------------------------------------- */

static void a_camera_of_a_file_is_that_of_three_js(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load_in(NODES, SCENE "nodes: {shot: {file: nodes-cubicspline.gltf, node: Camera}}\n"
                             "camera: {attach: shot}\n");
    assert_true(fabs((double)scene->camera.fov.constant - 0.7) < 1e-7);
    FILE *file = fopen(NODES "/expect.txt", "r");
    char line[1024];
    int count = 0;
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        char *rest = line;
        const char *name = strsep(&rest, " ");
        double n[13] = {0};
        for (int i = 0; i < 13 && rest; i++)
            n[i] = strtod(rest, &rest);
        /* the last moment of a clip is the first of its next round */
        if (strcmp(name, "nodes-cubicspline.gltf") != 0 || n[0] != 0 || n[2] != 3 || n[1] > 2.7)
            continue;
        const struct kiln_camera_stand stand = kiln_scene_camera_at(scene, (float)n[1]);
        const double eye[3] = {(double)stand.eye.x, (double)stand.eye.y, (double)stand.eye.z};
        const double way[3] = {-(double)stand.way.x, -(double)stand.way.y, -(double)stand.way.z};
        const double up[3] = {(double)stand.up.x, (double)stand.up.y, (double)stand.up.z};
        const double z[3] = {n[6] * n[12], n[7] * n[12], n[8] * n[12]};
        if (!(distance(eye, n + 3) < 1e-5 * (1 + fabs(n[3]) + fabs(n[4]) + fabs(n[5]))))
            fail_msg("at %g s, the eye is at [%.9g, %.9g, %.9g], not [%.9g, %.9g, %.9g]", n[1],
                     eye[0], eye[1], eye[2], n[3], n[4], n[5]);
        assert_true(distance(way, z) < 2e-5 && distance(up, n + 9) < 1e-5);
        count++;
    }
    assert_int_equal(count, 7);
    fclose(file);
    kiln_scene_destroy(&scene);
}

static void the_scene_may_give_a_field_of_view(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load_in(NODES, SCENE "nodes: {shot: {file: nodes-linear.gltf, node: Flat}, in: {parent: "
                             "shot}}\n"
                             "camera: {attach: shot, fov: 30 deg, position: [0, 1, 0]}\n");
    assert_true(fabs((double)scene->camera.fov.constant - acos(-1) / 6) < 1e-6);
    assert_true(scene->camera.target.z.constant == -1 && scene->camera.target.y.constant == 1);
    char *printed = print_scene(scene);
    struct kiln_scene *again = load_in(NODES, printed);
    assert_string_equal(scene->hash, again->hash);
    free(printed);
    kiln_scene_destroy(&again);
    kiln_scene_destroy(&scene);
    /* a node within that of the file is one of the scene's own */
    scene = load_in(NODES, SCENE "nodes: {shot: {file: nodes-linear.gltf, node: Camera}, in: "
                                 "{parent: shot}}\n"
                                 "camera: {attach: in}\n");
    assert_true(scene->camera.target.z.constant == 1);
    kiln_scene_destroy(&scene);
}

/* ---- joints ---------------------------------------------------------------------------------- */

static const char *const joints[JOINTS] = {"hips", "chest", "head"};

/* The rig of support/rig.h, each of whose triangles follows one joint alone. */
static struct rig bound_rig(void)
{
    struct rig rig = waving_rig();
    for (int i = 0; i < VERTICES; i++) {
        memset(rig.weights[i], 0, sizeof rig.weights[i]);
        rig.weights[i][0] = 1;
        rig.joints[i][0] = (uint8_t)(i % JOINTS);
    }
    return rig;
}

static void a_joint_moves_as_a_vertex_of_it(void **state)
{
    (void)state;
    const struct rig rig = bound_rig();
    write_file("walker.gltf", to_gltf(&rig, &SOUND));
    struct kiln_scene *scene = load_in(
        folder, SCENE
        "nodes:\n"
        "  way: {position: {keys: {0 s: [0, 0, 0], 4 s: [3, 1, 2]}}, rotation: [0, 20 deg, 0]}\n"
        "  joint0: {mesh: walker, joint: hips}\n"
        "  joint1: {mesh: walker, joint: chest}\n"
        "  joint2: {mesh: walker, joint: 2}\n"
        "  lamp: {parent: joint2, position: [0, 0.5, 0]}\n"
        "backdrop:\n"
        "  objects:\n"
        "    walker: {mesh: {file: walker.gltf, attach: way, position: [1, 2, 3],\n"
        "      rotation: {keys: {0 s: [0, 0, 0], 4 s: [90 deg, 30 deg, 200 deg]}}, scale: 0.7,\n"
        "      animation: {clip: wave, speed: 0.9, start: 0.2 s}}}\n");
    const struct kiln_object *walker = &scene->backdrop.objects[0];
    for (int i = 0; i < 60; i++) {
        const float time_s = (float)i * 0.05f;
        float vertices[VERTICES][6], columns[3][3];
        kiln_skin_pose(walker->skin, 0, kiln_scene_animation_s(&walker->animation, time_s),
                       vertices);
        const float3 center = kiln_object_center(scene, walker, time_s);
        kiln_object_rotation(scene, walker, time_s, columns);
        for (int k = 0; k < VERTICES; k++) {
            const uint32_t joint = rig.joints[k][0];
            double drawn[3], found[3];
            const double at_rest[3] = {(double)rig.positions[k][0],
                                       (double)rig.positions[k][1] - joint,
                                       (double)rig.positions[k][2]};
            const struct kiln_node_frame frame =
                kiln_node_frame_at(scene, 1 + joint, time_s, time_s);
            const float base[3] = {center.x, center.y, center.z};
            turned(&frame, at_rest, found);
            for (int c = 0; c < 3; c++) {
                drawn[c] = (double)base[c];
                for (int m = 0; m < 3; m++)
                    drawn[c] += 0.7 * (double)columns[m][c] * (double)vertices[k][m];
                found[c] = frame.at[c] + frame.scale * found[c];
            }
            if (!(distance(drawn, found) < 2e-5))
                fail_msg("%s at %g s: a vertex is at [%g, %g, %g], its joint says [%g, %g, %g]",
                         joints[joint], (double)time_s, drawn[0], drawn[1], drawn[2], found[0],
                         found[1], found[2]);
        }
    }
    assert_true(kiln_node_carries(scene, 0, 4) && !kiln_node_stands(scene, 1));
    char *printed = print_scene(scene);
    struct kiln_scene *again = load_in(folder, printed);
    assert_string_equal(scene->hash, again->hash);
    free(printed);
    kiln_scene_destroy(&again);
    kiln_scene_destroy(&scene);
}

/* ---- hashes ---------------------------------------------------------------------------------- */

static void hash_of(const char *text, enum kiln_scene_part part, char hex[65])
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = load_in(folder, text);
    assert_true(kiln_scene_part_hash(scene, part, hex, &error));
    kiln_scene_destroy(&scene);
}

/* A changed file is another motion where an emitter is attached to its node, another view where the
 * camera is, and otherwise neither. */
static void files_belong_to_what_they_move(void **state)
{
    (void)state;
    static const char *const uses[] = {"camera: {}\n", "camera: {attach: n}\n",
                                       "systems: {s: {emit: {attach: n, rate: 1}}}\n"};
    for (int use = 0; use < 3; use++) {
        char hashes[2][2][65], text[512];
        snprintf(text, sizeof text, SCENE "nodes: {n: {file: n.gltf, node: chest}}\n%s", uses[use]);
        for (int i = 0; i < 2; i++) {
            struct rig rig = waving_rig();
            rig.moves[1][0] += (float)i;
            write_file("n.gltf", to_gltf(&rig, &SOUND));
            hash_of(text, KILN_PART_MOTION, hashes[i][0]);
            hash_of(text, KILN_PART_VIEW, hashes[i][1]);
        }
        assert_int_equal(strcmp(hashes[0][0], hashes[1][0]) != 0, use == 2);
        assert_int_equal(strcmp(hashes[0][1], hashes[1][1]) != 0, use >= 1);
    }
}

/* ---- what is refused ------------------------------------------------------------------------- */

static void expect_refused(const char *text, const char *message)
{
    struct kiln_error error = {0};
    char whole[512], expected[1024];
    snprintf(whole, sizeof whole, SCENE "%s", text);
    struct kiln_scene *scene = try_in(NODES, whole, &error);
    if (scene)
        fail_msg("loaded:\n%s", whole);
    snprintf(expected, sizeof expected, SCENE_NAME "%s", message);
    expect_error(&error, KILN_INVALID_INPUT, "%s", expected);
}

static void bad_nodes(void **state)
{
    (void)state;
    expect_refused("nodes: {a: {file: nodes-linear.gltf}}\n",
                   ":3:19: nodes.a.file: needs `node`, which says which node of the file");
    expect_refused("nodes: {a: {node: Camera}}\n",
                   ":3:19: nodes.a.node: needs `file`, whose node it is");
    expect_refused("nodes: {a: {animation: {clip: go}}}\n",
                   ":3:24: nodes.a.animation: needs `file`, whose animation it is");
    expect_refused("nodes: {a: {mesh: b, joint: hips, animation: {clip: go}}}\n",
                   ":3:46: nodes.a.animation: must be left out, since the joint follows the "
                   "animation of its mesh, which stands in backdrop.objects");
    expect_refused("nodes: {a: {file: nodes-linear.gltf, node: Camra}}\n",
                   ":3:44: nodes.a.node: 'nodes-linear.gltf': no node is called 'Camra' or has "
                   "this number; the file has 'Stage', 'Dolly', 'Crane', 'Camera', 'Flat', by "
                   "number 0 to 4");
    expect_refused("nodes: {a: {file: nodes-linear.gltf, node: 9}}\n",
                   ":3:44: nodes.a.node: 'nodes-linear.gltf': no node is called '9' or has this "
                   "number; the file has 'Stage', 'Dolly', 'Crane', 'Camera', 'Flat', by number 0 "
                   "to 4");
    expect_refused("nodes: {a: {file: nodes-linear.gltf, node: 3, animation: {clip: run}}}\n",
                   ":3:65: nodes.a.animation.clip: 'nodes-linear.gltf': no animation is called "
                   "'run'; the file has 'Take 1', 'Take 2', by number 0 to 1");
    expect_refused(
        "nodes: {a: {file: absent.glb, node: 3}}\n",
        ":3:19: nodes.a.file: cannot open 'absent.glb': No such file or directory; a path "
        "starts at the scene's folder, or at the asset root that is given instead");
    expect_refused(
        "nodes: {a: {file: nodes-linear.gltf, node: Flat}}\n"
        "camera: {attach: a}\n",
        ":4:18: camera.attach: the camera of 'a' is orthographic, and that of a scene is "
        "not; camera.fov makes it one of perspective");
}

/* A camera of a file whose field of view no scene may have. */
static void a_field_of_view_that_no_scene_has(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    write_file("n.gltf",
               "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}], \"nodes\": "
               "[{\"name\": \"eye\", \"camera\": 0}], \"cameras\": [{\"type\": \"perspective\", "
               "\"perspective\": {\"yfov\": 3, \"znear\": 1}}]}");
    assert_null(try_in(folder, SCENE "nodes: {a: {file: n.gltf, node: eye}}\ncamera: {attach: a}\n",
                       &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 SCENE_NAME
                 ":4:18: camera.attach: the camera of 'a' has a field of view of 171.887 "
                 "deg; allowed is from 1 deg to 170 deg, and camera.fov may give "
                 "another one");
    struct kiln_scene *scene = load_in(folder, SCENE "nodes: {a: {file: n.gltf, node: eye}}\n"
                                                     "camera: {attach: a, fov: 40 deg}\n");
    assert_true(scene->camera.target.z.constant == -1);
    kiln_scene_destroy(&scene);
}

static void bad_joints(void **state)
{
    (void)state;
    expect_refused("nodes: {a: {mesh: walker}}\n",
                   ":3:19: nodes.a.mesh: needs `joint`, which says which joint of it");
    expect_refused("nodes: {a: {joint: hips}}\n",
                   ":3:20: nodes.a.joint: needs `mesh`, whose joint it is");
    expect_refused("nodes: {a: {mesh: walker, joint: hips}}\n",
                   ":3:19: nodes.a.mesh: unknown mesh 'walker' in backdrop.objects (there are "
                   "none)");
    expect_refused("nodes: {a: {mesh: b, joint: hips, file: nodes-linear.gltf, node: Camera}}\n",
                   ":3:19: nodes.a.mesh: a node is either a joint of a mesh or a node of a file");
    expect_refused(
        "nodes: {a: {mesh: b, joint: hips, scale: 2}}\n"
        "backdrop: {objects: {b: {mesh: {file: nodes-linear.gltf}}}}\n",
        ":3:42: nodes.a.scale: must be left out, since the mesh says where its joint is; "
        "a node with this one as parent has a place of its own");
    expect_refused("nodes: {a: {mesh: bo, joint: hips}}\n"
                   "backdrop: {objects: {box: {mesh: {file: nodes-linear.gltf}}}}\n",
                   ":3:19: nodes.a.mesh: unknown mesh 'bo' in backdrop.objects (did you mean "
                   "'box'?)");
    expect_refused(
        "nodes: {a: {mesh: b, joint: hips}}\n"
        "backdrop: {objects: {b: {mesh: {file: nodes-linear.gltf, attach: a}}}}\n",
        ":4:66: backdrop.objects.b.mesh.attach: the object would lie in a joint of its own mesh, "
        "'a'; it may be attached to a node that does not lie in it");
    expect_refused(
        "nodes: {up: {parent: mid}, mid: {parent: a}, a: {mesh: 1, joint: hips}}\n"
        "backdrop: {objects: [sphere: {}, mesh: {attach: up, file: nodes-linear.gltf}]}\n",
        ":4:49: backdrop.objects.1.mesh.attach: the object would lie in a joint of its own mesh, "
        "'a', by way of up, mid; it may be attached to a node that does not lie in it");
}

#define OF_LIST "backdrop: {objects: [sphere: {}, mesh: {file: nodes-linear.gltf}]}\n"

/* An object of a list has no name, and is named by its number. */
static void bad_numbers_of_meshes(void **state)
{
    (void)state;
    expect_refused("nodes: {a: {mesh: 0, joint: hips}}\n",
                   ":3:19: nodes.a.mesh: backdrop.objects has no objects");
    expect_refused("nodes: {a: {mesh: 2, joint: hips}}\n" OF_LIST,
                   ":3:19: nodes.a.mesh: backdrop.objects has no object 2; allowed is from 0 to 1");
    expect_refused("nodes: {a: {mesh: 0, joint: hips}}\n" OF_LIST,
                   ":3:19: nodes.a.mesh: must be a mesh; object 0 is of another kind");
    expect_refused("nodes: {a: {mesh: walker, joint: hips}}\n" OF_LIST,
                   ":3:19: nodes.a.mesh: unknown mesh 'walker' in backdrop.objects (no mesh has "
                   "a name; allowed is a number from 0 to 1)");
}

static void a_mesh_of_a_list_has_a_number(void **state)
{
    (void)state;
    const struct rig rig = still_rig();
    write_file("walker.gltf", to_gltf(&rig, &SOUND));
    struct kiln_scene *scenes[2] = {
        load_in(folder, SCENE "nodes: {a: {mesh: walker, joint: chest}}\n"
                              "backdrop: {objects: {ball: {sphere: {}}, walker: {mesh: {file: "
                              "walker.gltf, position: [1, 2, 3]}}}}\n"),
        load_in(folder, SCENE "nodes: {a: {mesh: 1, joint: chest}}\n"
                              "backdrop: {objects: [sphere: {}, mesh: {file: walker.gltf, "
                              "position: [1, 2, 3]}]}\n"),
    };
    const struct kiln_node_frame named = kiln_node_frame_at(scenes[0], 0, 0, 0);
    const struct kiln_node_frame numbered = kiln_node_frame_at(scenes[1], 0, 0, 0);
    assert_memory_equal(&named, &numbered, sizeof named);
    assert_true(named.at[1] > 1);
    for (int i = 0; i < 2; i++)
        kiln_scene_destroy(&scenes[i]);
}

static void a_joint_that_is_not_there(void **state)
{
    (void)state;
    const struct rig rig = still_rig();
    struct kiln_error error = {0};
    write_file("walker.gltf", to_gltf(&rig, &SOUND));
    assert_null(try_in(folder,
                       SCENE "nodes: {a: {mesh: walker, joint: foot}}\n"
                             "backdrop: {objects: {walker: {mesh: {file: walker.gltf}}}}\n",
                       &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 SCENE_NAME ":3:34: nodes.a.joint: 'walker.gltf': no joint is called 'foot' or has "
                            "this number; the file has 'hips', 'chest', 'head', by some of "
                            "the numbers 0 to 4");
}

/* A glTF file of these nodes and nothing else. */
static void expect_rig(const char *nodes, const char *roots, const char *message)
{
    struct kiln_error error = {0};
    struct kiln_text text = {0};
    kiln_text_add(&text,
                  "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [%s]}], \"nodes\": "
                  "[%s]}",
                  roots, nodes);
    assert_false(text.failed);
    struct kiln_rig *rig = kiln_rig_parse(text.data, text.length, "a.gltf", &error);
    kiln_text_free(&text);
    uint32_t node = 0;
    const bool found = rig && kiln_rig_find_node(rig, "n", false, "a.gltf", &node, &error);
    if (message) {
        assert_false(found);
        expect_error(&error, KILN_INVALID_INPUT, "%s", message);
    } else {
        if (!found)
            fail_msg("%s", error.message);
        const struct kiln_rig_moment rest = {.clip = KILN_RIG_AT_REST};
        const struct kiln_rig_pose pose = kiln_rig_pose_at(rig, node, &rest);
        for (int c = 0; c < 3; c++)
            assert_true(isfinite(pose.at[c]) && isfinite(pose.ahead[c]) && isfinite(pose.up[c]) &&
                        isfinite(pose.spin[c]) && isfinite(pose.velocity[c]));
        assert_true(pose.scale >= 1e-6 && pose.scale <= 1e6);
    }
    kiln_rig_destroy(&rig);
}

/* A chain of nodes, one below the other, with this in each; the last is called n. */
static char *chain_of(int count, const char *each)
{
    struct kiln_text text = {0};
    for (int i = 0; i < count; i++) {
        kiln_text_add(&text, "%s{%s", i ? ", " : "", each);
        if (i + 1 < count)
            kiln_text_add(&text, "%s\"children\": [%d]}", *each ? ", " : "", i + 1);
        else
            kiln_text_add(&text, "%s\"name\": \"n\"}", *each ? ", " : "");
    }
    assert_false(text.failed);
    return text.data;
}

static void hostile_files(void **state)
{
    (void)state;
    expect_rig("{\"name\": \"n\"}", "0", NULL);
    expect_rig("{\"name\": \"n\", \"scale\": [0, 0, 0]}", "0", NULL);
    expect_rig("{\"name\": \"n\", \"rotation\": [0, 0, 0, 0], \"scale\": [-1, 1e-9, 1e6]}", "0",
               NULL);
    expect_rig("{\"name\": \"n\", \"children\": [1]}, {\"children\": [0]}", "",
               "a.gltf: the scene has no nodes");
    expect_rig("{\"name\": \"n\", \"children\": [0]}", "0",
               "a.gltf: node 0 is twice in the scene, as a root and below one");
    expect_rig("{\"name\": \"n\", \"translation\": [1e30, 0, 0]}", "0",
               "a.gltf: a node has numbers beyond -1e+06 and 1e+06");
    expect_rig(
        "{\"name\": \"n\", \"translation\": [1e300, 0, 0], \"scale\": [1e300, 1e300, 1e300]}", "0",
        "a.gltf: a node has numbers beyond -1e+06 and 1e+06");
    expect_rig("{\"name\": \"n\"}, {\"name\": \"n\"}, {\"name\": \"n\"}", "2, 0, 1",
               "a.gltf: 3 nodes are called 'n', of the numbers 2 and 0 and others; a number says "
               "which is meant");
    expect_rig("{\"name\": \"n\", \"camera\": 0}", "0",
               "a.gltf: a member 'camera' is no number of an element of 'cameras', of which there "
               "are 0");
    char *chain = chain_of(1024, "\"scale\": [1e6, 1e6, 1e6], \"translation\": [1e6, 0, 1e6]");
    expect_rig(chain, "0", NULL);
    free(chain);
    chain = chain_of(1025, "");
    expect_rig(chain, "0", "a.gltf: node 1024 lies below 1024 others; allowed are at most 1023");
    free(chain);
    chain = chain_of(65537, "");
    expect_rig(chain, "0", "a.gltf: more than 65536 nodes; no more are allowed");
    free(chain);
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    static const char *const names[] = {"walker.gltf", "n.gltf"};
    char path[128];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rates_are_those_of_the_frames),
        cmocka_unit_test(a_clip_ends_or_starts_again),
        cmocka_unit_test(a_camera_of_a_file_is_that_of_three_js),
        cmocka_unit_test(the_scene_may_give_a_field_of_view),
        cmocka_unit_test(a_joint_moves_as_a_vertex_of_it),
        cmocka_unit_test(files_belong_to_what_they_move),
        cmocka_unit_test(bad_nodes),
        cmocka_unit_test(a_field_of_view_that_no_scene_has),
        cmocka_unit_test(bad_joints),
        cmocka_unit_test(bad_numbers_of_meshes),
        cmocka_unit_test(a_mesh_of_a_list_has_a_number),
        cmocka_unit_test(a_joint_that_is_not_there),
        cmocka_unit_test(hostile_files),
    };
    return cmocka_run_group_tests_name("rig", tests, make_folder, remove_folder);
}
