/* Checks how `kiln test` compares rendered frames with goldens, accepted pictures
 * (lib/suite/judge.c): by hashes of states and pixels, by metrics against the nearest golden, and
 * with limits and masks. It also checks which files a run writes and removes. If this fails,
 * changed pictures pass or unchanged pictures fail. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "suite/golden.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/suite.h"

/* Writes the golden test of support/suite.h, with the lines `more` in its file, runs it, and
 * accepts its frames as goldens. */
static void accept_goldens(const char *more)
{
    spark_write(more);
    spark_update(KILN_UPDATE_MISSING);
}

static struct kiln_test_params without_hashes(void)
{
    struct kiln_test_params params = spark_params();
    params.ignore_hashes = true;
    return params;
}

/* Returns the value of a metric, such as "flip.mean", that the run measured for a frame. frame:
 * index in the result, from 0. */
static double value(const struct spark_run *run, size_t frame, const char *metric)
{
    size_t i = 0;
    while (i < run->result->column_count && strcmp(run->result->columns[i].name, metric) != 0)
        i++;
    assert_true(i < run->result->column_count);
    return run->result->frames[frame].values[i];
}

/* ---- Missing goldens, and frames with accepted hashes -------------------------------------- */

static void a_missing_golden_is_new_and_nothing_is_written(void **state)
{
    (void)state;
    spark_write("");
    struct spark_run run = spark_run(NULL);
    assert_true(run.ok);
    assert_int_equal(run.summary.status, KILN_TEST_NEW);
    assert_int_equal(run.summary.code, KILN_GOLDEN_MISSING);
    assert_int_equal(run.summary.frames, 2);
    expect_message(run.summary.message,
                   "frame 3 has no golden: the file " SPARK_GOLDEN " is missing");
    assert_string_equal(run.result->frames[0].picture, "frame_0003.png");
    assert_string_equal(run.result->frames[0].golden, SPARK_GOLDEN);
    assert_string_equal(run.result->frames[0].reference, "");
    assert_int_equal(access("out/test/spark/frame_0005.png", R_OK), 0);
    assert_int_equal(access("golden", F_OK), -1);
    assert_string_equal(run.result->rerun, "kiln test spark.test.yaml");
    assert_string_equal(run.result->approve, "kiln test approve spark.test.yaml");
    assert_string_equal(
        run.result->techniques,
        "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu bloom=cpu composite=cpu");
    assert_int_equal(run.result->seed, 7);
    spark_end(&run);
}

static void known_pixels_pass_at_once(void **state)
{
    (void)state;
    accept_goldens("");
    struct spark_run run = spark_run(NULL);
    assert_true(run.ok);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_int_equal(run.summary.code, KILN_OK);
    assert_string_equal(run.summary.message, "");
    assert_int_equal(run.summary.notes, 0);
    for (size_t i = 0; i < 2; i++) {
        const struct kiln_result_frame *frame = &run.result->frames[i];
        assert_int_equal(frame->judged_by, KILN_JUDGED_BY_PIXELS);
        assert_false(frame->measured);
        assert_string_equal(frame->state, frame->state_expected);
        assert_string_equal(frame->pixels, frame->pixels_expected);
    }
    assert_string_not_equal(run.result->frames[0].state, run.result->frames[1].state);
    assert_string_equal(run.result->scene_hash, run.result->scene_hash_expected);
    spark_end(&run);
}

static void without_hashes_metrics_judge(void **state)
{
    (void)state;
    accept_goldens("");
    const struct kiln_test_params params = without_hashes();
    struct spark_run run = spark_run(&params);
    assert_true(run.ok);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_METRICS);
    assert_true(run.result->frames[0].measured && run.result->frames[0].score == 0);
    assert_string_equal(run.result->frames[0].error_map, "frame_0003_error.png");
    assert_int_equal(access("out/test/spark/frame_0003_error.png", R_OK), 0);
    assert_int_equal(access("out/test/spark/frame_0003_reference.png", R_OK), 0);
    spark_end(&run);
}

