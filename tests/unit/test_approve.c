/* kiln_test_approve: the pictures of a run become goldens, and only of the run that they are of. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene/work.h"
#include "suite/golden.h"
#include "suite/suite.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/pictures.h"

static const char scene[] = "kiln: 1\noutput: {frames: 4}\n";
static const char device[] = "llvmpipe-llvm-15.0.6-256-bits";

/* The result of a run of fire.test.yaml: frame 1 is new, frame 2 passes, frame 3 fails. */
struct run {
    struct kiln_result result;
    struct kiln_result_frame frames[3];
    char pixels[3][65], scene_hash[65];
};

static void hash(const char *path, char hex[65])
{
    struct kiln_error error = {0};
    if (!kiln_pixel_hash(path, hex, &error))
        fail_msg("%s", error.message);
}

static void copy(const char *from, const char *to)
{
    struct kiln_error error = {0};
    if (!kiln_file_copy(from, to, &error))
        fail_msg("%s", error.message);
}

static void write_result(const struct run *run)
{
    struct kiln_error error = {0};
    char folder[64];
    snprintf(folder, sizeof folder, "out/test/%s", run->result.name);
    if (!kiln_result_write(&run->result, folder, &error))
        fail_msg("%s", error.message);
}

static void take_frame(struct run *run, size_t index, enum kiln_test_status status,
                       enum kiln_judged_by judged_by)
{
    static char names[3][32], goldens[3][64];
    struct kiln_result_frame *frame = &run->frames[index];
    char path[64];
    kiln_result_frame_init(frame, (uint32_t)index + 1);
    snprintf(names[index], sizeof names[index], "frame_%04u.png", frame->number);
    snprintf(goldens[index], sizeof goldens[index], "golden/fire/frame_%04u.png", frame->number);
    snprintf(path, sizeof path, "out/test/fire/%s", names[index]);
    hash(path, run->pixels[index]);
    frame->status = status;
    frame->judged_by = judged_by;
    frame->picture = names[index];
    frame->golden = goldens[index];
    frame->state = "13e7be772847a38f";
    frame->pixels = run->pixels[index];
    frame->message = status == KILN_TEST_PASS ? "" : "why";
}

static struct run *make_run(void)
{
    static struct run run;
    test_write_file("s.yaml", scene);
    test_write_file("fire.test.yaml",
                    "kiln_test: 1\nscene: s.yaml\nset: [seed=7]\nframes: [1, 2, 3]\n");
    const struct kiln_frame_range range = {1, 3};
    struct kiln_output_params output = test_output_params("out/test/fire/frame_####.png", &range);
    struct kiln_error error = {0};
    output.overwrite = true;
    assert_true(test_write_all(&output, &error));
    unlink("golden/fire/frame_0001.png");
    copy("out/test/fire/frame_0002.png", "golden/fire/frame_0002.png");
    copy("out/test/fire/frame_0001.png", "golden/fire/frame_0003.png");
    copy("golden/fire/frame_0003.png", "out/test/fire/frame_0003_reference.png");
    test_write_file("golden/fire/expect.yaml",
                    "kiln_expect: 1\nwarn: 0.25\nframes: {2: {state: aaaaaaaaaaaaaaaa}}\n");

