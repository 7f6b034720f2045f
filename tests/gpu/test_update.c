/* Checks which golden pictures and accepted hashes `kiln test --update` writes, and which it leaves
 * as they are. Also checks that repeated renders must be equal, and which notes (warnings) a test
 * gets. If this fails, an update replaces goldens that should stay, or a test that hardly judges
 * anything passes without a note. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "suite/golden.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/suite.h"

#define EXPECT        "golden/spark/expect.yaml"
#define SECOND_GOLDEN "golden/spark/frame_0005.png"

/* Holds a file's inode, times and bytes. Another inode or time tells later that the file was
 * written again, even with the same bytes. */
struct file_state {
    struct stat status;
    char *bytes;
};

static struct file_state file_state(const char *path)
{
    struct file_state file;
    if (stat(path, &file.status) != 0)
        fail_msg("%s does not exist", path);
    file.bytes = test_read_file(path);
    return file;
}

/* Returns whether a file was not written since `before` was taken, and frees `before`. */
static bool is_untouched(const char *path, struct file_state *before)
{
    struct file_state now = file_state(path);
    bool same = now.status.st_ino == before->status.st_ino &&
                now.status.st_mtim.tv_nsec == before->status.st_mtim.tv_nsec &&
                now.status.st_size == before->status.st_size;
    free(now.bytes);
    free(before->bytes);
    return same;
}

static struct spark_run run_update(enum kiln_update update, bool dry_run)
{
    struct kiln_test_params params = spark_params();
    params.update = update;
    params.dry_run = dry_run;
    struct spark_run run = spark_run(&params);
    assert_true(run.ok);
    return run;
}

static void a_dry_run_writes_nothing(void **state)
{
    (void)state;
    spark_write("");
    struct spark_run run = run_update(KILN_UPDATE_ALL, true);
    assert_int_equal(run.summary.status, KILN_TEST_NEW);
    assert_true(spark_has_note(&run, "would write " SPARK_GOLDEN));
    assert_true(spark_has_note(&run, "would write " SECOND_GOLDEN));
    assert_int_equal(run.summary.notes, 2);
    assert_int_equal(access("golden", F_OK), -1);
    spark_end(&run);
}

static void update_missing_writes_missing_goldens_only(void **state)
{
    (void)state;
    spark_write("");
    struct spark_run run = run_update(KILN_UPDATE_MISSING, false);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_string_equal(run.result->frames[0].message, "written");
    assert_true(spark_has_note(&run, "wrote " SPARK_GOLDEN));
    spark_end(&run);
    assert_int_equal(access("golden/spark/scene.yaml", R_OK), 0);

    assert_int_equal(unlink(SPARK_GOLDEN), 0);
    spark_paint(SECOND_GOLDEN, 2, 2, 8, 8, 120);
    struct file_state second = file_state(SECOND_GOLDEN);
    run = run_update(KILN_UPDATE_MISSING, false);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_int_equal(run.result->frames[0].status, KILN_TEST_PASS);
    assert_true(is_untouched(SECOND_GOLDEN, &second));
    assert_int_equal(access(SPARK_GOLDEN, R_OK), 0);
    spark_end(&run);
}

/* Adds hashes that were accepted on another device to expect.yaml, and returns their text. */
static const char *add_other_device(void)
{
    static const char entry[] =
        "other-9: {hash: \"1111111111111111111111111111111111111111111111111111111111111111\", "
        "golden: \"2222222222222222222222222222222222222222222222222222222222222222\"}";
    char text[512];
    snprintf(text, sizeof text, "pixels:\n      %s\n", entry);
    spark_replace(EXPECT, "pixels:\n", text);
    return entry;
}