static void another_state_is_a_changed_simulation(void **state)
{
    (void)state;
    accept_goldens("");
    spark_replace("spark.yaml", "seed: 7", "seed: 8");
    struct spark_run run = spark_run(NULL);
    assert_true(run.ok);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_int_equal(run.summary.code, KILN_FRAME_FAILED);
    const struct kiln_result_frame *worst = &run.result->frames[1];
    expect_message(run.summary.message,
                   "the simulation changed: the state is %s at frame 5, but %s was accepted; "
                   "flip.mean is %.4g, beyond 0.01; flip.p99 is %.4g, beyond 0.1",
                   worst->state, worst->state_expected, value(&run, 1, "flip.mean"),
                   value(&run, 1, "flip.p99"));
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_STATE);
    assert_true(run.result->frames[0].measured && run.result->frames[0].score > 1);
    assert_int_equal(run.result->change_count, 1);
    assert_string_equal(run.result->changes[0].key, "seed");
    assert_string_equal(run.result->changes[0].before, "7");
    assert_string_equal(run.result->changes[0].after, "8");
    spark_end(&run);
    const struct kiln_test_params params = without_hashes();
    spark_expect(&params, KILN_TEST_FAIL, KILN_JUDGED_BY_METRICS);
}

static void a_changed_state_fails_even_with_equal_pixels(void **state)
{
    (void)state;
    accept_goldens("");
    struct spark_run run = spark_run(NULL);
    char accepted[17];
    snprintf(accepted, sizeof accepted, "%s", run.result->frames[0].state);
    spark_end(&run);
    spark_replace("golden/spark/expect.yaml", accepted, "0123456789abcdef");
    run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_STATE);
    assert_string_equal(run.result->frames[0].state_expected, "0123456789abcdef");
    assert_int_equal(run.result->frames[1].status, KILN_TEST_PASS);
    spark_end(&run);
    const struct kiln_test_params params = without_hashes();
    spark_expect(&params, KILN_TEST_PASS, KILN_JUDGED_BY_METRICS);
}

/* ---- Metrics ------------------------------------------------------------------------------ */

/* Differences within the limits pass, with a warning if their score exceeds the test's `warn`. The
 * test repaints a golden's file; the hash that was accepted with the old file then no longer
 * counts, so metrics judge the frame. */
static void small_differences_are_within_limits(void **state)
{
    (void)state;
    accept_goldens("");
    spark_paint(SPARK_GOLDEN, 2, 2, 1, 1, 1);
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_METRICS);
    assert_true(run.summary.score > 0 && run.summary.score < 1);
    assert_string_equal(run.result->frames[0].pixels_expected, "");
    assert_int_equal(run.result->frames[1].judged_by, KILN_JUDGED_BY_PIXELS);
    spark_end(&run);

    spark_write("warn: 0.000001\n");
    run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_WARN);
    assert_int_equal(run.summary.code, KILN_OK);
    expect_message(run.summary.message,
                   "frame 3 is at %.0f %% of its limits: flip.mean is %.4g, the limit 0.01; "
                   "flip.p99 is %.4g, the limit 0.1; window.share is %.4g, the limit 0.1",
                   100 * run.summary.score, value(&run, 0, "flip.mean"), value(&run, 0, "flip.p99"),
                   value(&run, 0, "window.share"));
    spark_end(&run);
}