    static const char *const overrides[] = {"seed=7"};
    const struct kiln_scene_params params = {
        .size = sizeof params, .overrides = overrides, .override_count = 1};
    struct kiln_scene *loaded = kiln_scene_load("s.yaml", &params, &error);
    assert_non_null(loaded);
    memcpy(run.scene_hash, kiln_scene_facts(loaded).hash, sizeof run.scene_hash);
    kiln_scene_destroy(&loaded);
    take_frame(&run, 0, KILN_TEST_NEW, KILN_JUDGED_BY_NOTHING);
    take_frame(&run, 1, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
    take_frame(&run, 2, KILN_TEST_FAIL, KILN_JUDGED_BY_METRICS);
    run.frames[2].reference = "frame_0003_reference.png";
    kiln_result_init(&run.result, "fire");
    run.result.test = "fire.test.yaml";
    run.result.scene = "s.yaml";
    run.result.golden = "golden/fire";
    run.result.status = KILN_TEST_FAIL;
    run.result.code = KILN_FRAME_FAILED;
    run.result.device_name = device;
    run.result.techniques = "simulate=cpu sort=cpu";
    run.result.scene_hash = run.scene_hash;
    run.result.rerun = "kiln test fire.test.yaml";
    run.result.frames = run.frames;
    run.result.frame_count = 3;
    write_result(&run);
    return &run;
}

static void note(void *user, const char *line)
{
    char *lines = user;
    size_t length = strlen(lines);
    snprintf(lines + length, 1024 - length, "%s\n", line);
}

/* The suite of fire.test.yaml, with its goldens in golden and these results. */
static struct kiln_suite *load_suite(const char *results)
{
    static const char *const paths[] = {"fire.test.yaml"};
    struct kiln_suite_params params = kiln_suite_defaults();
    struct kiln_error error = {0};
    params.paths = paths;
    params.path_count = 1;
    params.results = results;
    struct kiln_suite *suite = kiln_suite_load(&params, &error);
    if (!suite)
        fail_msg("%s", error.message);
    return suite;
}

static bool approve(enum kiln_approve_as as, bool dry_run, char lines[1024],
                    struct kiln_error *error)
{
    *lines = '\0';
    struct kiln_suite *suite = load_suite("out/test");
    const struct kiln_approve_params params = {.suite = suite,
                                               .name = "fire",
                                               .as = as,
                                               .dry_run = dry_run,
                                               .change = note,
                                               .user = lines};
    const bool ok = kiln_test_approve(&params, error);
    kiln_suite_destroy(&suite);
    return ok;
}

static void expect_lines(enum kiln_approve_as as, bool dry_run, const char *expected)
{
    char lines[1024];
    struct kiln_error error = {0};
    if (!approve(as, dry_run, lines, &error))
        fail_msg("%s", error.message);
    assert_string_equal(lines, expected);
}

/* Nothing may be written before the refusal. */
static void expect_refusal(const char *message, enum kiln_code code)
{
    char lines[1024], before[65], after[65];
    struct kiln_error error = {0};
    hash("golden/fire/frame_0003.png", before);
    assert_false(approve(KILN_APPROVE_REPLACE, false, lines, &error));
    expect_error(&error, code, "%s", message);
    assert_string_equal(lines, "");
    hash("golden/fire/frame_0003.png", after);
    assert_string_equal(before, after);
    assert_int_equal(access("golden/fire/scene.yaml", F_OK), -1);
}

static void expect_same(const char *a, const char *b)
{
    char x[65], y[65];
    hash(a, x);
    hash(b, y);
    assert_string_equal(x, y);
}

/* ---- What is written ---------------------------------------------------------------------- */

static void what_failed_and_is_new_becomes_golden(void **state)
{
    (void)state;
    struct run *run = make_run();
    struct stat before, after;
    assert_int_equal(stat("golden/fire/frame_0002.png", &before), 0);
    expect_lines(KILN_APPROVE_REPLACE, true,
                 "would write golden/fire/frame_0001.png\n"
                 "would write golden/fire/frame_0003.png\n"
                 "would write golden/fire/scene.yaml\n"
                 "would write golden/fire/expect.yaml\n");
    assert_int_equal(access("golden/fire/frame_0001.png", F_OK), -1);
    expect_same("golden/fire/frame_0003.png", "out/test/fire/frame_0001.png");

    expect_lines(KILN_APPROVE_REPLACE, false,
                 "wrote golden/fire/frame_0001.png\n"
                 "wrote golden/fire/frame_0003.png\n"
                 "wrote golden/fire/scene.yaml\n"
                 "wrote golden/fire/expect.yaml\n");
    expect_same("golden/fire/frame_0001.png", "out/test/fire/frame_0001.png");
    expect_same("golden/fire/frame_0003.png", "out/test/fire/frame_0003.png");
    assert_int_equal(stat("golden/fire/frame_0002.png", &after), 0);
    assert_int_equal(before.st_ino, after.st_ino);

    char *text = test_read_file("golden/fire/expect.yaml");
    char expected[2048];
    snprintf(expected, sizeof expected,
             "# Written by kiln test, and rewritten by it: comments are not kept.\n"
             "kiln_expect: 1\n"
             "scene_hash: \"%s\"\n"
             "techniques: [\"simulate=cpu\", \"sort=cpu\"]\n"
             "warn: 0.25\n"
             "frames:\n"
             "  1:\n"
             "    state: \"13e7be772847a38f\"\n"
             "    pixels:\n"
             "      %s: {hash: \"%s\", golden: \"%s\"}\n"
             "  2:\n"
             "    state: \"aaaaaaaaaaaaaaaa\"\n"
             "  3:\n"
             "    state: \"13e7be772847a38f\"\n"
             "    pixels:\n"
             "      %s: {hash: \"%s\", golden: \"%s\"}\n",
             run->scene_hash, device, run->pixels[0], run->pixels[0], device, run->pixels[2],
             run->pixels[2]);
    assert_string_equal(text, expected);
    free(text);

    /* The accepted scene is the one that was rendered: it has the test's override. */
    char *accepted = test_read_file("golden/fire/scene.yaml");
    assert_non_null(strstr(accepted, "\nseed: 7\n"));
    free(accepted);

    /* Again, the same comes out. */
    expect_lines(KILN_APPROVE_REPLACE, false,
                 "wrote golden/fire/frame_0001.png\n"
                 "wrote golden/fire/frame_0003.png\n"
                 "wrote golden/fire/scene.yaml\n"
                 "wrote golden/fire/expect.yaml\n");
}

static void pictures_are_accepted_beside_others(void **state)
{
    (void)state;
    make_run();
    static const char two[] = "wrote golden/fire/frame_0001.png\n"
                              "wrote golden/fire/frame_0003~2.png\n"
                              "wrote golden/fire/scene.yaml\n"
                              "wrote golden/fire/expect.yaml\n";
    expect_lines(KILN_APPROVE_ALTERNATIVE, false, two);
    expect_same("golden/fire/frame_0003~2.png", "out/test/fire/frame_0003.png");
    expect_same("golden/fire/frame_0003.png", "out/test/fire/frame_0001.png");
    expect_lines(KILN_APPROVE_ALTERNATIVE, false, two);
    assert_int_equal(access("golden/fire/frame_0003~3.png", F_OK), -1);
}

static void pictures_are_accepted_for_a_device(void **state)
{
    (void)state;
    make_run();
    expect_lines(KILN_APPROVE_DEVICE, false,
                 "wrote golden/fire/frame_0001@llvmpipe-llvm-15.0.6-256-bits.png\n"
                 "wrote golden/fire/frame_0003@llvmpipe-llvm-15.0.6-256-bits.png\n"
                 "wrote golden/fire/scene.yaml\n"
                 "wrote golden/fire/expect.yaml\n");
    assert_int_equal(access("golden/fire/frame_0001.png", F_OK), -1);
    expect_same("golden/fire/frame_0003.png", "out/test/fire/frame_0001.png");
}

static void nothing_is_done_where_all_passes(void **state)
{
    (void)state;
    struct run *run = make_run();
    run->frames[0].status = run->frames[2].status = KILN_TEST_PASS;
    run->result.status = KILN_TEST_PASS;
    run->result.code = KILN_OK;
    write_result(run);
    /* But the scene has changed: that is accepted, and no picture. */
    expect_lines(KILN_APPROVE_REPLACE, false,
                 "wrote golden/fire/scene.yaml\nwrote golden/fire/expect.yaml\n");
    expect_lines(KILN_APPROVE_REPLACE, false, "");
    assert_int_equal(access("golden/fire/frame_0001.png", F_OK), -1);
}

/* ---- What is refused ---------------------------------------------------------------------- */

static void names_are_of_results(void **state)
{
    (void)state;
    make_run();
    struct kiln_error error = {0};
    struct kiln_suite *suite = load_suite("out/test");
    struct kiln_approve_params params = {.suite = suite, .name = "fier"};
    assert_false(kiln_test_approve(&params, &error));
    expect_error(&error, KILN_USAGE,
                 "no result of a test 'fier' in out/test (did you mean 'fire'?)");
    params.name = "../test/fire";
    assert_false(kiln_test_approve(&params, &error));
    expect_error(&error, KILN_USAGE, "no result of a test '../test/fire' in out/test");

    test_write_file("out/test/fire/result.json", "{\n");
    params.name = "fire";
    assert_false(kiln_test_approve(&params, &error));
    expect_error_around(&error, KILN_INVALID_INPUT, "",
                        "out/test/fire/result.json:2:1: not valid YAML: "); /* libfyaml says why */
    kiln_suite_destroy(&suite);

    suite = load_suite("gone");
    params = (struct kiln_approve_params){.suite = suite, .name = "fire"};
    assert_false(kiln_test_approve(&params, &error));
    expect_error(&error, KILN_USAGE, "no result of a test 'fire' in gone");
    kiln_suite_destroy(&suite);
}

/* The result is foreign: the suite alone says what the test is and where its goldens are. */
static void results_of_other_places_are_refused(void **state)
{
    (void)state;
    struct run *run = make_run();
    run->result.golden = "elsewhere/fire";
    run->frames[0].golden = "elsewhere/fire/frame_0001.png";
    write_result(run);
    expect_refusal("fire: the result names the goldens 'elsewhere/fire', but the test has "
                   "'golden/fire': approve where the test was run, with the same --golden",
                   KILN_INVALID_INPUT);
    run->result.golden = "golden/fire";
    run->result.test = "other/fire.test.yaml";
    run->result.rerun = "";
    write_result(run);
    expect_refusal("fire: the result names the file 'other/fire.test.yaml', but the test has "
                   "'fire.test.yaml': approve where the test was run",
                   KILN_INVALID_INPUT);
    run->result.test = "./fire.test.yaml";
    run->result.golden = "golden//./fire";
    run->frames[0].golden = "./golden/fire/frame_0001.png";
    write_result(run);
    expect_lines(KILN_APPROVE_REPLACE, true,
                 "would write golden/fire/frame_0001.png\n"
                 "would write golden/fire/frame_0003.png\n"
                 "would write golden/fire/scene.yaml\n"
                 "would write golden/fire/expect.yaml\n");
    run->result.name = "smoke";
    write_result(run);
    struct kiln_suite *suite = load_suite("out/test");
    const struct kiln_approve_params params = {.suite = suite, .name = "smoke"};
    struct kiln_error error = {0};
    assert_false(kiln_test_approve(&params, &error));
    expect_error(&error, KILN_USAGE,
                 "smoke: there is a result, but no such test where tests are looked for; give the "
                 "test's file or folder, too: kiln test approve smoke FILE");
    kiln_suite_destroy(&suite);
}

static void what_has_changed_since_is_refused(void **state)
{
    (void)state;
    make_run();
    test_write_file("fire.test.yaml", "kiln_test: 1\nscene: s.yaml\nset: [seed=8]\n");
    expect_refusal("fire: the scene has changed since the run; run it again: kiln test "
                   "fire.test.yaml",
                   KILN_INVALID_INPUT);
    test_write_file("fire.test.yaml",
                    "kiln_test: 1\nscene: s.yaml\nset: [seed=7]\nframes: [1, 2, 3]\nformat: exr\n");
    expect_refusal("fire: the test's format has changed since the run; run it again: kiln test "
                   "fire.test.yaml",
                   KILN_INVALID_INPUT);
    static const char *const others[] = {"[1, 2]", "[0, 1, 2, 3]", "[0, 2, 3]", "auto"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char text[128];
        snprintf(text, sizeof text, "kiln_test: 1\nscene: s.yaml\nset: [seed=7]\nframes: %s\n",
                 others[i]);
        test_write_file("fire.test.yaml", text);
        expect_refusal("fire: the test's frames have changed since the run; run it again: kiln "
                       "test fire.test.yaml",
                       KILN_INVALID_INPUT);
    }
    test_write_file("fire.test.yaml", "kiln_test: 1\nscene: s.yaml\nset: [sed=7]\n");
    expect_refusal("--set sed: unknown key (did you mean 'seed'?)", KILN_INVALID_INPUT);
    test_write_file("fire.test.yaml", "kiln_test: 1\n");
    expect_refusal("fire.test.yaml:1:1: scene: the key is missing and must be given",
                   KILN_INVALID_INPUT);
    test_write_file("fire.test.yaml",
                    "kiln_test: 1\nscene: s.yaml\nset: [seed=7]\nframes: [1, 2, 3]\n");

    copy("out/test/fire/frame_0001.png", "out/test/fire/frame_0003.png");
    expect_refusal(
        "out/test/fire/frame_0003.png: the file is not the picture that was judged: its pixels "
        "have changed since the run",
        KILN_INVALID_INPUT);
    assert_int_equal(unlink("out/test/fire/frame_0003.png"), 0);
    expect_refusal("out/test/fire/frame_0003.png: the image cannot be opened: No such file "
                   "or directory",
                   KILN_IO);

    make_run();
    /* Another's picture took the place of the golden, or came where there was none. */
    static const char changed[] = "fire: its goldens have changed since the run; run it again: "
                                  "kiln test fire.test.yaml";
    copy("out/test/fire/frame_0002.png", "golden/fire/frame_0003.png");
    expect_refusal(changed, KILN_INVALID_INPUT);
    struct run *run = make_run();
    copy("out/test/fire/frame_0002.png", "golden/fire/frame_0001.png");
    expect_refusal(changed, KILN_INVALID_INPUT);
    assert_int_equal(unlink("golden/fire/frame_0001.png"), 0);
    run->frames[2].golden = "s.yaml";
    write_result(run);
    expect_refusal(changed, KILN_INVALID_INPUT);
    make_run();
    test_write_file("golden/fire/expect.yaml", "kiln_expect: 1\nframe: 1\n");
    expect_refusal("golden/fire/expect.yaml:2:1: frame: unknown key (did you mean 'frames'?)",
                   KILN_INVALID_INPUT);
}

static void results_without_a_verdict_are_refused(void **state)
{
    (void)state;
    struct run *run = make_run();
    run->result.status = KILN_TEST_ERROR;
    run->result.code = KILN_DEVICE_FAILED;
    run->result.message = "crashed: signal 11 (Segmentation fault)";
    write_result(run);
    expect_refusal("fire: the test ended with an error, so nothing can be accepted: crashed: "
                   "signal 11 (Segmentation fault)",
                   KILN_INVALID_INPUT);
    run->result.status = KILN_TEST_SKIP;
    run->result.code = KILN_OK;
    write_result(run);
    expect_refusal(
        "fire: the test was skipped and has no pictures; run it again: kiln test fire.test.yaml",
        KILN_INVALID_INPUT);

    run = make_run();
    run->frames[2].judged_by = KILN_JUDGED_BY_NOTHING;
    run->frames[2].message = "render 2 of 3 differs from the first";
    write_result(run);
    expect_refusal("fire: cannot be accepted: render 2 of 3 differs from the first",
                   KILN_INVALID_INPUT);

    run = make_run();
    run->result.golden = "golden/smoke";
    write_result(run);
    expect_refusal("fire: the result names the goldens 'golden/smoke', but the test has "
                   "'golden/fire': approve where the test was run, with the same --golden",
                   KILN_INVALID_INPUT);
    run->result.golden = "golden/fire";
    run->result.device_name = "llvmpipe (LLVM)";
    write_result(run);
    expect_refusal("out/test/fire/result.json: 'llvmpipe (LLVM)' is not a device's name",
                   KILN_INVALID_INPUT);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(what_failed_and_is_new_becomes_golden),
        IN_FOLDER(pictures_are_accepted_beside_others),
        IN_FOLDER(pictures_are_accepted_for_a_device),
        IN_FOLDER(nothing_is_done_where_all_passes),
        IN_FOLDER(names_are_of_results),
        IN_FOLDER(results_of_other_places_are_refused),
        IN_FOLDER(what_has_changed_since_is_refused),
        IN_FOLDER(results_without_a_verdict_are_refused),
    };
    return cmocka_run_group_tests_name("approve", tests, NULL, NULL);
}