static void update_failed_leaves_passing_frames_and_other_devices(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    const char *entry = add_other_device();
    assert_true(kiln_file_copy(SECOND_GOLDEN, "golden/spark/frame_0003@other-9.png", &error));
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    struct file_state second = file_state(SECOND_GOLDEN);
    struct file_state other = file_state("golden/spark/frame_0003@other-9.png");
    struct spark_run run = run_update(KILN_UPDATE_FAILED, true);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_true(spark_has_note(&run, "would write " SPARK_GOLDEN));
    spark_end(&run);

    run = run_update(KILN_UPDATE_FAILED, false);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_int_equal(run.summary.notes, 1);
    spark_end(&run);
    assert_true(is_untouched(SECOND_GOLDEN, &second));
    assert_true(is_untouched("golden/spark/frame_0003@other-9.png", &other));
    char *expect = test_read_file(EXPECT);
    assert_non_null(strstr(expect, entry));
    free(expect);
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
}

static void update_all_alone_replaces_goldens_that_pass_by_metrics(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_paint(SPARK_GOLDEN, 2, 2, 1, 1, 1);
    struct file_state first = file_state(SPARK_GOLDEN), second = file_state(SECOND_GOLDEN);
    struct file_state expect = file_state(EXPECT);
    spark_update(KILN_UPDATE_FAILED);
    assert_true(is_untouched(SPARK_GOLDEN, &first));
    assert_true(is_untouched(EXPECT, &expect));
    spark_update(KILN_UPDATE_ALL);
    assert_true(is_untouched(SECOND_GOLDEN, &second));
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
}

/* On a device without accepted hashes, equal pixels must pass by metrics. `--update all` must
 * accept the hashes of this device, and write no golden. To imitate a new device, the test gives
 * the accepted hashes the name of another device. */
static void update_all_accepts_equal_pixels_of_a_new_device(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    struct spark_run run = spark_run(NULL);
    char key[80];
    snprintf(key, sizeof key, "%s: {", run.result->device_name);
    for (size_t i = 0; i < 2; i++)
        spark_replace(EXPECT, key, "elsewhere: {");
    spark_end(&run);
    struct file_state first = file_state(SPARK_GOLDEN);
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_METRICS);
    run = run_update(KILN_UPDATE_ALL, false);
    assert_true(
        spark_has_note(&run, "accepted the hashes of frame 3 on %s", run.result->device_name));
    spark_end(&run);
    assert_true(is_untouched(SPARK_GOLDEN, &first));
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
    char *expect = test_read_file(EXPECT);
    assert_non_null(strstr(expect, "elsewhere"));
    free(expect);
}

static void update_failed_accepts_a_changed_state(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_replace("spark.yaml", "seed: 7", "seed: 8");
    struct spark_run run = run_update(KILN_UPDATE_MISSING, false);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    spark_end(&run);
    spark_update(KILN_UPDATE_FAILED);
    run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_int_equal(run.result->change_count, 0);
    assert_int_equal(run.summary.notes, 0);
    spark_end(&run);
}

/* A test whose scene has changed and looks the same must pass with a note. `--update all` must
 * accept the scene's text. */
static void update_all_accepts_a_scene_that_looks_the_same(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_write("set: [output.frames=7]\n");
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(spark_has_note(&run, "the scene has changed in 1 key, and the test passes"));
    spark_end(&run);
    run = run_update(KILN_UPDATE_ALL, true);
    assert_true(spark_has_note(&run, "would write golden/spark/scene.yaml"));
    spark_end(&run);
    spark_update(KILN_UPDATE_ALL);
    assert_int_equal(spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS), 0);
}

static void update_failed_replaces_broken_goldens(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    test_write_file(SPARK_GOLDEN, "no picture");
    struct file_state first = file_state(SPARK_GOLDEN), second = file_state(SECOND_GOLDEN);
    struct spark_run run = run_update(KILN_UPDATE_MISSING, false);
    assert_int_equal(run.summary.status, KILN_TEST_ERROR);
    expect_message(
        run.summary.message,
        "frame 3: golden/spark/frame_0003.png: the file is not an image: it starts with "
        "the bytes 6e 6f 20 70; allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files; "
        "--update failed replaces it");
    spark_end(&run);
    assert_true(is_untouched(SPARK_GOLDEN, &first));
    run = run_update(KILN_UPDATE_FAILED, true);
    assert_int_equal(run.summary.status, KILN_TEST_ERROR);
    assert_true(spark_has_note(&run, "would write " SPARK_GOLDEN));
    spark_end(&run);
    spark_update(KILN_UPDATE_FAILED);
    assert_true(is_untouched(SECOND_GOLDEN, &second));
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
}