static void large_differences_fail(void **state)
{
    (void)state;
    accept_goldens("");
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_int_equal(run.summary.code, KILN_FRAME_FAILED);
    expect_message(run.summary.message,
                   "frame 3: flip.mean is %.4g, beyond 0.01; flip.p99 is %.4g, beyond 0.1",
                   value(&run, 0, "flip.mean"), value(&run, 0, "flip.p99"));
    assert_true(run.summary.score > 1);
    const struct kiln_result_frame *frame = &run.result->frames[0];
    assert_int_equal(frame->judged_by, KILN_JUDGED_BY_METRICS);
    assert_true(frame->worst_x >= 2 && frame->worst_x < 10 && frame->worst_y < 10);
    assert_int_equal(frame->window_differing, 64);
    spark_end(&run);

    spark_write("limits: {flip.mean: 1}\nreason: anything goes\n");
    run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    spark_end(&run);
}

static void accepted_limits_override_those_of_the_test(void **state)
{
    (void)state;
    accept_goldens("limits: {flip.mean: 1}\nreason: anything goes\n");
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    spark_replace("golden/spark/expect.yaml", "kiln_expect: 1\n",
                  "kiln_expect: 1\nlimits: {flip.mean: 0.001}\n");
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    expect_message(run.summary.message, "frame 3: flip.mean is %.4g, beyond 0.001",
                   value(&run, 0, "flip.mean"));
    spark_end(&run);
}

static void another_size_fails(void **state)
{
    (void)state;
    accept_goldens("");
    spark_write("size: [32, 48]\n");
    const struct kiln_test_params params = without_hashes();
    struct spark_run run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    expect_message(run.summary.message,
                   "frame 3: the sizes differ: the reference has 48 x 32 pixels, the test 32 x 48");
    assert_false(run.result->frames[0].measured);
    assert_string_equal(run.result->frames[0].error_map, "");
    assert_string_equal(run.result->frames[0].reference, "frame_0003_reference.png");
    spark_end(&run);
}

static void masked_pixels_are_not_judged(void **state)
{
    (void)state;
    accept_goldens("");
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    spark_write("masks: [{rect: [2, 2, 8, 7], reason: most of it}]\n");
    const struct kiln_test_params params = without_hashes();
    spark_expect(&params, KILN_TEST_FAIL, KILN_JUDGED_BY_METRICS);
    spark_write("masks: [{rect: [2, 2, 8, 8], reason: all of it}]\n");
    spark_expect(&params, KILN_TEST_PASS, KILN_JUDGED_BY_METRICS);
    spark_write("masks: [{rect: [0, 0, 99, 99], reason: too much}]\n");
    struct spark_run run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_ERROR);
    assert_int_equal(run.summary.code, KILN_INVALID_INPUT);
    spark_end(&run);
}

/* ---- Several goldens ---------------------------------------------------------------------- */

static void the_nearest_of_several_goldens_counts(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    accept_goldens("");
    assert_true(kiln_file_copy(SPARK_GOLDEN, "golden/spark/frame_0003~2.png", &error));
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    const struct kiln_test_params params = without_hashes();
    struct spark_run run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_string_equal(run.result->frames[0].golden, "golden/spark/frame_0003~2.png");
    assert_true(run.result->frames[0].score == 0);
    spark_end(&run);

    /* The accepted hash still counts, since the golden that it was accepted with is still there,
     * under another name. */
    run = spark_run(NULL);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_PIXELS);
    assert_string_equal(run.result->frames[0].golden, "golden/spark/frame_0003~2.png");
    spark_end(&run);
}

static void a_device_is_judged_by_its_own_goldens(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    accept_goldens("");
    struct spark_run run = spark_run(NULL);
    char own[KILN_PATH_SIZE];
    snprintf(own, sizeof own, "golden/spark/frame_0003@%s.png", run.result->device_name);
    spark_end(&run);
    assert_true(kiln_file_copy(SPARK_GOLDEN, own, &error));
    assert_true(kiln_file_copy(SPARK_GOLDEN, "golden/spark/frame_0003@no-such-device.png", &error));
    spark_paint("golden/spark/frame_0003@no-such-device.png", 2, 2, 8, 8, 120);
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    const struct kiln_test_params params = without_hashes();
    run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_PASS);
    assert_string_equal(run.result->frames[0].golden, own);
    spark_end(&run);

    spark_paint(own, 2, 2, 8, 8, 120);
    spark_paint(SPARK_GOLDEN, 2, 2, 8, 8, 120);
    run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_string_equal(run.result->frames[0].golden, own);
    spark_end(&run);
}

