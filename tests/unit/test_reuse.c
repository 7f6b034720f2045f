/* lib/option: aliases, includes and uses. If one of these tests fails, a scene that is made of
 * parts loads as another scene, or its errors name the wrong place, or a short text takes long. */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "scene/scene.h"
#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"
#include "support/scenes.h"

#define EMIT "emit: {rate: 5, life: 1 s, speed: 1}"

/* Expects that two scenes are one: that they print the same text. */
static void expect_same(const char *text, const char *plain)
{
    struct kiln_scene *a = load_scene(text, NULL), *b = load_scene(plain, NULL);
    char *of_a = print_scene(a), *of_b = print_scene(b);
    assert_string_equal(of_a, of_b);
    free(of_a);
    free(of_b);
    kiln_scene_destroy(&a);
    kiln_scene_destroy(&b);
}

/* ---- aliases --------------------------------------------------------------------------------- */

static void aliases_repeat(void **state)
{
    (void)state;
    expect_same("kiln: 1\n"
                "systems:\n"
                "  a: &a {" EMIT ", look: &look {size: 0.1, color: &c [1, 0.5, 0]}}\n"
                "  b: {<<: *a, look: {<<: *look, size: 0.2}}\n"
                "  c: {" EMIT ", look: {color: *c}}\n",
                "kiln: 1\n"
                "systems:\n"
                "  a: {" EMIT ", look: {size: 0.1, color: [1, 0.5, 0]}}\n"
                "  b: {" EMIT ", look: {size: 0.2, color: [1, 0.5, 0]}}\n"
                "  c: {" EMIT ", look: {color: [1, 0.5, 0]}}\n");
    /* Of several mappings the first wins, whatever comes behind <<. */
    expect_same("kiln: 1\n"
                "output: {<<: [{fps: 25}, {fps: 30, frames: 7}], size: [64, 32]}\n"
                "camera: {fov: 30 deg, <<: {fov: 40 deg, roll: 5 deg}}\n",
                "kiln: 1\n"
                "output: {fps: 25, frames: 7, size: [64, 32]}\n"
                "camera: {fov: 30 deg, roll: 5 deg}\n");
    /* An anchor may be set again. */
    expect_same("kiln: 1\n"
                "seed: &n 1\n"
                "output: {frames: &n 32, size: [*n, 64]}\n"
                "simulation: {warmup: *n}\n"
                "camera: {roll: 0}\n",
                "kiln: 1\n"
                "seed: 1\n"
                "output: {frames: 32, size: [32, 64]}\n"
                "simulation: {warmup: 32}\n");
}

static const struct bad bad_aliases[] = {
    {"kiln: 1\nsystems: {a: *a}\n", ":2:14: there is no anchor 'a' above"},
    {"kiln: 1\nsystems: &s {a: *s}\n", ":2:17: the alias is inside of its own anchor"},
    {"kiln: 1\nsystems: {a: &a {emit: {raet: 1}}, b: *a}\n",
     ":2:25: systems.a.emit.raet: unknown key (did you mean 'rate'?)"},
    {"kiln: 1\n"
     "camera: {roll: &n 5 m}\n",
     ":2:19: camera.roll: unit 'm' is wrong; allowed is deg or rad"},
    {"kiln: 1\n"
     "seed: &n 5\n"
     "camera: {roll: *n}\n",
     ":2:10: camera.roll: an angle needs its unit: 5 deg or 5 rad; repeated by the alias at "
     "test.yaml:3:16"},
    {"kiln: 1\n<<: {seed: 1, x: 2}\n", ":2:15: x: unknown key (there are: kiln, include, params, "
                                       "seed, output, simulation, nodes, camera, "
                                       "backdrop, systems, gas, post)"},
};

static void aliases_fail(void **state)
{
    (void)state;
    expect_all(bad_aliases, sizeof bad_aliases / sizeof *bad_aliases);
}