/* ---- Repeats ------------------------------------------------------------------------------ */

/* A stop callback that never stops the run. When it is first called, after the scene file was read,
 * it changes the seed in the file. */
static bool change_scene(void *user)
{
    bool *changed = user;
    if (!*changed)
        spark_replace("spark.yaml", "seed: 7", "seed: 8");
    *changed = true;
    return false;
}

static void repeats_must_have_the_same_hashes(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    struct kiln_test_params params = spark_params();
    params.repeat = 3;
    spark_expect(&params, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
    assert_int_equal(access("out/test/spark/frame_0003_render2.png", F_OK), -1);

    bool changed = false;
    params.stop = change_scene;
    params.user = &changed;
    params.update = KILN_UPDATE_ALL;
    struct file_state first = file_state(SPARK_GOLDEN);
    struct spark_run run = spark_run(&params);
    assert_true(run.ok);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_int_equal(access("out/test/spark/frame_0003_render2.png", R_OK), 0);
    assert_true(is_untouched(SPARK_GOLDEN, &first));
    /* Finds the state that the second render must have, with seed 8. */
    struct spark_run other = spark_run(NULL);
    expect_message(run.summary.message,
                   "render 2 of 3 differs from the first: frame 3 has the state %s, not %s",
                   other.result->frames[0].state, run.result->frames[0].state);
    spark_end(&other);
    spark_end(&run);
}

static bool stop_at_once(void *user)
{
    (void)user;
    return true;
}

static void a_stopped_run_has_no_result(void **state)
{
    (void)state;
    spark_write("");
    struct kiln_test_params params = spark_params();
    params.stop = stop_at_once;
    struct spark_run run = spark_run(&params);
    assert_false(run.ok);
    expect_error(&run.error, KILN_INTERRUPTED, "stopped");
    assert_int_equal(access("out/test/spark/result.json", F_OK), -1);
    spark_end(&run);
}

/* ---- Notes and crashes ---------------------------------------------------------------------- */

/* Settings that make a test judge less must give a note, unless the test gives a reason. Masks that
 * leave little of the picture must give a note in any case. */
static void settings_that_judge_less_are_noted(void **state)
{
    (void)state;
    static const char loose[] = "limits: {psnr: 0}\nthreshold: 255\nwindow: 4000\n"
                                "masks: [{rect: [0, 0, 48, 30], reason: clock}]\n";
    char text[256];
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_write(loose);
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(spark_has_note(
        &run,
        "flip.mean has no limit, although its default limit is 0.01, and no reason is given"));
    assert_true(spark_has_note(
        &run,
        "window.share has no limit, although its default limit is 0.1, and no reason is given"));
    assert_true(spark_has_note(
        &run, "threshold 255 is above the default threshold, 2, and no reason is given"));
    assert_true(spark_has_note(
        &run, "window 4000 is above the default window, 32, and no reason is given"));
    assert_true(spark_has_note(&run, "the masks leave only 6.2 %% of the picture to judge"));
    spark_end(&run);
    snprintf(text, sizeof text, "%sreason: fog\n", loose);
    spark_write(text);
    assert_int_equal(spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS), 1);
}

static void goldens_of_no_frame_are_noted(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    assert_true(kiln_file_copy(SPARK_GOLDEN, "golden/spark/frame_0003@nvidia.png", &error));
    assert_int_equal(spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS), 0);
    spark_replace("spark.test.yaml", "[3, 5]", "[3]");
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(
        spark_has_note(&run, SECOND_GOLDEN " is a golden of a frame that the test does not have"));
    spark_end(&run);
    assert_true(kiln_file_copy(SPARK_GOLDEN, "golden/spark/frame_3.png", &error));
    run = spark_run(NULL);
    assert_true(spark_has_note(&run, SECOND_GOLDEN
                               " and 1 more are goldens of frames that the test does not have"));
    spark_end(&run);
}

