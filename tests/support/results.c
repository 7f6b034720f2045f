/* Writes the result files of an invented `kiln test` run, for tests of reports. The run has a test
 * of every status, and names and messages with characters that reports must escape. */
#include "support/results.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/temporary.h"
#include "suite/suite.h"

/* A text with characters that would end a string, line, element, comment or command in a format of
 * reports, if the report did not escape them. */
#define TEST_NASTY_TEXT "a&b<c>\"d'#e\\f%g:h,i]]>j{k}\x01\x1b[31m\nl\tm\r\xc3\xa9\xef\xbf\xbe"

enum { TEST_RESULT_COUNT = 9, TEST_COLUMN_COUNT = 3 };

/* The results of all tests, and the arrays that they point to. */
struct test_results {
    struct kiln_result results[TEST_RESULT_COUNT];
    struct kiln_result_frame frames[TEST_RESULT_COUNT][2];
    struct kiln_result_change changes[2];
    const char *notes[2];
};

/* Fills in result `index` with values that all tests of the run share, and returns it. */
static struct kiln_result *test_result(struct test_results *all, size_t index, const char *name,
                                       enum kiln_test_status status, const char *message)
{
    struct kiln_result *result = &all->results[index];
    kiln_result_init(result, name);
    result->test = "tests/scene.test.yaml";
    result->golden = "golden/scene";
    result->status = status;
    result->message = message;
    result->device = "llvmpipe (LLVM 15.0.6, 256 bits)";
    result->device_name = "llvmpipe-llvm-15.0.6-256-bits";
    result->techniques = "simulate=cpu sort=cpu";
    result->version = "0.2.0";
    result->seed = 7;
    result->width = 320;
    result->height = 180;
    result->started = "2026-01-31T12:00:00Z";
    result->total_s = 1.25;
    result->column_count = TEST_COLUMN_COUNT;
    result->columns[0] = (struct kiln_compare_column){"flip.mean", "", false, true, 0.01};
    result->columns[1] = (struct kiln_compare_column){"ssim", "", true, true, 0.9};
    result->columns[2] = (struct kiln_compare_column){"psnr", "dB", true, false, 0};
    result->frames = all->frames[index];
    return result;
}

/* Adds a frame to a result and returns it. flip: the mean FLIP error, from which the frame's other
 * metrics are computed; a negative number means that the frame was not measured. */
static struct kiln_result_frame *test_frame(struct kiln_result *result, uint32_t number,
                                            enum kiln_test_status status,
                                            enum kiln_judged_by judged_by, double flip)
{
    struct kiln_result_frame *frame = &result->frames[result->frame_count++];
    kiln_result_frame_init(frame, number);
    frame->status = status;
    frame->judged_by = judged_by;
    frame->picture = number == 24 ? "frame_0024.png" : "frame_0096.png";
    frame->golden = "golden/scene/frame.png";
    frame->state = "13e7be772847a38f";
    frame->pixels = "0a1b";
    frame->measured = flip >= 0;
    if (frame->measured) {
        frame->reference = number == 24 ? "golden_0024.png" : "golden_0096.png";
        frame->error_map = number == 24 ? "flip_0024.png" : "flip_0096.png";
        frame->values[0] = flip;
        frame->values[1] = 1 - flip;
        frame->values[2] = flip > 0 ? 20.5 : (double)INFINITY;
        frame->score = flip * 64;
        frame->beyond[0] = flip > 0.01;
    }
    return frame;
}

/* Fills in results 0 to 2: tests that pass, warn and are skipped. */
static void test_fill_good(struct test_results *all)
{
    struct kiln_result *result = test_result(all, 0, "effects/fire", KILN_TEST_PASS, "");
    test_frame(result, 24, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS, -1);
    test_frame(result, 96, KILN_TEST_PASS, KILN_JUDGED_BY_METRICS, 0);

    result = test_result(all, 1, "effects/smoke", KILN_TEST_WARN, "near its limits");
    test_frame(result, 24, KILN_TEST_WARN, KILN_JUDGED_BY_METRICS, 0.00812345)->message =
        "flip.mean 0.0081 is near 0.01";
    all->notes[0] = "limit ssim=0.9 is stale: no value below 0.99 was ever measured";
    all->notes[1] = "the scene changed (2 keys)";
    result->notes = all->notes;
    result->note_count = 2;

    test_result(all, 2, "only@nvidia", KILN_TEST_SKIP, "there is no device 'nvidia' # here");
}