/* Each line of the bomb has the one before it ten times: the fifth has 100,000 scalars. */
static void alias_bomb(void **state)
{
    (void)state;
    struct kiln_text text = {0};
    kiln_text_add(&text, "kiln: 1\na0: &a0 [x, x, x, x, x, x, x, x, x, x]\n");
    for (int i = 1; i < 30; i++)
        kiln_text_add(&text,
                      "a%d: &a%d [*a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d]\n", i,
                      i, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1);
    struct kiln_error error = {0};
    struct timespec before, after;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
    assert_null(try_scene(text.data, NULL, &error));
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:6:45: aliases, uses and parameters copy more than the 100000 nodes "
                 "that are allowed");
    const double seconds =
        (double)(after.tv_sec - before.tv_sec) + 1e-9 * (double)(after.tv_nsec - before.tv_nsec);
    assert_true(seconds < 1); /* milliseconds, but for sanitizers */
    kiln_text_free(&text);
    /* Lists within lists are as deep as what they are copied into and what is copied. */
    kiln_text_add(&text, "kiln: 1\na0: &a0 [[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]\n");
    for (int i = 1; i < 5; i++)
        kiln_text_add(&text, "a%d: &a%d [[[[[[[[[[[[[[[[*a%d]]]]]]]]]]]]]]]]\n", i, i, i - 1);
    assert_null(try_scene(text.data, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:5:25: nested deeper than the 64 levels that are allowed");
    kiln_text_free(&text);
}

/* ---- use ------------------------------------------------------------------------------------- */

static void uses_copy(void **state)
{
    (void)state;
    expect_same(
        "kiln: 1\n"
        "systems:\n"
        "  left: {use: flames, emit: {rate: 40}}\n"
        "  flames: {enabled: false, use: base, forces: [gravity: [0, 1, 0]]}\n"
        "  base: {enabled: false, " EMIT ", forces: [drag: 1]}\n"
        "  slow: {use: flames, emit: {speed: {keys: {0 s: 1, 1 s: 2}}}, enabled: false}\n",
        "kiln: 1\n"
        "systems:\n"
        "  left: {emit: {rate: 40, life: 1 s, speed: 1}, forces: [gravity: [0, 1, 0]]}\n"
        "  flames: {enabled: false, " EMIT ", forces: [gravity: [0, 1, 0]]}\n"
        "  base: {enabled: false, " EMIT ", forces: [drag: 1]}\n"
        "  slow: {enabled: false, emit: {rate: 5, life: 1 s, speed: {keys: {0 s: 1, 1 s: 2}}},\n"
        "         forces: [gravity: [0, 1, 0]]}\n");
}

static void uses_of_kinds(void **state)
{
    (void)state;
    expect_same("kiln: 1\n"
                "systems:\n"
                "  a: {emit: {rate: 1, life: 1 s, speed: 1, from: {sphere: {radius: 2}}}}\n"
                "  b: {use: a, emit: {from: {sphere: {origin: [1, 2, 3]}}}}\n"
                "  c: {use: a, emit: {from: {box: {size: [2, 2, 2]}}}}\n",
                "kiln: 1\n"
                "systems:\n"
                "  a: {emit: {rate: 1, life: 1 s, speed: 1, from: {sphere: {radius: 2}}}}\n"
                "  b: {emit: {rate: 1, life: 1 s, speed: 1, from: {sphere: {radius: 2, origin: "
                "[1, 2, 3]}}}}\n"
                "  c: {emit: {rate: 1, life: 1 s, speed: 1, from: {box: {size: [2, 2, 2]}}}}\n");
}

static void objects_have_names(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load_scene("kiln: 1\n"
                   "backdrop:\n"
                   "  objects:\n"
                   "    ball: {sphere: {radius: 0.5, center: [1, 0, 0]}}\n"
                   "    other: {use: ball, sphere: {center: [2, 0, 0]}}\n"
                   "    cube: {use: ball, box: {}}\n"
                   "  lights: {lamp: {point: {}}, panel: {rectangle: {}}}\n",
                   (const char *const[]){"backdrop.objects.ball.sphere.radius=0.25",
                                         "backdrop.lights.*.point.radius=0.3", NULL});
    assert_int_equal(scene->backdrop.object_count, 3);
    assert_string_equal(scene->backdrop.objects[1].name, "other");
    assert_true(scene->backdrop.objects[0].radius.constant == 0.25f); /* set after uses */
    assert_true(scene->backdrop.objects[1].radius.constant == 0.5f);
    assert_true(scene->backdrop.objects[1].center.x.constant == 2);
    assert_int_equal(scene->backdrop.objects[2].kind, KILN_OBJECT_BOX);
    assert_string_equal(scene->backdrop.lights[1].name, "panel");
    char *text = print_scene(scene);
    struct kiln_scene *again = load_scene(text, NULL);
    assert_string_equal(scene->hash, again->hash);
    free(text);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&again);
}

