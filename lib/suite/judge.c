/* Judges one frame of a test. A frame whose state is not the accepted one fails, since states are
 * the same on every device. Pixels that were accepted on this device pass. Otherwise metrics judge
 * how the picture differs from the nearest golden. A test that keeps hashes alone fails with any
 * pixels but the accepted ones. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "suite/against.h"
#include "suite/test_case.h"

struct judging {
    struct kiln_test_case *test_case;
    struct kiln_result_frame *frame;
    struct kiln_test_case_frame *case_frame;
    char picture[KILN_PATH_SIZE];
    struct kiln_goldens goldens;
    char hashes[KILN_MAX_GOLDENS][65];
    size_t nearest;
    struct kiln_error error;
};

static bool decide(struct judging *j, enum kiln_test_status status, enum kiln_judged_by judged_by,
                   const char *message)
{
    j->frame->status = status;
    j->frame->judged_by = judged_by;
    j->frame->message = message;
    return true;
}

/* ---- What is accepted --------------------------------------------------------------------- */

/* Checks that the picture can be compared: one with NaN must not become a golden. */
static bool check_picture(struct judging *j, struct kiln_error *error)
{
    struct kiln_test_case_comparison comparison;
    return kiln_test_case_compare(j->test_case, j->picture, j->picture, NULL, &comparison, error);
}

/* Hashes a golden. A golden that cannot be decoded is the frame's error, but an update can replace
 * it. */
static bool hash_golden(struct judging *j, size_t index)
{
    struct kiln_error ignored = {0};
    if (kiln_pixel_hash_warned(j->goldens.paths[index], &j->test_case->params->log,
                               j->hashes[index], &j->error))
        return true;
    if (j->error.code != KILN_INVALID_INPUT || !check_picture(j, &ignored))
        return false;
    j->case_frame->broken_golden = true;
    j->frame->golden = kiln_test_case_text(j->test_case, "%s", j->goldens.paths[index]);
    return false;
}

static bool find_goldens(struct judging *j)
{
    struct kiln_test_case *test_case = j->test_case;
    if (!kiln_test_case_path(test_case, j->frame->picture, j->picture, &j->error))
        return false;
    if (test_case->test->golden_form == KILN_GOLDEN_HASH) {
        j->frame->golden =
            kiln_test_case_text(test_case, "%s/expect.yaml", test_case->test->golden);
        return true;
    }
    if (!kiln_goldens_find(test_case->test, j->frame->number, test_case->rendering.device_name,
                           &j->goldens, &j->error))
        return false;
    j->frame->golden = kiln_test_case_text(test_case, "%s", j->goldens.paths[0]);
    j->case_frame->has_golden = j->goldens.count > 0;
    for (size_t i = 0; i < j->goldens.count; i++) {
        if (!hash_golden(j, i))
            return false;
        if (!j->case_frame->equals_golden && strcmp(j->hashes[i], j->frame->pixels) == 0) {
            j->case_frame->equals_golden = true;
            memcpy(j->case_frame->golden_hash, j->hashes[i], sizeof j->case_frame->golden_hash);
        }
    }
    return true;
}

static void take_expected(struct judging *j, const struct kiln_expect_pixels *pixels)
{
    j->frame->pixels_expected = pixels->hash;
    j->frame->kiln_expected = pixels->kiln ? pixels->kiln : "";
}

/* Finds the accepted state, and the pixels that were accepted on this device. The pixels count only
 * while the golden that they were accepted with is there. */
static void find_expected(struct judging *j)
{
    const struct kiln_test_case *test_case = j->test_case;
    const struct kiln_expect_frame *expected =
        kiln_expect_find(test_case->expect, j->frame->number);
    if (!expected)
        return;
    j->frame->state_expected = expected->state ? expected->state : "";
    for (size_t i = 0; i < expected->pixel_count; i++) {
        const struct kiln_expect_pixels *pixels = &expected->pixels[i];
        if (strcmp(pixels->device, test_case->rendering.device_name) != 0)
            continue;
        if (test_case->test->golden_form == KILN_GOLDEN_HASH)
            take_expected(j, pixels);
        for (size_t k = 0; pixels->golden && k < j->goldens.count; k++) {
            if (strcmp(pixels->golden, j->hashes[k]) == 0) {
                take_expected(j, pixels);
                j->nearest = k;
            }
        }
    }
}

/* Copies the nearest golden beside the picture, so that a report can show it even if the golden
 * changes later. */
