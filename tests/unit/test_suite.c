/* lib/suite: which files are tests, and what a test file says. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "suite/suite.h"
#include "suite/test_name.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

static const char scene[] = "kiln: 1\nsystems: {}\n";
static const char fire_test[] = "kiln_test: 1\nscene: fire.yaml\n";

static struct kiln_suite *load(const struct kiln_suite_params *params)
{
    struct kiln_error error = {0};
    struct kiln_suite *suite = kiln_suite_load(params, &error);
    if (!suite)
        fail_msg("not loaded: %s", error.message);
    return suite;
}

static void expect_usage(const struct kiln_suite_params *params, const char *message)
{
    struct kiln_error error = {0};
    struct kiln_suite *suite = kiln_suite_load(params, &error);
    if (suite)
        fail_msg("loaded %zu tests, but expected: %s", kiln_suite_count(suite), message);
    expect_error(&error, KILN_USAGE, "%s", message);
}

/* Loads the paths and compares the full names, which are joined by blanks. */
static void expect_names(const struct kiln_suite_params *params, const char *names)
{
    struct kiln_suite *suite = load(params);
    char text[1024] = "";
    for (size_t i = 0; i < kiln_suite_count(suite); i++) {
        size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s%s", i ? " " : "",
                 kiln_suite_test(suite, i).name);
    }
    assert_string_equal(text, names);
    kiln_suite_destroy(&suite);
    assert_null(suite);
}

static struct kiln_suite_params paths(const char *const *list, size_t count)
{
    struct kiln_suite_params params = kiln_suite_defaults();
    params.paths = list;
    params.path_count = count;
    return params;
}

static const char *const here[] = {"."};

/* ---- Finding ------------------------------------------------------------------------------ */

static void make_tree(void)
{
    test_write_file("scenes/.kiln-tests", "");
    test_write_file("scenes/plain.yaml", scene);
    test_write_file("scenes/other.yml", scene);
    test_write_file("scenes/fire.yaml", scene);
    test_write_file("scenes/fire.test.yaml", fire_test);
    test_write_file("scenes/effects/far.test.yaml", "kiln_test: 1\nscene: ../plain.yaml\n");
    test_write_file("scenes/effects/near.test.yml", "kiln_test: 1\nscene: ../plain.yaml\n");
    test_write_file("scenes/.hidden/no.yaml", scene);
    test_write_file("scenes/.no.test.yaml", fire_test);
    test_write_file("scenes/compose.yaml", "services: {kiln: 1}\n");
    test_write_file("scenes/helm.yaml", "a: {{ .Values.b }}\n");
    test_write_file("scenes/notes.txt", scene);
    test_write_file("golden/fire/scene.yaml", scene);
    test_write_file("out/test/fire/scene.yaml", scene);
    assert_int_equal(symlink("effects", "scenes/link"), 0);
}

static void folders_are_searched(void **state)
{
    (void)state;
    make_tree();
    struct kiln_suite_params params = paths(here, 1);
    expect_names(&params, "effects/far effects/near fire other");
    static const char *const folder[] = {"scenes//"};
    params = paths(folder, 1);
    expect_names(&params, "effects/far effects/near fire other");

    /* Goldens that are not this run's are goldens still. */
    test_write_file("elsewhere/fire/expect.yaml", "kiln_expect: 1\n");
    test_write_file("elsewhere/fire/scene.yaml", scene);
    static const char *const elsewhere[] = {"elsewhere"};
    params = paths(elsewhere, 1);
    expect_usage(&params, "elsewhere: the folder has no tests: no *.test.yaml, and no scene");
    /* But no other file is, wherever an expect.yaml is dropped. */
    test_write_file("elsewhere/fire/torch.yaml", scene);
    test_write_file("elsewhere/fire/smoke.test.yaml", fire_test);
    expect_names(&params, "elsewhere/fire/smoke elsewhere/fire/torch");
}

