/* Checks kiln_test_calibrate (lib/suite/calibrate.c), which renders the frames of a golden test
 * with several thread counts and techniques, and proposes limits for the test from how much the
 * renders differ from the golden pictures. If this fails, proposed limits are too strict for
 * another driver, too loose to find faults, or hide that the simulation changed. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/pictures.h"
#include "support/suite.h"

#define EXPECT "golden/spark/expect.yaml"

struct calibrated {
    struct kiln_calibration calibration;
    struct kiln_error error;
    char renders[8][128]; /* the last reported renders as text: threads, techniques, device */
    uint32_t told;        /* number of reported renders */
    bool ok;
};

static void see(void *user, const char *line)
{
    struct calibrated *seen = user;
    snprintf(seen->renders[seen->told % 8], sizeof seen->renders[0], "%s", line);
    seen->told++;
}

static struct kiln_calibrate_params calibrate_params(const char **device)
{
    struct kiln_calibrate_params params = kiln_calibrate_defaults();
    *device = getenv("KILN_TEST_DEVICE");
    params.devices = device;
    params.device_count = *device ? 1 : 0;
    params.renders = 4;
    params.render = see;
    return params;
}

static struct calibrated calibrate(struct kiln_calibrate_params *params)
{
    struct calibrated seen = {0};
    struct kiln_suite *suite = spark_suite();
    params->user = &seen;
    seen.ok = kiln_test_calibrate(suite, 0, params, &seen.calibration, &seen.error);
    kiln_suite_destroy(&suite);
    return seen;
}

static const struct kiln_calibrated *metric(const struct calibrated *seen, const char *name)
{
    for (size_t i = 0; i < seen->calibration.count; i++) {
        if (strcmp(seen->calibration.metrics[i].metric, name) == 0)
            return &seen->calibration.metrics[i];
    }
    fail_msg("no %s", name);
    return NULL;
}

static void renders_differ_in_threads_and_techniques(void **state)
{
    (void)state;
    const char *device;
    /* Many faint billboards overlap, so that their sums depend on how the rasteriser rounds. */
    spark_write("set: [systems.sparks.look.size=1, systems.sparks.look.opacity=0.01, "
                "systems.sparks.emit.rate=20000]\n");
    struct kiln_calibrate_params params = calibrate_params(&device);
    params.renders = 8; /* so many renders that the raster technique changes */
    struct calibrated seen = calibrate(&params);
    if (!seen.ok)
        fail_msg("%s", seen.error.message);
    assert_int_equal(seen.calibration.renders, 8);
    assert_true(seen.told >= 8);
    for (uint32_t i = 0; i < seen.told && i < 8; i++) {
        for (uint32_t k = 0; k < i; k++)
            assert_string_not_equal(seen.renders[i], seen.renders[k]);
    }
    assert_non_null(strstr(seen.renders[0], "threads=1 simulate=cpu"));
    assert_false(seen.calibration.equal); /* rasterisers round differently */
    assert_int_equal(seen.calibration.count, 3);
    assert_true(metric(&seen, "flip.mean")->worst > 0 && metric(&seen, "flip.mean")->worst < 3e-3);
    assert_true(metric(&seen, "flip.mean")->now == 0.01);
    assert_true(metric(&seen, "flip.mean")->proposed >= 0.001 &&
                metric(&seen, "flip.mean")->proposed <= 0.01);
    assert_true(metric(&seen, "flip.p99")->proposed >= 0.025);
    assert_true(metric(&seen, "window.share")->proposed >= 0.01);
    assert_int_equal(access("golden", F_OK), -1);
    assert_int_equal(access("out", F_OK), -1);
}