static bool copy_reference(struct judging *j)
{
    const char *golden = j->goldens.paths[j->nearest];
    char path[KILN_PATH_SIZE];
    const char *name = kiln_test_case_text(j->test_case, "frame_%04u_reference%s", j->frame->number,
                                           kiln_test_suffix(j->test_case->test));
    if (!kiln_test_case_path(j->test_case, name, path, &j->error) ||
        !kiln_file_copy(golden, path, &j->error))
        return false;
    j->frame->golden = kiln_test_case_text(j->test_case, "%s", golden);
    j->frame->reference = name;
    return true;
}

/* ---- Metrics ------------------------------------------------------------------------------ */

static void take_values(struct judging *j, const struct kiln_test_case_comparison *comparison)
{
    struct kiln_result_frame *frame = j->frame;
    const struct kiln_compare_frame *found = &comparison->frame;
    frame->measured = found->measured;
    if (!found->measured)
        return;
    memcpy(frame->values, found->values, sizeof frame->values);
    memcpy(frame->beyond, found->beyond, sizeof frame->beyond);
    frame->score = found->score;
    frame->worst_x = found->worst_x;
    frame->worst_y = found->worst_y;
    frame->window_x = found->window_x;
    frame->window_y = found->window_y;
    frame->window_width = found->window_width;
    frame->window_height = found->window_height;
    frame->window_differing = found->window_differing;
    j->test_case->result->hdr = comparison->result.hdr;
}

/* Compares the picture with every golden and chooses the nearest. Only the nearest gets an error
 * map. */
static bool measure(struct judging *j, struct kiln_test_case_comparison *best)
{
    double least = INFINITY;
    for (size_t i = 0; i < j->goldens.count && j->goldens.count > 1; i++) {
        if (!kiln_test_case_compare(j->test_case, j->goldens.paths[i], j->picture, NULL, best,
                                    &j->error))
            return false;
        if (i == 0 || best->frame.score < least) {
            least = best->frame.score;
            j->nearest = i;
        }
    }
    char path[KILN_PATH_SIZE];
    const char *name = kiln_test_case_text(j->test_case, "frame_%04u_error.png", j->frame->number);
    if (!kiln_test_case_path(j->test_case, name, path, &j->error) ||
        !kiln_test_case_compare(j->test_case, j->goldens.paths[j->nearest], j->picture, path, best,
                                &j->error))
        return false;
    take_values(j, best);
    j->frame->error_map = best->frame.measured ? name : "";
    return true;
}

/* Prints a value to four digits, or to as many, up to nine, as distinguish it from the limit. */
static void print_value(char out[32], double value, double limit)
{
    char other[32];
    for (int digits = 4; digits <= 9; digits++) {
        snprintf(out, 32, "%.*g", digits, value);
        snprintf(other, sizeof other, "%.*g", digits, limit);
        if (value == limit || strcmp(out, other) != 0)
            return;
    }
}

/* Describes the metrics that are beyond their limits, "flip.mean is 0.02, beyond 0.01; ...", or, if
 * `beyond` is false, all metrics that have a limit. */
static const char *describe(struct judging *j, const struct kiln_test_case_comparison *comparison,
                            bool beyond)
{
    const struct kiln_result *result = j->test_case->result;
    char text[KILN_MESSAGE_SIZE] = "";
    size_t used = 0;
    if (!comparison->frame.measured)
        return kiln_test_case_text(j->test_case, "%s", comparison->message);
    for (size_t i = 0; i < result->column_count && used < sizeof text; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        if (!column->limited || (beyond && !j->frame->beyond[i]))
            continue;
        char value[32];
        print_value(value, j->frame->values[i], column->limit);
        int length =
            snprintf(text + used, sizeof text - used, "%s%s is %s, %s %.4g", used ? "; " : "",
                     column->name, value, beyond ? "beyond" : "the limit", column->limit);
        used += length > 0 ? (size_t)length : 0;
    }
    return kiln_test_case_text(j->test_case, "%s", text);
}

/* ---- The verdict -------------------------------------------------------------------------- */

static bool state_changed(const struct judging *j)
{
    return !j->test_case->params->ignore_hashes && *j->frame->state_expected &&
           strcmp(j->frame->state_expected, j->frame->state) != 0;
}

static const char *describe_state(struct judging *j, const char *picture)
{
    return kiln_test_case_text(
        j->test_case,
        "the simulation changed: the state is %s at frame %u, but %s was accepted; %s",
        j->frame->state, j->frame->number, j->frame->state_expected, picture);
}