static void paths_lead_from_the_test_file(void **state)
{
    (void)state;
    make_tree();
    static const char *const folder[] = {"./scenes"};
    struct kiln_suite_params params = paths(folder, 1);
    params.golden = "g/";
    params.results = "r//";
    struct kiln_suite *suite = load(&params);
    const struct kiln_test *test = &suite->tests[0];
    assert_string_equal(test->path, "./scenes/effects/far.test.yaml");
    assert_string_equal(test->scene, "./scenes/effects/../plain.yaml");
    assert_string_equal(test->golden, "g/effects/far");
    assert_string_equal(test->results, "r/effects/far");
    assert_string_equal(kiln_suite_test(suite, 0).results, "r/effects/far");
    assert_string_equal(suite->results_folder, "r");
    kiln_suite_destroy(&suite);
}

static void files_are_found_once(void **state)
{
    (void)state;
    make_tree();
    static const char *const files[] = {"scenes/effects/far.test.yaml", "scenes/plain.yaml",
                                        "./scenes/other.yml"};
    struct kiln_suite_params params = paths(files, 3);
    expect_names(&params, "effects/far other plain");
    /* Found again in a folder, a file is still one test. */
    static const char *const twice[] = {"scenes/fire.test.yaml", "scenes", "./scenes/"};
    params = paths(twice, 3);
    expect_names(&params, "effects/far effects/near fire other");
}

static void scenes_with_faults_are_not_passed_over(void **state)
{
    (void)state;
    test_write_file("a.yaml", "# a scene\nkiln: 1\nsystems: {\n");
    test_write_file("b.yaml", "name: [\nno kiln: 1\n");
    test_write_file("c.yaml", "\"kiln\" : 1\nsystems: {\n");
    test_write_file("d.yaml", "{ kiln: 1, systems: [}\n");
    test_write_file("e.yaml", "\xef\xbb\xbfkiln: 1\nsystems: {\n");
    struct kiln_suite_params params = paths(here, 1);
    expect_names(&params, "a c d e");

    test_write_file("fire-test.yaml", fire_test);
    expect_usage(&params, "fire-test.yaml: a file with the key kiln_test needs a name that ends in "
                          ".test.yaml");
    assert_int_equal(unlink("fire-test.yaml"), 0);

    assert_int_equal(symlink("gone.yaml", "x.yaml"), 0);
    struct kiln_error error = {0};
    assert_null(kiln_suite_load(&params, &error));
    expect_error(&error, KILN_IO, "x.yaml: No such file or directory");
}