static const struct bad bad_uses[] = {
    {"kiln: 1\nsystems: {a: {use: b}}\n",
     ":2:20: systems.a.use: there is no entry 'b' (there are: a)"},
    {"kiln: 1\nsystems: {a: {use: a}}\n", ":2:20: systems.a.use: this entry uses itself"},
    {"kiln: 1\nsystems: {a: {use: b}, b: {use: c}, c: {use: a}}\n",
     ":2:46: systems.c.use: this entry uses itself"},
    {"kiln: 1\nsystems: {a: {use: [b]}}\n",
     ":2:20: systems.a.use: expected the name of another entry, found a list"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {enabled: false, emit: {rate: -1, life: 1 s, speed: 1}}\n",
     ":3:36: systems.a.emit.rate: -1 is out of range; allowed is from 0 1/s to 10000000 1/s"},
    {"kiln: 1\n"
     "systems:\n"
     "  b: {use: a}\n"
     "  a: {enabled: false, emit: {rate: -1, life: 1 s, speed: 1}}\n",
     ":4:36: systems.b.emit.rate: -1 is out of range; allowed is from 0 1/s to 10000000 1/s; used "
     "at "
     "test.yaml:3:12"},
    {"kiln: 1\nbackdrop: {objects: {1a: {box: {}}}}\n",
     ":2:22: backdrop.objects.1a: a name starts with a letter and has at most 32 letters, digits, "
     "'_' and '-'"},
    {"kiln: 1\nbackdrop: {objects: {a: {mesh: {file: nowhere.obj}}}}\n",
     ":2:39: backdrop.objects.a.mesh.file: cannot open 'nowhere.obj': No such file or directory; a "
     "path starts at the scene's folder, or at the asset root that is given instead"},
};

static void uses_fail(void **state)
{
    (void)state;
    expect_all(bad_uses, sizeof bad_uses / sizeof *bad_uses);
}