static bool judge_new(struct judging *j)
{
    if (!check_picture(j, &j->error))
        return false;
    if (state_changed(j))
        return decide(j, KILN_TEST_FAIL, KILN_JUDGED_BY_STATE,
                      describe_state(j, "the frame has no golden picture"));
    return decide(j, KILN_TEST_NEW, KILN_JUDGED_BY_NOTHING,
                  kiln_test_case_text(j->test_case,
                                      "frame %u has no golden: the file %s is missing",
                                      j->frame->number, j->goldens.paths[0]));
}

/* Judges a frame within the limits of its golden if no expect.yaml says which state was accepted.
 * Such a frame is new, since a picture alone does not show whether the state has changed. */
static bool judge_without_expect(struct judging *j)
{
    j->case_frame->without_expect = true;
    memcpy(j->case_frame->golden_hash, j->hashes[j->nearest], sizeof j->case_frame->golden_hash);
    return decide(
        j, KILN_TEST_NEW, KILN_JUDGED_BY_METRICS,
        kiln_test_case_text(j->test_case,
                            "frame %u is like its golden, but there is no %s/expect.yaml, so "
                            "the accepted state is not known",
                            j->frame->number, j->test_case->test->golden));
}

/* Returns whether scene and state are the accepted ones, so that only the renderer can have
 * changed. */
static bool renderer_changed(const struct judging *j)
{
    const struct kiln_test_case *test_case = j->test_case;
    const char *scene = test_case->result->scene_hash_expected, *state = j->frame->state_expected;
    bool same_scene =
        *scene && (strcmp(scene, test_case->rendering.scene.hash) == 0 ||
                   (test_case->scene_keys_differ && test_case->result->change_count == 0));
    return same_scene && *state && strcmp(state, j->frame->state) == 0;
}

/* Returns the message that a frame's pixels are not the accepted ones. It ends in `picture`, which
 * says how the picture differs. */
static const char *describe_change(struct judging *j, const char *picture)
{
    const char *before = j->frame->kiln_expected;
    if (!renderer_changed(j))
        return kiln_test_case_text(j->test_case,
                                   "frame %u has other pixels than the accepted ones on %s; %s",
                                   j->frame->number, j->test_case->rendering.device_name, picture);
    return kiln_test_case_text(j->test_case,
                               "frame %u: the renderer changed, from %s %s to kiln %s; %s",
                               j->frame->number, *before ? "kiln" : "a version that is not",
                               *before ? before : "known", j->test_case->result->version, picture);
}

/* Returns whether the device is `cpu`, which makes the same pixels everywhere. */
static bool is_cpu(const struct judging *j)
{
    return strcmp(j->test_case->rendering.device_name, "cpu") == 0;
}

static bool judge_by_metrics(struct judging *j, bool known)
{
    struct kiln_test_case_comparison comparison;
    if (!measure(j, &comparison) || !copy_reference(j))
        return false;
    const bool same = comparison.result.same, strict = j->test_case->params->strict;
    const char *beyond = same ? "the picture is within its limits" : describe(j, &comparison, true);
    if (state_changed(j))
        return decide(j, KILN_TEST_FAIL, KILN_JUDGED_BY_STATE, describe_state(j, beyond));
    if (known && (strict || !same))
        return decide(j, KILN_TEST_FAIL, strict ? KILN_JUDGED_BY_PIXELS : KILN_JUDGED_BY_METRICS,
                      describe_change(j, beyond));
    if (!same)
        return decide(j, KILN_TEST_FAIL, KILN_JUDGED_BY_METRICS,
                      kiln_test_case_text(j->test_case, "frame %u: %s", j->frame->number, beyond));
    if (j->test_case->expect->missing && !j->test_case->params->ignore_hashes)
        return judge_without_expect(j);
    if (known)
        return decide(j, KILN_TEST_CHANGE, KILN_JUDGED_BY_METRICS, describe_change(j, beyond));
    if (strict && is_cpu(j))
        return decide(
            j, KILN_TEST_FAIL, KILN_JUDGED_BY_PIXELS,
            kiln_test_case_text(j->test_case,
                                "frame %u has no accepted pixels of cpu, which are the same "
                                "everywhere; --update all accepts them",
                                j->frame->number));
    if (j->frame->score > j->test_case->warn)
        return decide(j, KILN_TEST_WARN, KILN_JUDGED_BY_METRICS,
                      kiln_test_case_text(j->test_case, "frame %u is at %.0f %% of its limits: %s",
                                          j->frame->number, 100 * j->frame->score,
                                          describe(j, &comparison, false)));
    return decide(j, KILN_TEST_PASS, KILN_JUDGED_BY_METRICS, "");
}