static void operands_that_are_no_tests(void **state)
{
    (void)state;
    test_write_file("readme.md", "");
    test_write_file("empty/readme.md", "");
    static const struct {
        const char *path, *message;
    } cases[] = {
        {"gone", "gone: No such file or directory"},
        {"readme.md", "readme.md: not a test; a test is a *.test.yaml or a scene, *.yaml or *.yml"},
        {"empty/", "empty/: the folder has no tests: no *.test.yaml, and no scene"},
        {"/dev/null", "/dev/null: not a test; a test is a *.test.yaml or a scene, *.yaml or *.yml"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_suite_params params = paths(&cases[i].path, 1);
        expect_usage(&params, cases[i].message);
    }
    struct kiln_suite_params none = paths(here, 0);
    expect_usage(&none, "no tests, scenes or folders are given");
}

/* ---- Names -------------------------------------------------------------------------------- */

static void two_tests_of_one_name(void **state)
{
    (void)state;
    test_write_file("a/fire.test.yaml", fire_test);
    test_write_file("b/fire.yaml", scene);
    static const char *const files[] = {"a/fire.test.yaml", "b/fire.yaml"};
    struct kiln_suite_params params = paths(files, 2);
    expect_names(&params, "a/fire b/fire");
    params.golden = "/nowhere/goldens";
    expect_usage(&params, "a/fire.test.yaml and b/fire.yaml: both tests are named 'fire'; an empty "
                          "file .kiln-tests in a folder above both lets names begin there");

    /* A scene beside its broken test file is not a second test. */
    test_write_file("c/fire.test.yaml", "kiln_test: 1\nscene: [\n");
    test_write_file("c/fire.yaml", scene);
    static const char *const folder[] = {"c"};
    params = paths(folder, 1);
    expect_names(&params, "c/fire");
}

/* Loads one file, whose name is none, and compares what is wrong and what stands for it. */
static void expect_sanitized(const char *path, const char *name, const char *quoted)
{
    test_write_file(path, fire_test);
    struct kiln_suite_params params = paths(&path, 1);
    expect_names(&params, name);
    struct kiln_suite *suite = load(&params);
    char message[512], shown[256];
    kiln_shown(shown, sizeof shown, path);
    snprintf(message, sizeof message,
             "%s: '%s' cannot name a test: a name has up to 200 bytes of letters, digits, '.', '_' "
             "and '-', and does not start with '.' or '-'",
             shown, quoted);
    expect_error(&suite->tests[0].problem, KILN_INVALID_INPUT, "%s", message);
    kiln_suite_destroy(&suite);
}

static void odd_names_are_errors_of_their_tests(void **state)
{
    (void)state;
    test_write_file("fire.yaml", scene);
    expect_sanitized("my fire.test.yaml", "my_fire", "my fire");
    expect_sanitized("./-q.test.yaml", "_q", "-q");
    expect_sanitized("..test.yaml", "_", ".");
    expect_sanitized("a\xe2\x80\x8b.test.yaml", "a___", "a\\u200b");
    expect_sanitized("a\xff.test.yaml", "a_", "a\\xff");
    /* The others run. */
    test_write_file("fine.test.yaml", fire_test);
    static const char *const files[] = {"my fire.test.yaml", "fine.test.yaml"};
    struct kiln_suite_params params = paths(files, 2);
    struct kiln_suite *suite = load(&params);
    assert_int_equal(kiln_suite_count(suite), 2);
    assert_string_equal(suite->tests[0].name, "fine");
    assert_int_equal(suite->tests[0].problem.code, KILN_OK);
    kiln_suite_destroy(&suite);
    /* Two that are sanitized alike cannot be told apart. */
    test_write_file("my,fire.test.yaml", fire_test);
    static const char *const alike[] = {"my fire.test.yaml", "my,fire.test.yaml"};
    params = paths(alike, 2);
    expect_usage(&params,
                 "my fire.test.yaml and my,fire.test.yaml: both tests are named 'my_fire'; an "
                 "empty file .kiln-tests in a folder above both lets names begin there");
}

static void letters_of_any_script_name_tests(void **state)
{
    (void)state;
    static const char *const valid[] = {"Gl\xc3\xbch", "\xd0\xbe\xd0\xb3\xd0\xbe\xd0\xbd\xd1\x8c",
                                        "\xe7\x81\xab/\xe7\x84\xb0_2", "a.b-c"};
    static const char *const invalid[] = {"",
                                          "a b",
                                          "a\xc2\xa0",
                                          "a\xe2\x80\x8b",
                                          "a\xef\xbb\xbf",
                                          "a\xc3\x97",
                                          "\xf0\x9f\x94\xa5\xff",
                                          "a/.b",
                                          "a\n",
                                          "a@b"};
    for (size_t i = 0; i < sizeof valid / sizeof *valid; i++)
        assert_true(kiln_test_name_is_valid(valid[i]));
    for (size_t i = 0; i < sizeof invalid / sizeof *invalid; i++)
        assert_false(kiln_test_name_is_valid(invalid[i]));
}

static void names_are_chosen(void **state)
{
    (void)state;
    make_tree();
    static const char *const names[] = {"effects/f*", "other"}, *const wrong[] = {"effects/fra"},
                             *const strange[] = {"nothing\x1b[31m"};
    static const char *const folder[] = {"scenes"};
    struct kiln_suite_params params = paths(folder, 1);
    params.names = names;
    params.name_count = 2;
    expect_names(&params, "effects/far other");
    params.names = wrong;
    params.name_count = 1;
    expect_usage(&params, "no test has the name 'effects/fra' (did you mean 'effects/far'?)");
    params.names = strange;
    expect_usage(&params,
                 "no test has the name 'nothing\\x1b[31m'; 'kiln test list' lists the tests");
}

static void shards_share_the_tests(void **state)
{
    (void)state;
    make_tree();
    static const char *const folder[] = {"scenes"};
    struct kiln_suite_params params = paths(folder, 1);
    params.shard = 1;
    params.shards = 3;
    expect_names(&params, "effects/far other");
    struct kiln_suite *suite = load(&params);
    assert_int_equal(suite->shard, 1);
    assert_int_equal(suite->shards, 3);
    assert_int_equal(suite->all_count, 4);
    kiln_suite_destroy(&suite);
    params.shard = 3;
    expect_names(&params, "fire");
    params.shard = params.shards = 9;
    expect_names(&params, "");
    static const uint32_t wrong[][2] = {{4, 3}, {0, 3}, {1, 0}};
    for (size_t i = 0; i < 3; i++) {
        char message[128];
        params.shard = wrong[i][0];
        params.shards = wrong[i][1];
        snprintf(message, sizeof message, "shard %u/%u: the first must be from 1 to the second",
                 params.shard, params.shards);
        expect_usage(&params, message);
    }
}

static void goldens_of_no_test_are_found(void **state)
{
    (void)state;
    make_tree();
    test_write_file("golden/effects/far/expect.yaml", "");
    test_write_file("golden/effects/gone/expect.yaml", "");
    test_write_file("golden/fir/expect.yaml", "");
    test_write_file("golden/fire/expect.yaml", "");
    test_write_file("golden/notes/readme.md", "");
    static const char *const folder[] = {"scenes"}, *const file[] = {"scenes/other.yml"};
    static const char *const names[] = {"fire"};
    struct kiln_suite_params params = paths(folder, 1);
    params.shard = params.shards = 4;
    struct kiln_suite *suite = load(&params);
    size_t count = 0;
    const char *const *unused = kiln_suite_unused(suite, &count);
    assert_int_equal(count, 2);
    assert_string_equal(unused[0], "golden/effects/gone");
    assert_string_equal(unused[1], "golden/fir");
    kiln_suite_destroy(&suite);

    static const char *const effects[] = {"scenes/effects"}; /* elsewhere, tests may be */
    params = paths(effects, 1);
    suite = load(&params);
    unused = kiln_suite_unused(suite, &count);
    assert_int_equal(count, 1);
    assert_string_equal(unused[0], "golden/effects/gone");
    kiln_suite_destroy(&suite);
    /* Of a part of the tests, nothing can be said. */
    params = paths(folder, 1);
    params.names = names;
    params.name_count = 1;
    suite = load(&params);
    kiln_suite_unused(suite, &count);
    assert_int_equal(count, 0);
    kiln_suite_destroy(&suite);
    params = paths(file, 1);
    suite = load(&params);
    kiln_suite_unused(suite, &count);
    assert_int_equal(count, 0);
    kiln_suite_destroy(&suite);
}

static void devices_make_tests(void **state)
{
    (void)state;
    test_write_file("a.test.yaml",
                    "kiln_test: 1\nscene: a.yaml\ndevices: [software, NVIDIA H200]\n");
    test_write_file("b.test.yaml", "kiln_test: 1\nscene: a.yaml\ndevices: [software]\n");
    test_write_file("c.test.yaml", "kiln_test: 1\nscene: a.yaml\n");
    struct kiln_suite_params params = paths(here, 1);
    expect_names(&params, "a@nvidia-h200 a@software b c");
    struct kiln_suite *suite = load(&params);
    assert_string_equal(suite->tests[0].device, "NVIDIA H200");
    assert_string_equal(suite->tests[0].golden, "golden/a");
    assert_string_equal(suite->tests[0].results, "out/test/a@nvidia-h200");
    assert_true(suite->tests[0].may_skip && suite->tests[2].may_skip && !suite->tests[3].may_skip);
    assert_string_equal(suite->tests[2].device, "software");
    assert_null(suite->tests[3].device);
    kiln_suite_destroy(&suite);

    /* A name without a device means all of them. */
    static const char *const names[] = {"a"}, *const one[] = {"*@software"};
    params.name_count = 1;
    params.names = names;
    expect_names(&params, "a@nvidia-h200 a@software");
    params.names = one;
    expect_names(&params, "a@software");
}

/* ---- Test files --------------------------------------------------------------------------- */

static const struct kiln_test *load_one(const char *text, struct kiln_suite **suite)
{
    static const char *const file[] = {"x/t.test.yaml"};
    test_write_file(file[0], text);
    struct kiln_suite_params params = paths(file, 1);
    *suite = load(&params);
    assert_int_equal(kiln_suite_count(*suite), 1);
    return &(*suite)->tests[0];
}

static void a_scene_has_the_defaults(void **state)
{
    (void)state;
    test_write_file("t.yaml", scene);
    static const char *const file[] = {"t.yaml"};
    struct kiln_suite_params params = paths(file, 1);
    struct kiln_suite *suite = load(&params);
    const struct kiln_test *test = &suite->tests[0];
    assert_int_equal(test->problem.code, KILN_OK);
    assert_string_equal(test->scene, "t.yaml");
    assert_string_equal(test->about, "");
    assert_int_equal(
        test->override_count + test->frame_count + test->limit_count + test->mask_count, 0);
    assert_int_equal(test->format, KILN_TEST_PNG);
    assert_true(test->warn == 0.5 && test->threshold == 2 && test->window == 32 &&
                test->time_limit_s == 120);
    kiln_suite_destroy(&suite);
}

static void a_test_file_says_all(void **state)
{
    (void)state;
    struct kiln_suite *suite;
    const struct kiln_test *test = load_one("kiln_test: 1\n"
                                            "scene: ../s.yaml\n"
                                            "about: fire & smoke\n"
                                            "set: [post.bloom.kind=none, seed=7]\n"
                                            "size: [320, 180]\n"
                                            "frames: [\"20-22\", 40, 21]\n"
                                            "format: png16\n"
                                            "techniques: [simulate=inplace]\n"
                                            "limits: {flip.mean: 0.02, flip.p99.5: 0.3}\n"
                                            "reason: fast smoke\n"
                                            "warn: 0.25\n"
                                            "threshold: 4\n"
                                            "window: 16\n"
                                            "masks:\n"
                                            "  - {rect: [0, 1, 2, 3], reason: clock}\n"
                                            "  - {picture: m.png}\n"
                                            "time_limit: 2.5 s\n",
                                            &suite);
    assert_string_equal(test->problem.message, "");
    assert_string_equal(test->scene, "x/../s.yaml");
    assert_string_equal(test->about, "fire & smoke");
    assert_int_equal(test->override_count, 3);
    assert_string_equal(test->overrides[1], "seed=7");
    assert_string_equal(test->overrides[2], "output.size=[320, 180]");
    static const uint32_t frames[] = {20, 21, 22, 40};
    assert_int_equal(test->frame_count, 4);
    assert_memory_equal(test->frames, frames, sizeof frames);
    assert_int_equal(test->format, KILN_TEST_PNG16);
    assert_int_equal(test->technique_count, 1);
    assert_string_equal(test->techniques[0], "simulate=inplace");
    assert_int_equal(test->limit_count, 2);
    assert_string_equal(test->limits[1], "flip.p99.5=0.3");
    assert_string_equal(test->limits_reason, "fast smoke");
    assert_true(test->warn == 0.25 && test->threshold == 4 && test->window == 16 &&
                test->time_limit_s == 2.5);
    assert_int_equal(test->mask_count, 2);
    static const uint32_t rect[] = {0, 1, 2, 3};
    assert_memory_equal(test->masks[0].rect, rect, sizeof rect);
    assert_null(test->masks[0].picture);
    assert_string_equal(test->masks[0].reason, "clock");
    assert_string_equal(test->masks[1].picture, "x/m.png");
    kiln_suite_destroy(&suite);
}

#define START "kiln_test: 1\nscene: s.yaml\n"

static const struct {
    const char *text, *message;
} wrong_files[] = {
    {"", ": the file is empty; a test starts with 'kiln_test: 1'"},
    {"- 1\n", ":1:1: expected a mapping of keys, found a list"},
    {"scene: a.yaml\n", ":1:1: kiln_test: the key is missing and must be given"},
    {"kiln_test: 1\n", ":1:1: scene: the key is missing and must be given"},
    {"kiln_test: 2\nscene: s.yaml\n", ":1:12: kiln_test: 2 is out of range; allowed is 1"},
    {START "frame: 3\n", ":3:1: frame: unknown key (did you mean 'frames'?)"},
    {START "scene: b.yaml\n", ":3:1: duplicate key 'scene' (first in line 2)"},
    {START "---\nscene: b.yaml\n", ":3:1: a test has one document; a second one starts here"},
    {START "about: &a x\n", ":3:11: anchors and aliases are not allowed"},
    {"kiln_test: 1\nscene: \"\"\n", ":2:8: scene: must not be empty"},
    {"kiln_test: 1\nscene: [a]\n", ":2:8: scene: expected a text, found a list"},
    {START "golden: hash\nlimits: {psnr: 30}\n",
     ":3:9: golden: hash keeps no picture, so limits and masks are not allowed"},
    {START "set: [seed]\n", ":3:7: set.0: expected key=value, as for --set, found 'seed'"},
    {START "size: [320]\n", ":3:7: size: expected [width, height], each from 16 px to 16384 "
                            "px, or scene, found a list"},
    {START "size: [8, 180]\n", ":3:8: size: 8 is out of range; allowed is from 16 px to 16384 px"},
    {START "frames: 4-2\n", ":3:9: frames: expected up to 1000 frames as [24, 96] or "
                            "\"0-23,40\", or auto, found '4-2'"},
    {START "frames: [1, 1000000]\n", ":3:13: frames: expected up to 1000 frames as [24, 96] or "
                                     "\"0-23,40\", or auto, found '1000000'"},
    {START "frames: []\n", ":3:9: frames: expected up to 1000 frames as [24, 96] or "
                           "\"0-23,40\", or auto, found a list"},
    {START "frames: 0-1000\n", ":3:9: frames: more than 1000 frames; no more are allowed"},
    {START "format: pgn\n", ":3:9: format: unknown word 'pgn' (did you mean 'png'?)"},
    {START "devices: ['()']\n", ":3:11: devices.0: expected software, a part of a device's "
                                "name, or its number, found the text \"()\""},
    {START "devices: [H 200, h-200]\n", ":3:10: devices: 'h-200' is given twice"},
    {START "techniques: [simulat=cpu]\n",
     ":3:14: techniques.0: stage 'simulat' is not known (did you mean 'simulate'?); allowed are "
     "simulate, gas, sort, backdrop, march, raster, bloom, composite"},
    {START "techniques: [cpu]\n", ":3:14: techniques.0: technique 'cpu': expected stage=name"},
    {START "limits: {flip.mena: 0.1}\n",
     ":3:10: limits.flip.mena: unknown metric 'flip.mena' (did you mean 'flip.mean'?)"},
    {START "limits: {flip.mean: -1}\n", ":3:10: limits.flip.mean: expected a number, 0 to 1"},
    {START "limits: {flip.mean: '0.1,flip.p99=1'}\n",
     ":3:21: limits.flip.mean: expected {metric: number, ...}, as 'kiln help metrics' lists "
     "them, found the text \"0.1,flip.p99=1\""},
    {START "warn: 2\n", ":3:7: warn: 2 is out of range; allowed is from 0 to 1"},
    {START "window: 0\n", ":3:9: window: 0 is out of range; allowed is from 1 to 16384"},
    {START "masks: [{reason: x}]\n",
     ":3:9: masks.0: expected either rect or picture, found neither"},
    {START "masks: [{rect: [0, 0, 1, 1], picture: a.png}]\n",
     ":3:9: masks.0: expected either rect or picture, found both"},
    {START "masks: [{rect: [0, 0, 0, 1]}]\n",
     ":3:23: masks.0.rect: the rectangle has no area; both edges must be above 0"},
    {START "time_limit: 9 m\n", ":3:13: time_limit: unit 'm' is wrong; allowed is s, ms, min or h"},
};

static void wrong_test_files_say_where(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong_files / sizeof *wrong_files; i++) {
        struct kiln_suite *suite;
        const struct kiln_test *test = load_one(wrong_files[i].text, &suite);
        expect_error(&test->problem, KILN_INVALID_INPUT, "x/t.test.yaml%s", wrong_files[i].message);
        assert_string_equal(test->name, "x/t");
        assert_true(test->time_limit_s > 0);
        kiln_suite_destroy(&suite);
    }
}