static void strict_passes_known_pixels_only(void **state)
{
    (void)state;
    accept_goldens("");
    struct spark_run run = spark_run(NULL);
    char hash[80];
    snprintf(hash, sizeof hash, "hash: \"%s\"", run.result->frames[0].pixels);
    spark_end(&run);
    struct kiln_test_params params = spark_params();
    params.strict = true;
    spark_expect(&params, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS);
    spark_replace("golden/spark/expect.yaml", hash,
                  "hash: "
                  "\"00000000000000000000000000000000ffffffffffffffffffffffffffffffff\"");
    run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_CHANGE);
    assert_int_equal(run.summary.code, KILN_OK);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_METRICS);
    expect_message(run.summary.message,
                   "frame 3: the renderer changed, from kiln " KILN_VERSION
                   " to kiln %s; the picture is within its limits",
                   run.result->version);
    spark_end(&run);
    run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_FAIL);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_PIXELS);
    assert_int_equal(run.result->frames[1].status, KILN_TEST_PASS);
    spark_end(&run);
}

/* ---- What cannot be judged ---------------------------------------------------------------- */

/* Runs the golden test, and fails unless it ends with this error. */
static void expect_unjudged(enum kiln_code code, const char *message)
{
    struct spark_run run = spark_run(NULL);
    assert_true(run.ok);
    assert_int_equal(run.summary.status, KILN_TEST_ERROR);
    assert_int_equal(run.summary.code, code);
    expect_message(run.summary.message, "%s", message);
    spark_end(&run);
}

static void what_cannot_be_judged_is_an_error(void **state)
{
#define ALLOWED "allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files"
    (void)state;
    accept_goldens("");
    struct kiln_error error = {0};
    assert_true(kiln_file_copy(SPARK_GOLDEN, "kept.png", &error));
    test_write_file(SPARK_GOLDEN, "no picture");
    expect_unjudged(KILN_INVALID_INPUT,
                    "frame 3: " SPARK_GOLDEN
                    ": the file is not an image: it starts with the bytes 6e 6f 20 70; " ALLOWED
                    "; --update failed replaces it");
    test_write_file(SPARK_GOLDEN, "");
    expect_unjudged(KILN_INVALID_INPUT, "frame 3: " SPARK_GOLDEN
                                        ": the image file is empty; --update failed replaces it");
    assert_true(kiln_file_copy("kept.png", SPARK_GOLDEN, &error));
    spark_write("masks: [{rect: [0, 0, 48, 32], reason: all}]\n");
    expect_unjudged(KILN_INVALID_INPUT,
                    "the masks cover all 48 x 32 pixels: nothing is left to judge");
    spark_write("masks: [{picture: spark.yaml, reason: none}]\n");
    expect_unjudged(
        KILN_INVALID_INPUT,
        "spark.yaml: the file is not an image: it starts with the bytes 6b 69 6c 6e; " ALLOWED);
    spark_write("set: [output.frames=5]\n");
    expect_unjudged(KILN_INVALID_INPUT,
                    "spark.test.yaml: frame 5: the last one of spark.yaml is 4");
    spark_write("set: [output.frams=5]\n");
    expect_unjudged(KILN_INVALID_INPUT, "--set output.frams: unknown key (did you mean 'frames'?)");
    spark_write("technique: [simulate=cpu]\n");
    expect_unjudged(KILN_INVALID_INPUT,
                    "spark.test.yaml:4:1: technique: unknown key (did you mean 'techniques'?)");
    spark_write("techniques: [simulate=abacus]\n");
    expect_unjudged(KILN_INVALID_INPUT,
                    "spark.test.yaml:4:14: techniques.0: simulate 'abacus' is not known; allowed "
                    "are cpu, inplace, pingpong, feedback, texels, auto");
    spark_write("");
    test_write_file("golden/spark/expect.yaml", "kiln_expect: 1\nfarmes: {}\n");
    expect_unjudged(KILN_INVALID_INPUT,
                    "golden/spark/expect.yaml:2:1: farmes: unknown key (did you mean 'frames'?)");
}