/* Judges a frame of a test that keeps hashes alone. */
static bool judge_by_hashes(struct judging *j)
{
    const bool known = *j->frame->pixels_expected;
    if (!check_picture(j, &j->error))
        return false;
    if (j->test_case->params->ignore_hashes)
        return decide(
            j, KILN_TEST_NEW, KILN_JUDGED_BY_NOTHING,
            kiln_test_case_text(j->test_case,
                                "frame %u: the test keeps hashes alone, and the hashes are ignored",
                                j->frame->number));
    if (state_changed(j))
        return decide(j, KILN_TEST_FAIL, KILN_JUDGED_BY_STATE,
                      describe_state(j, "no picture is kept"));
    if (!known)
        return decide(j, KILN_TEST_NEW, KILN_JUDGED_BY_NOTHING,
                      kiln_test_case_text(j->test_case, "frame %u has no accepted hash of %s in %s",
                                          j->frame->number, j->test_case->rendering.device_name,
                                          j->frame->golden));
    j->case_frame->has_golden = true;
    j->case_frame->equals_golden = strcmp(j->frame->pixels, j->frame->pixels_expected) == 0;
    if (j->case_frame->equals_golden)
        return decide(j, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS, "");
    return decide(j, KILN_TEST_FAIL, KILN_JUDGED_BY_PIXELS,
                  describe_change(j, j->test_case->params->against
                                         ? "no picture is kept"
                                         : "no picture is kept; --against PROGRAM draws it"));
}

/* Lets the program of --against draw a frame whose pixels differ. If the test keeps hashes alone,
 * that picture becomes the reference. Otherwise the golden stays the reference, and the picture is
 * removed after it was hashed. */
static bool show_against(struct judging *j)
{
    struct kiln_result_frame *frame = j->frame;
    const bool hash = j->test_case->test->golden_form == KILN_GOLDEN_HASH;
    const bool differs = frame->status == KILN_TEST_CHANGE || frame->status == KILN_TEST_FAIL;
    char path[KILN_PATH_SIZE];
    struct kiln_test_case_comparison comparison;
    if (!j->test_case->params->against || !differs)
        return true;
    const char *name =
        kiln_test_case_text(j->test_case, "frame_%04u_%s%s", frame->number,
                            hash ? "reference" : "against", kiln_test_suffix(j->test_case->test));
    if (!kiln_test_case_path(j->test_case, name, path, &j->error) ||
        !kiln_test_case_draw_against(j->test_case, frame, path, &j->error))
        return false;
    if (!hash)
        unlink(path);
    if (!hash || access(path, F_OK) != 0)
        return true;
    frame->reference = name;
    snprintf(j->goldens.paths[0], sizeof j->goldens.paths[0], "%s", path);
    j->goldens.count = 1;
    return measure(j, &comparison);
}

static bool judge(struct judging *j)
{
    if (!find_goldens(j))
        return false;
    find_expected(j);
    if (j->test_case->test->golden_form == KILN_GOLDEN_HASH)
        return judge_by_hashes(j);
    if (j->goldens.count == 0)
        return judge_new(j);
    bool known = !j->test_case->params->ignore_hashes && *j->frame->pixels_expected;
    if (!known || state_changed(j) || strcmp(j->frame->pixels, j->frame->pixels_expected) != 0)
        return judge_by_metrics(j, known);
    return copy_reference(j) && decide(j, KILN_TEST_PASS, KILN_JUDGED_BY_PIXELS, "");
}

void kiln_test_case_judge(struct kiln_test_case *test_case, size_t index)
{
    struct judging j = {.test_case = test_case,
                        .frame = &test_case->result->frames[index],
                        .case_frame = &test_case->frames[index]};
    if (judge(&j) && show_against(&j))
        return;
    j.case_frame->code = j.error.code;
    decide(&j, KILN_TEST_ERROR, KILN_JUDGED_BY_NOTHING,
           kiln_test_case_text(test_case, "frame %u: %s%s", j.frame->number, j.error.message,
                               j.case_frame->broken_golden ? "; --update failed replaces it" : ""));
}