static void uses_are_limited(void **state)
{
    (void)state;
    struct kiln_text text = {0};
    struct kiln_error error = {0};
    kiln_text_add(&text, "kiln: 1\nsystems:\n");
    for (int i = 0; i < 1000; i++)
        kiln_text_add(&text, "  s%d: {use: s%d}\n", i, i + 1);
    assert_null(try_scene(text.data, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:67:14: systems.s64.use: more than 64 entries use each other");
    kiln_text_free(&text);
}

/* ---- includes -------------------------------------------------------------------------------- */

struct place {
    char folder[32];
    int before;
};

static int enter_folder(void **state)
{
    static struct place place;
    test_make_folder(place.folder);
    place.before = open(".", O_RDONLY | O_DIRECTORY);
    assert_true(place.before >= 0 && chdir(place.folder) == 0);
    assert_true(mkdir("in", 0777) == 0 && mkdir("in/parts", 0777) == 0);
    *state = &place;
    return 0;
}

static int leave_folder(void **state)
{
    struct place *place = *state;
    assert_int_equal(fchdir(place->before), 0);
    close(place->before);
    test_remove_folder(place->folder);
    return 0;
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void includes_merge(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    write_text("in/parts/fire.yaml", "kiln: 1\n"
                                     "include: common.yaml\n"
                                     "output: {fps: 25, frames: 9}\n"
                                     "systems: {fire: {" EMIT ", look: {size: 0.3}}}\n");
    write_text("in/parts/common.yaml", "output: {frames: 3, size: [64, 32]}\n"
                                       "backdrop: {floor: none}\n"
                                       "systems: {smoke: {" EMIT "}}\n");
    write_text("in/parts/rain.yaml", "include: [common.yaml]\n"
                                     "output: {fps: 50}\n"
                                     "systems: {rain: {" EMIT "}}\n");
    write_text("in/s.yaml", "kiln: 1\n"
                            "include: [parts/fire.yaml, parts/rain.yaml]\n"
                            "systems:\n"
                            "  own: {use: rain}\n"
                            "  fire: {look: {opacity: 0.5}}\n");
    struct kiln_scene *scene = kiln_scene_load("in/s.yaml", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    /* The file's own systems come first, then those of its includes in their order. */
    static const char *const names[] = {"own", "fire", "smoke", "rain"};
    assert_int_equal(scene->system_count, 4);
    for (uint32_t i = 0; i < 4; i++)
        assert_string_equal(scene->systems[i].name, names[i]);
    assert_true(scene->systems[1].look.size.constant == 0.3f);
    assert_true(scene->systems[1].look.opacity.constant == 0.5f);
    assert_int_equal(scene->frames, 9);
    assert_int_equal(scene->fps.num, 25);
    assert_int_equal(scene->width, 64);
    assert_false(scene->backdrop.floor_enabled);
    uint32_t files = 0;
    for (const struct kiln_scene_file *file = scene->files; file; file = file->next)
        files += file->status != NULL;
    assert_int_equal(files, 4); /* an output may overwrite none of them */
    kiln_scene_destroy(&scene);
}

/* A file in parts/ finds its files there, and may find others below the root. */
static void assets_of_includes(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    write_text("in/parts/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_text("in/tri.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
    write_text(
        "in/parts/o.yaml",
        "backdrop: {objects: {a: {mesh: {file: tri.obj}}, b: {mesh: {file: ../tri.obj}}}}\n");
    write_text("in/s.yaml", "kiln: 1\ninclude: parts/o.yaml\n");
    struct kiln_scene *scene = kiln_scene_load("in/s.yaml", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    char *text = print_scene(scene);
    assert_non_null(strstr(text, "file: \"parts/tri.obj\""));
    assert_non_null(strstr(text, "file: \"tri.obj\""));
    free(text);
    kiln_scene_destroy(&scene);
}

static void expect_refusal(const char *message)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_load("in/s.yaml", NULL, &error);
    assert_null(scene);
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
}

static void includes_fail(void **state)
{
    (void)state;
    write_text("in/s.yaml", "kiln: 1\ninclude: [parts/a.yaml]\n");
    expect_refusal("in/s.yaml:2:11: include: cannot open 'parts/a.yaml': No such file or "
                   "directory; a path starts at the scene's folder, or at the asset root that is "
                   "given instead");
    write_text("in/parts/a.yaml", "systems:\n  a: {emit: {raet: 1}}\n");
    expect_refusal("in/parts/a.yaml:2:14: systems.a.emit.raet: unknown key (did you mean 'rate'?); "
                   "included from in/s.yaml:2:11");
    write_text("in/parts/a.yaml", "include: b.yaml\n");
    write_text("in/parts/b.yaml", "include: [../parts/a.yaml]\n");
    expect_refusal("in/parts/b.yaml:1:11: include: this file includes itself; included from "
                   "in/parts/a.yaml:1:10; included from in/s.yaml:2:11");
    write_text("in/parts/a.yaml", "include: ../s.yaml\n");
    expect_refusal("in/parts/a.yaml:1:10: include: this file includes itself; included from "
                   "in/s.yaml:2:11");
    write_text("in/parts/a.yaml", "include: ../../x.yaml\n");
    expect_refusal("in/parts/a.yaml:1:10: include: '../../x.yaml' is outside the asset root; a "
                   "path starts at the scene's folder and stays below it; included from "
                   "in/s.yaml:2:11");
    write_text("in/parts/a.yaml", "kiln: 2\n");
    expect_refusal("in/parts/a.yaml:1:7: kiln: 2 is out of range; allowed is 1; included from "
                   "in/s.yaml:2:11");
    write_text("in/parts/a.yaml", "- 1\n");
    expect_refusal("in/parts/a.yaml:1:1: expected a mapping of keys, found a list; included from "
                   "in/s.yaml:2:11");
    write_text("in/s.yaml", "kiln: 1\ninclude: [parts/a.yaml, parts/b.yaml]\n");
    write_text("in/parts/a.yaml", "systems: {x: {" EMIT "}}\n");
    write_text("in/parts/b.yaml", "systems: {y: {" EMIT "}, x: {}}\n");
    expect_refusal("in/parts/b.yaml:1:54: systems.x: two includes define this name; the other one "
                   "is at in/parts/a.yaml:1:11; included from in/s.yaml:2:25");
    write_text("in/s.yaml", "kiln: 1\ninclude: {a: 1}\n");
    expect_refusal("in/s.yaml:2:10: include: expected the path of a file or a list of these, found "
                   "a mapping");
    write_text("in/s.yaml", "kiln: 1\ninclude: parts\n");
    expect_refusal("in/s.yaml:2:10: include: 'parts': the path is a folder, not a scene file");
}

static void includes_are_limited(void **state)
{
    (void)state;
    char path[64], text[64];
    write_text("in/s.yaml", "kiln: 1\ninclude: parts/0.yaml\n");
    for (int i = 0; i < 9; i++) {
        snprintf(path, sizeof path, "in/parts/%d.yaml", i);
        snprintf(text, sizeof text, "include: %d.yaml\n", i + 1);
        write_text(path, text);
    }
    expect_refusal(
        "in/parts/7.yaml:1:10: include: files are included through more than 8 files; included "
        "from in/parts/6.yaml:1:10; included from in/parts/5.yaml:1:10; included from "
        "in/parts/4.yaml:1:10; included from in/parts/3.yaml:1:10; included from "
        "in/parts/2.yaml:1:10; included from in/parts/1.yaml:1:10; included from "
        "in/parts/0.yaml:1:10; included from in/s.yaml:2:10");
    struct kiln_text all = {0};
    kiln_text_add(&all, "kiln: 1\ninclude: [");
    for (int i = 0; i < 65; i++) {
        snprintf(path, sizeof path, "in/parts/x%d.yaml", i);
        write_text(path, "seed: 1\n");
        kiln_text_add(&all, "%sparts/x%d.yaml", i ? ", " : "", i);
    }
    kiln_text_add(&all, "]\n");
    write_text("in/s.yaml", all.data);
    expect_refusal("in/s.yaml:2:10: include: more than the 64 included files that are allowed");
    kiln_text_free(&all);
}

/* Many files are together as large as one may be: in bytes, and in nodes, of which a file that lies
 * under another one leaves few. */
static void includes_share_limits(void **state)
{
    (void)state;
    struct kiln_text comment = {0}, nodes = {0};
    for (int i = 0; i < 20000; i++)
        kiln_text_add(&comment, "# %0100d\n", i);
    kiln_text_add(&comment, "seed: 1\n");
    write_text("in/parts/a.yaml", comment.data);
    write_text("in/parts/b.yaml", comment.data);
    write_text("in/parts/c.yaml", comment.data);
    write_text("in/s.yaml", "kiln: 1\ninclude: [parts/a.yaml, parts/b.yaml, parts/c.yaml]\n");
    expect_refusal("in/s.yaml:2:39: include: the scene and what it includes have more than the "
                   "4194304 bytes that are allowed");
    kiln_text_add(&nodes, "seed:\n");
    for (int i = 0; i < 200; i++) {
        kiln_text_add(&nodes, "  - [");
        for (int k = 0; k < 1000; k++)
            kiln_text_add(&nodes, "1,");
        kiln_text_add(&nodes, "]\n");
    }
    write_text("in/parts/a.yaml", nodes.data);
    write_text("in/parts/b.yaml", nodes.data);
    write_text("in/s.yaml", "kiln: 1\nseed: 1\ninclude: [parts/a.yaml, parts/b.yaml]\n");
    expect_refusal("in/parts/b.yaml:63:1740: more than 262144 entries in all; no more are allowed; "
                   "included from in/s.yaml:3:25");
    kiln_text_free(&comment);
    kiln_text_free(&nodes);
}

/* A link out of the root must not be read, nor a FIFO waited for. */
static void includes_are_safe(void **state)
{
    (void)state;
    write_text("secret.yaml", "kiln: 1\n");
    assert_int_equal(symlink("../../secret.yaml", "in/parts/link.yaml"), 0);
    assert_int_equal(mkfifo("in/parts/fifo.yaml", 0666), 0);
    write_text("in/s.yaml", "kiln: 1\ninclude: parts/link.yaml\n");
    expect_refusal("in/s.yaml:2:10: include: 'parts/link.yaml' leads outside the asset root");
    write_text("in/s.yaml", "kiln: 1\ninclude: parts/fifo.yaml\n");
    expect_refusal("in/s.yaml:2:10: include: 'parts/fifo.yaml': the path is not a regular file");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(aliases_repeat),
        cmocka_unit_test(aliases_fail),
        cmocka_unit_test(alias_bomb),
        cmocka_unit_test(uses_copy),
        cmocka_unit_test(uses_of_kinds),
        cmocka_unit_test(objects_have_names),
        cmocka_unit_test(uses_fail),
        cmocka_unit_test(uses_are_limited),
        cmocka_unit_test_setup_teardown(includes_merge, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(assets_of_includes, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(includes_fail, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(includes_are_limited, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(includes_share_limits, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(includes_are_safe, enter_folder, leave_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