static void earlier_results_are_removed_and_nothing_else(void **state)
{
    (void)state;
    spark_write("");
    struct spark_run run = spark_run(NULL);
    assert_true(run.ok);
    assert_int_equal(access("out/test/spark/frame_0003.png", F_OK), 0);
    struct kiln_error error = {0};
    assert_true(kiln_suite_write_run(run.suite, 1, &error));
    spark_end(&run);

    test_write_file("out/test/spark/notes.json", "mine");
    spark_replace("spark.test.yaml", "[3, 5]", "[0]");
    run = spark_run(NULL);
    assert_true(run.ok);
    assert_int_equal(access("out/test/spark/frame_0003.png", F_OK), -1);
    assert_int_equal(access("out/test/spark/frame_0000.png", F_OK), 0);
    assert_int_equal(access("out/test/spark/notes.json", F_OK), 0);
    assert_true(kiln_suite_write_run(run.suite, 1, &error));
    spark_end(&run);

    test_write_file("out/test/spark/frame_0099.png", "mine");
    struct kiln_suite *suite = spark_suite();
    assert_false(kiln_suite_begin(suite, &error));
    expect_error(&error, KILN_USAGE,
                 "out/test/spark/frame_0099.png: kiln did not write this file; move it away, or "
                 "name another folder by --results");
    assert_int_equal(access("out/test/spark/frame_0000.png", F_OK), 0);
    kiln_suite_destroy(&suite);
}

static void a_device_that_is_absent_is_skipped(void **state)
{
    (void)state;
    spark_write("devices: [no-such-device]\n");
    struct spark_run run = spark_run(NULL);
    assert_int_equal(run.summary.status, KILN_TEST_SKIP);
    assert_int_equal(run.summary.code, KILN_OK);
    char names[512];
    test_device_names(names, sizeof names);
    expect_message(run.summary.message, "there is no device 'no-such-device'; there are: %s",
                   names);
    spark_end(&run);

    spark_write("");
    struct kiln_test_params params = spark_params();
    params.device = "no-such-device";
    run = spark_run(&params);
    assert_int_equal(run.summary.status, KILN_TEST_ERROR);
    assert_int_equal(run.summary.code, KILN_NO_DEVICE);
    assert_string_equal(run.result->rerun, "kiln test --device no-such-device spark.test.yaml");
    spark_end(&run);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(a_missing_golden_is_new_and_nothing_is_written),
        IN_FOLDER(known_pixels_pass_at_once),
        IN_FOLDER(without_hashes_metrics_judge),
        IN_FOLDER(another_state_is_a_changed_simulation),
        IN_FOLDER(a_changed_state_fails_even_with_equal_pixels),
        IN_FOLDER(small_differences_are_within_limits),
        IN_FOLDER(large_differences_fail),
        IN_FOLDER(accepted_limits_override_those_of_the_test),
        IN_FOLDER(another_size_fails),
        IN_FOLDER(masked_pixels_are_not_judged),
        IN_FOLDER(the_nearest_of_several_goldens_counts),
        IN_FOLDER(a_device_is_judged_by_its_own_goldens),
        IN_FOLDER(strict_passes_known_pixels_only),
        IN_FOLDER(what_cannot_be_judged_is_an_error),
        IN_FOLDER(earlier_results_are_removed_and_nothing_else),
        IN_FOLDER(a_device_that_is_absent_is_skipped),
    };
    return cmocka_run_group_tests_name("suite", tests, spark_needs_device, NULL);
}