/* Fills in results 3 to 8: failures, a new test, errors and a changed renderer. */
static void test_fill_bad(struct test_results *all)
{
    struct kiln_result *result =
        test_result(all, 3, "fail/metrics", KILN_TEST_FAIL, "frame 96: flip.mean 0.03125 > 0.01");
    test_frame(result, 24, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS, -1);
    test_frame(result, 96, KILN_TEST_FAIL, KILN_JUDGED_BY_METRICS, 0.03125)->message =
        "flip.mean 0.03125 > 0.01";
    result->rerun = "kiln test tests/scene.test.yaml";
    result->approve = "kiln test approve fail/metrics";

    result = test_result(all, 4, "fail/state", KILN_TEST_FAIL, "the simulation changed");
    test_frame(result, 24, KILN_TEST_FAIL, KILN_JUDGED_BY_STATE, 0.002)->message =
        "the simulation changed";
    result->frames[0].state_expected = "000000000000000f";
    all->changes[0] = (struct kiln_result_change){"systems.fire.emit.rate", "20000", "10000",
                                                  "parts/<fire>.yaml:7"};
    all->changes[1] = (struct kiln_result_change){"seed", "", "<7>", ""};
    result->changes = all->changes;
    result->change_count = 2;

    result = test_result(all, 5, "new", KILN_TEST_NEW, "frame 24: there is no golden");
    test_frame(result, 24, KILN_TEST_NEW, KILN_JUDGED_BY_NOTHING, -1)->message =
        "there is no golden";
    result->approve = "kiln test approve new";

    result = test_result(all, 6, "broken", KILN_TEST_ERROR, "x.yaml:1:1: unknown key 'a'");
    result->log = "log.txt";

    test_result(all, 7, "a-b_c.d\xc3\xa9", KILN_TEST_ERROR, TEST_NASTY_TEXT);

    result = test_result(all, 8, "effects/torch", KILN_TEST_CHANGE,
                         "frame 24: the renderer changed, from kiln 0.2.0 (1234567) to kiln 0.2.0; "
                         "the picture is within its limits");
    test_frame(result, 24, KILN_TEST_CHANGE, KILN_JUDGED_BY_METRICS, 0.001)->kiln_expected =
        "0.2.0 (1234567)";
    result->approve = "kiln test approve effects/torch";
    result->pins_gl = true;
    static const enum kiln_code codes[] = {
        [3] = KILN_FRAME_FAILED,  [4] = KILN_FRAME_FAILED,  [5] = KILN_GOLDEN_MISSING,
        [6] = KILN_INVALID_INPUT, [7] = KILN_DEVICE_FAILED, [8] = KILN_OK,
    };
    for (size_t i = 3; i < TEST_RESULT_COUNT; i++)
        all->results[i].code = codes[i];
}

/* Writes a file of a result, since reports name only files that are there. */
static bool write_file(const char *folder, const char *name, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    return !*name || (kiln_path_join(path, folder, name, error) &&
                      kiln_temporary_write_file(path, "a file", strlen("a file"), error));
}

static bool write_files(const char *folder, const struct kiln_result *result,
                        struct kiln_error *error)
{
    bool ok = write_file(folder, result->log, error);
    for (size_t i = 0; ok && i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        ok = write_file(folder, frame->picture, error) &&
             write_file(folder, frame->reference, error) &&
             write_file(folder, frame->error_map, error);
    }
    return ok;
}

bool test_write_run(const char *folder, bool good, struct kiln_error *error)
{
    struct test_results all = {0};
    test_fill_good(&all);
    if (!good)
        test_fill_bad(&all);
    size_t count = good ? 3 : TEST_RESULT_COUNT;
    struct kiln_test tests[TEST_RESULT_COUNT + 1] = {0};
    for (size_t i = 0; i < count; i++) {
        tests[i].full_name = all.results[i].name;
        tests[i].path = all.results[i].test;
    }
    if (!good) {
        tests[count].full_name = "lost";
        tests[count].path = "tests/lost.test.yaml";
    }
    char results[KILN_PATH_SIZE];
    snprintf(results, sizeof results, "%s", folder);
    struct kiln_suite suite = {.tests = tests, .count = count + !good, .results_folder = results};
    if (!kiln_suite_begin(&suite, error))
        return false;
    for (size_t i = 0; i < count; i++) {
        char path[KILN_PATH_SIZE];
        snprintf(path, sizeof path, "%s/%s", folder, all.results[i].name);
        if (!write_files(path, &all.results[i], error) ||
            !kiln_result_write(&all.results[i], path, error))
            return false;
    }
    return kiln_suite_write_run(&suite, 12.3456, error);
}
