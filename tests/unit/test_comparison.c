/* kiln_compare, as a program uses it. The rest of it is in tests/cli/cases/compare.t. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "support/pictures.h"

struct sequences {
    char folder[32], reference[64], test[64];
};

/* Frames 0-4, and 2-6 under the numbers 0-4: all differ. */
static struct sequences make_sequences(void)
{
    struct sequences s;
    test_make_folder(s.folder);
    snprintf(s.reference, sizeof s.reference, "%s/a_####.png", s.folder);
    snprintf(s.test, sizeof s.test, "%s/b_####.png", s.folder);
    struct kiln_error error = {0};
    const struct kiln_frame_range range = {0, 4}, later = {2, 6};
    struct kiln_output_params params = test_output_params(s.reference, &range);
    assert_true(test_write_all(&params, &error));
    params = test_output_params(s.test, &later);
    assert_true(test_write_all(&params, &error));
    for (int i = 2; i <= 6; i++) {
        char from[64], to[64];
        snprintf(from, sizeof from, "%s/b_%04d.png", s.folder, i);
        snprintf(to, sizeof to, "%s/b_%04d.png", s.folder, i - 2);
        assert_int_equal(rename(from, to), 0);
    }
    return s;
}

static struct kiln_compare_params params_of(const struct sequences *s)
{
    struct kiln_compare_params params = KILN_COMPARE_DEFAULTS;
    params.reference = s->reference;
    params.test = s->test;
    return params;
}

/* ---- Frames ------------------------------------------------------------------------------- */

struct seen {
    uint32_t frames;
    double first_mean;
    uint32_t stop_after;
};

static void see(void *user, const struct kiln_compare_result *result,
                const struct kiln_compare_frame *frame)
{
    struct seen *seen = user;
    char name[32];
    snprintf(name, sizeof name, "a_%04u.png", seen->frames);
    assert_string_equal(frame->name, name);
    assert_true(frame->measured && !frame->equal);
    assert_int_equal(frame->width, 64);
    assert_string_equal(result->columns[0].name, "flip.mean");
    if (seen->frames++ == 0)
        seen->first_mean = frame->values[0];
    assert_int_equal(result->frames, seen->frames);
}

static bool stop(void *user)
{
    const struct seen *seen = user;
    return seen->stop_after > 0 && seen->frames >= seen->stop_after;
}

static void frames_are_told_and_summed_up(void **state)
{
    (void)state;
    struct sequences s = make_sequences();
    struct seen seen = {0};
    struct kiln_compare_params params = params_of(&s);
    params.frame = see;
    params.stop = stop;
    params.user = &seen;
    struct kiln_compare_result result;
    struct kiln_error error = {0};
    assert_true(kiln_compare(&params, &result, &error));
    assert_true(result.sequence && !result.same && !result.hdr);
    assert_int_equal(seen.frames, 5);
    assert_int_equal(result.measured, 5);
    assert_int_equal(result.counts[KILN_COMPARE_DIFFERENT], 5);
    assert_true(result.worst[0] >= seen.first_mean && result.worst[0] >= result.mean[0]);
    assert_true(seen.first_mean > 0);

    struct seen stopped = {.stop_after = 2};
    params.user = &stopped;
    assert_false(kiln_compare(&params, &result, &error));
    assert_int_equal(error.code, KILN_INTERRUPTED);
    assert_int_equal(stopped.frames, 2);
    assert_false(result.same);
    test_remove_folder(s.folder);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    struct sequences s = make_sequences();
    struct kiln_compare_result results[3];
    static const uint32_t threads[] = {1, 2, 7};
    for (int i = 0; i < 3; i++) {
        struct kiln_compare_params params = params_of(&s);
        params.threads = threads[i];
        struct kiln_error error = {0};
        assert_true(kiln_compare(&params, &results[i], &error));
        for (size_t c = 0; c < results[i].column_count; c++)
            assert_true(results[i].worst[c] == results[0].worst[c] &&
                        results[i].mean[c] == results[0].mean[c]);
    }
    test_remove_folder(s.folder);
}

static void requests_without_sense_are_refused(void **state)
{
    (void)state;
    struct sequences s = make_sequences();
    for (int i = 0; i < 6; i++) {
        struct kiln_compare_params params = params_of(&s);
        static const char *const limit[] = {"flip.mean=2"};
        params.pixels_per_degree = i == 0 ? 3 : i == 1 ? NAN : params.pixels_per_degree;
        params.threshold = i == 2 ? -1 : params.threshold;
        params.window = i == 3 ? 0 : params.window;
        params.layer = i == 4 ? "" : params.layer;
        params.limits = limit;
        params.limit_count = i == 5;
        struct kiln_compare_result result = {.same = true};
        struct kiln_error error = {0};
        assert_false(kiln_compare(&params, &result, &error));
        assert_int_equal(error.code, KILN_USAGE);
        assert_true(error.message[0] != '\0' && !result.same);
    }
    test_remove_folder(s.folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_told_and_summed_up),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(requests_without_sense_are_refused),
    };
    return cmocka_run_group_tests_name("comparison", tests, NULL, NULL);
}