static void the_worst_value_is_measured_against_the_golden(void **state)
{
    (void)state;
    const char *device;
    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_paint(SPARK_GOLDEN, 2, 2, 10, 10, 20);
    struct kiln_calibrate_params params = calibrate_params(&device);
    params.renders = 2;
    params.write = true;
    struct calibrated seen = calibrate(&params);
    assert_true(seen.ok && seen.calibration.equal);
    const struct kiln_calibrated *mean = metric(&seen, "flip.mean");
    assert_true(mean->worst > 0.01);
    assert_true(mean->proposed >= 3 * mean->worst * (1 - 1e-9) &&
                mean->proposed <= 3 * mean->worst * 1.1 + 1e-9);
    assert_true(metric(&seen, "flip.p99")->proposed <= 1);

    /* The written limits are in force: the painted golden passes by the metrics, without a note
     * about stale limits. */
    struct spark_run run = spark_run(NULL);
    if (run.summary.status != KILN_TEST_PASS)
        fail_msg("%s", run.summary.message);
    assert_int_equal(run.result->frames[0].judged_by, KILN_JUDGED_BY_METRICS);
    assert_int_equal(run.summary.notes, 0);
    spark_end(&run);
    char *expect = test_read_file(EXPECT);
    assert_non_null(strstr(expect, "calibrated 20"));
    assert_non_null(strstr(expect, "2 renders on "));
    assert_non_null(strstr(expect, "looser than the default limits: flip.mean"));
    assert_non_null(strstr(expect, "measured"));
    assert_non_null(strstr(expect, "state"));
    free(expect);
}

/* A stop callback that never stops the calibration. Before the second render it changes the scene's
 * seed, as if the simulation were not deterministic. */
static bool change_scene(void *user)
{
    struct calibrated *seen = user;
    char *scene = test_read_file("spark.yaml");
    if (seen->told == 1 && strstr(scene, "seed: 7"))
        spark_replace("spark.yaml", "seed: 7", "seed: 8");
    free(scene);
    return false;
}

static void states_that_differ_fail(void **state)
{
    (void)state;
    const char *device;
    spark_write("");
    struct kiln_calibrate_params params = calibrate_params(&device);
    params.write = true;
    params.stop = change_scene;
    struct calibrated changing = calibrate(&params);
    assert_false(changing.ok);
    assert_int_equal(access(EXPECT, F_OK), -1);

    spark_write("");
    spark_update(KILN_UPDATE_MISSING);
    spark_replace("spark.yaml", "seed: 7", "seed: 8");
    params.stop = NULL;
    struct calibrated changed = calibrate(&params);
    assert_false(changed.ok);

    struct spark_run run = spark_run(NULL);
    const struct kiln_result_frame *frame = &run.result->frames[0];
    expect_error(&changing.error, KILN_FRAME_FAILED,
                 "render 2 has the state %s at frame 3, but the first render had %s: the "
                 "simulation is not deterministic",
                 frame->state, frame->state_expected);
    expect_error(&changed.error, KILN_FRAME_FAILED,
                 "the simulation changed: the state is %s at frame 3, but %s was accepted; update "
                 "the goldens before calibrating",
                 frame->state, frame->state_expected);
    spark_end(&run);
}

static void invalid_parameters_are_errors(void **state)
{
    (void)state;
    static const char *const messages[] = {
        "found 1 as the number of renders; a calibration needs 2 or more",
        "found a margin of 0.5; allowed are 1 to 1000",
        "found a margin of nan; allowed are 1 to 1000",
    };
    const char *device;
    char names[512];
    test_device_names(names, sizeof names);
    spark_write("");
    for (int i = 0; i < 4; i++) {
        struct kiln_calibrate_params params = calibrate_params(&device);
        params.renders = i == 0 ? 1 : 2;
        params.margin = i == 1 ? 0.5 : i == 2 ? NAN : 3;
        const char *const absent[] = {"no-such-device"};
        params.devices = i == 3 ? absent : params.devices;
        params.device_count = i == 3 ? 1 : params.device_count;
        struct calibrated seen = calibrate(&params);
        assert_false(seen.ok);
        if (i == 3)
            expect_error(&seen.error, KILN_NO_DEVICE,
                         "there is no device 'no-such-device'; there are: %s", names);
        else
            expect_error(&seen.error, KILN_USAGE, "%s", messages[i]);
    }
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(renders_differ_in_threads_and_techniques),
        IN_FOLDER(the_worst_value_is_measured_against_the_golden),
        IN_FOLDER(states_that_differ_fail),
        IN_FOLDER(invalid_parameters_are_errors),
    };
    return cmocka_run_group_tests_name("calibrate", tests, spark_needs_device, NULL);
}