static void stale_limits_are_noted(void **state)
{
    (void)state;
    const struct kiln_test_params usual = spark_params();
    struct kiln_test_params params = usual;
    params.ignore_hashes = true;
    spark_write("limits: {flip.mean: 0.3, flip.p99: 0.05}\n");
    spark_update(KILN_UPDATE_MISSING);

    /* Nothing was measured yet, so it is unknown whether a limit is stale. */
    struct spark_run run = spark_run(&usual);
    assert_true(spark_has_note(
        &run,
        "limit flip.mean=0.3 is looser than the default limit, 0.01, and no reason is given"));
    assert_int_equal(run.summary.notes, 2); /* the other note is on window.share */
    spark_end(&run);

    run = spark_run(&params);
    assert_true(
        spark_has_note(&run, "limit flip.mean=0.3 is stale: no value above 0 was ever measured"));
    assert_int_equal(run.summary.notes, 3); /* none of them is on flip.p99 */
    char note[KILN_MESSAGE_SIZE];
    assert_true(kiln_test_read_note(run.suite, 0, 0, note, &run.error));
    assert_string_equal(note, run.result->notes[0]);
    assert_false(kiln_test_read_note(run.suite, 0, run.summary.notes, note, &run.error));
    expect_error(&run.error, KILN_USAGE, "spark: there is no note 3; the result has 3");
    spark_end(&run);

    spark_replace(EXPECT, "kiln_expect: 1\n", "kiln_expect: 1\nmeasured: {flip.mean: 0.05}\n");
    spark_write("limits: {flip.mean: 0.3, flip.p99: 0.05}\nreason: fog\n");
    run = spark_run(&params);
    if (run.summary.notes > 0)
        fail_msg("%s", run.result->notes[0]);
    spark_end(&run);
}

/* A stage that the golden does not name is newer than the golden. */
static void stages_newer_than_the_golden_are_not_noted(void **state)
{
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_replace(EXPECT, "\"march=cpu\", ", "");
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    if (run.summary.notes > 0)
        fail_msg("%s", run.result->notes[0]);
    spark_end(&run);
}

static void other_techniques_and_missing_states_are_noted(void **state)
{
#define OTHERS "gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu bloom=cpu composite=cpu"
    (void)state;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_replace(EXPECT, "simulate=cpu", "simulate=inplace");
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(spark_has_note(&run, "the techniques are simulate=cpu " OTHERS
                                     ", but simulate=inplace " OTHERS " were accepted"));
    char accepted[32];
    snprintf(accepted, sizeof accepted, "state: \"%s\"", run.result->frames[0].state);
    spark_end(&run);

    spark_replace(EXPECT, accepted, "");
    run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(spark_has_note(&run, "no state is accepted for frame 3: --update all adds it"));
    spark_end(&run);
    spark_update(KILN_UPDATE_ALL);
    assert_int_equal(spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS), 0);
}

/* `--update failed` must replace, of several goldens of a frame, the one nearest to the picture,
 * which judged the picture. */
static void update_failed_replaces_the_nearest_golden(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    assert_true(kiln_file_copy(SPARK_GOLDEN, "golden/spark/frame_0003~2.png", &error));
    spark_paint("golden/spark/frame_0003~2.png", 2, 2, 8, 8, 60);
    spark_paint(SPARK_GOLDEN, 2, 2, 12, 12, 120);
    struct file_state first = file_state(SPARK_GOLDEN);
    struct spark_run run = run_update(KILN_UPDATE_FAILED, false);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(spark_has_note(&run, "wrote golden/spark/frame_0003~2.png"));
    spark_end(&run);
    assert_true(is_untouched(SPARK_GOLDEN, &first));
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
}