static void test_files_that_cannot_be_read(void **state)
{
    (void)state;
    assert_int_equal(mkfifo("b.test.yaml", 0666), 0);
    FILE *file = fopen("c.test.yaml", "wb");
    assert_non_null(file);
    assert_int_equal(ftruncate(fileno(file), 1 << 30), 0);
    fclose(file);
    static const char *const files[] = {"b.test.yaml", "c.test.yaml"};
    struct kiln_suite_params params = paths(files, 2);
    struct kiln_suite *suite = load(&params);
    expect_error(&suite->tests[0].problem, KILN_INVALID_INPUT,
                 "b.test.yaml: the path is not a regular file");
    expect_error(&suite->tests[1].problem, KILN_INVALID_INPUT,
                 "c.test.yaml: the file has 1073741824 bytes; a test file has at most 1048576");
    kiln_suite_destroy(&suite);
}

static void the_reference_names_every_key(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(kiln_test_write_reference(out));
    fclose(out);
    static const char *const keys[] = {
        "kiln_test", "scene",        "about",           "set",       "size", "frames",    "format",
        "devices",   "techniques",   "limits",          "reason",    "warn", "threshold", "window",
        "masks",     "masks.N.rect", "masks.N.picture", "time_limit"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        char line[64];
        snprintf(line, sizeof line, "\n%s\n    ", keys[i]);
        if (!strstr(text, line))
            fail_msg("%s is not in the reference", keys[i]);
    }
    free(text);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(folders_are_searched),
        IN_FOLDER(paths_lead_from_the_test_file),
        IN_FOLDER(files_are_found_once),
        IN_FOLDER(scenes_with_faults_are_not_passed_over),
        IN_FOLDER(operands_that_are_no_tests),
        IN_FOLDER(two_tests_of_one_name),
        IN_FOLDER(odd_names_are_errors_of_their_tests),
        IN_FOLDER(letters_of_any_script_name_tests),
        IN_FOLDER(names_are_chosen),
        IN_FOLDER(shards_share_the_tests),
        IN_FOLDER(goldens_of_no_test_are_found),
        IN_FOLDER(devices_make_tests),
        IN_FOLDER(a_scene_has_the_defaults),
        IN_FOLDER(a_test_file_says_all),
        IN_FOLDER(wrong_test_files_say_where),
        IN_FOLDER(test_files_that_cannot_be_read),
        cmocka_unit_test(the_reference_names_every_key),
    };
    return cmocka_run_group_tests_name("suite", tests, NULL, NULL);
}