static void crashes_are_recorded(void **state)
{
    (void)state;
    spark_write("about: sparks\n");
    struct kiln_suite *suite = spark_suite();
    struct kiln_test_summary summary;
    struct kiln_error error = {0};
    assert_false(kiln_test_read_summary(suite, 0, &summary, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "out/test/spark/result.json: the result of a test cannot be opened: No such file "
                 "or directory");
    assert_true(
        kiln_test_record_error(suite, 0, KILN_DEVICE_FAILED, "crashed: signal 11", 2.5, &error));
    assert_true(kiln_test_read_summary(suite, 0, &summary, &error));
    assert_int_equal(summary.status, KILN_TEST_ERROR);
    assert_int_equal(summary.code, KILN_DEVICE_FAILED);
    assert_string_equal(summary.name, "spark");
    assert_string_equal(summary.message, "crashed: signal 11");
    assert_true(summary.total_s == 2.5);
    kiln_suite_destroy(&suite);
}

static void files_of_a_killed_run_are_removed_and_no_others(void **state)
{
    (void)state;
    spark_write("");
    test_write_file("out/test/.kiln-results", "# kiln results 1\n# writing spark\n");
    test_write_file("out/test/spark/frame_0001.png", "old");
    test_write_file("out/test/spark/.frame_0001.png.kiln-7-0.tmp", "of a process that crashed");
    test_write_file("out/test/spark/log.txt", "old");
    test_write_file("out/test/spark/notes.txt", "mine");
    test_write_file("out/test/spark/below/frame_0001.png", "of another test");
    struct spark_run run = spark_run(NULL);
    assert_true(run.ok);
    spark_end(&run);
    assert_int_equal(access("out/test/spark/frame_0001.png", F_OK), -1);
    assert_int_equal(access("out/test/spark/.frame_0001.png.kiln-7-0.tmp", F_OK), -1);
    assert_int_equal(access("out/test/spark/log.txt", F_OK), -1);
    assert_int_equal(access("out/test/spark/notes.txt", F_OK), 0);
    assert_int_equal(access("out/test/spark/below/frame_0001.png", F_OK), 0);
}

static void exr_goldens_work_too(void **state)
{
    (void)state;
    spark_write("format: exr\n");
    spark_update(KILN_UPDATE_MISSING);
    spark_expect(NULL, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
    struct kiln_test_params params = spark_params();
    params.ignore_hashes = true;
    struct spark_run run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_true(run.result->hdr);
    assert_string_equal(run.result->frames[0].reference, "frame_0003_reference.exr");
    assert_string_equal(run.result->frames[0].error_map, "frame_0003_error.png");
    spark_end(&run);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(a_dry_run_writes_nothing),
        IN_FOLDER(update_missing_writes_missing_goldens_only),
        IN_FOLDER(update_failed_leaves_passing_frames_and_other_devices),
        IN_FOLDER(update_all_alone_replaces_goldens_that_pass_by_metrics),
        IN_FOLDER(update_all_accepts_equal_pixels_of_a_new_device),
        IN_FOLDER(update_failed_accepts_a_changed_state),
        IN_FOLDER(update_all_accepts_a_scene_that_looks_the_same),
        IN_FOLDER(update_failed_replaces_broken_goldens),
        IN_FOLDER(repeats_must_have_the_same_hashes),
        IN_FOLDER(a_stopped_run_has_no_result),
        IN_FOLDER(settings_that_judge_less_are_noted),
        IN_FOLDER(goldens_of_no_frame_are_noted),
        IN_FOLDER(stale_limits_are_noted),
        IN_FOLDER(stages_newer_than_the_golden_are_not_noted),
        IN_FOLDER(other_techniques_and_missing_states_are_noted),
        IN_FOLDER(update_failed_replaces_the_nearest_golden),
        IN_FOLDER(crashes_are_recorded),
        IN_FOLDER(files_of_a_killed_run_are_removed_and_no_others),
        IN_FOLDER(exr_goldens_work_too),
    };
    return cmocka_run_group_tests_name("update", tests, spark_needs_device, NULL);
}
