/* kiln_compare, as a program uses it. The rest of it is in tests/cli/cases/compare.t. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "asset/image/image.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

enum { MASK_SIZE = sizeof(struct kiln_compare_mask) };

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
    struct kiln_compare_params params = kiln_compare_defaults();
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
    struct kiln_compare_result result = kiln_compare_result_empty();
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
    expect_error(&error, KILN_INTERRUPTED, "stopped after 2 frames");
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
        results[i] = kiln_compare_result_empty();
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
    static const char *const messages[] = {
        "found 3 pixels a degree; allowed are 4 to 400",
        "found nan pixels a degree; allowed are 4 to 400",
        "found a threshold of -1 levels; allowed are 0 to 255",
        "found a window of 0 pixels; it needs 1 or more",
        "the name of the layer is empty",
        "limit 'flip.mean=2': expected a number, 0 to 1",
    };
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
        struct kiln_compare_result result = {.size = sizeof result, .same = true};
        struct kiln_error error = {0};
        assert_false(kiln_compare(&params, &result, &error));
        expect_error(&error, KILN_USAGE, "%s", messages[i]);
        assert_false(result.same);
    }
    test_remove_folder(s.folder);
}

/* ---- Masks -------------------------------------------------------------------------------- */

/* A PNG of one colour with a box of another. */
static void write_box(const char *path, uint32_t width, uint32_t height, uint8_t ground,
                      const uint32_t box[4], uint8_t level)
{
    struct kiln_error error = {0};
    const struct kiln_frame_range range = {0, 0};
    struct kiln_output_params params = test_output_params(path, &range);
    params.width = width;
    params.height = height;
    params.overwrite = true;
    struct kiln_output *output = kiln_output_open(&params, &error);
    assert_non_null(output);
    struct kiln_picture *picture = test_picture(output, &params, 0);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        bool inside = i % width - box[0] < box[2] && i / width - box[1] < box[3];
        memset((uint8_t *)picture->display + 4 * i, inside ? level : ground, 3);
    }
    assert_true(kiln_output_write(output, picture, &error));
    assert_true(kiln_output_finish(output, &error));
    kiln_output_close(&output);
}

struct masked {
    char folder[32], reference[64], test[64], mask[64], map[64];
    struct kiln_compare_params params;
    struct kiln_compare_result result;
    struct kiln_error error;
};

static const uint32_t fault[4] = {20, 10, 6, 4}; /* of the test, in a picture of 64 x 36 */

static void masked_setup(struct masked *m)
{
    *m = (struct masked){.params = kiln_compare_defaults(), .result = kiln_compare_result_empty()};
    test_make_folder(m->folder);
    snprintf(m->reference, sizeof m->reference, "%s/reference.png", m->folder);
    snprintf(m->test, sizeof m->test, "%s/test.png", m->folder);
    snprintf(m->mask, sizeof m->mask, "%s/mask.png", m->folder);
    snprintf(m->map, sizeof m->map, "%s/map.png", m->folder);
    write_box(m->reference, 64, 36, 90, fault, 90);
    write_box(m->test, 64, 36, 90, fault, 200);
    m->params.reference = m->reference;
    m->params.test = m->test;
}

/* Pixels that differ with one mask, or -1 for an error. */
static int differing(struct masked *m, const struct kiln_compare_mask *mask)
{
    m->params.masks = mask;
    m->params.mask_stride = MASK_SIZE;
    m->params.mask_count = mask ? 1 : 0;
    m->error = (struct kiln_error){0};
    if (!kiln_compare(&m->params, &m->result, &m->error))
        return -1;
    for (size_t i = 0; i < m->result.column_count; i++) {
        if (strcmp(m->result.columns[i].name, "differing.count") == 0)
            return (int)m->result.worst[i];
    }
    return -1;
}

static void masked_rectangles_are_not_judged(void **state)
{
    (void)state;
    struct masked m;
    masked_setup(&m);
    assert_int_equal(differing(&m, NULL), 24);
    assert_false(m.result.same);
    assert_int_equal(differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 20, 10, 6, 4, NULL}), 0);
    assert_true(m.result.same);
    assert_int_equal(differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 21, 10, 6, 4, NULL}), 4);
    assert_int_equal(
        differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 20, 11, UINT32_MAX, 2, NULL}), 12);
    assert_int_equal(differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 64, 0, 5, 5, NULL}), 24);
    assert_int_equal(differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 0, 0, 0, 36, NULL}), 24);
    assert_int_equal(differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 0, 0, 64, 36, NULL}), -1);
    expect_error(&m.error, KILN_USAGE,
                 "the masks cover all 64 x 36 pixels: nothing is left to judge");
    assert_int_equal(differing(&m, &(struct kiln_compare_mask){MASK_SIZE, 0, 0, 64, 35, NULL}), 0);
    test_remove_folder(m.folder);
}

static void mask_pictures_must_fit(void **state)
{
    (void)state;
    struct masked m;
    masked_setup(&m);
    const struct kiln_compare_mask mask = {.size = MASK_SIZE, .picture = m.mask};
    write_box(m.mask, 64, 36, 255, fault, 0);
    assert_int_equal(differing(&m, &mask), 0);
    write_box(m.mask, 64, 36, 255, fault, 1);
    assert_int_equal(differing(&m, &mask), 24);
    write_box(m.mask, 64, 36, 0, fault, 255);
    assert_int_equal(differing(&m, &mask), 24);
    write_box(m.mask, 64, 36, 0, fault, 0);
    assert_int_equal(differing(&m, &mask), -1);
    expect_error(&m.error, KILN_USAGE,
                 "the masks cover all 64 x 36 pixels: nothing is left to judge");
    write_box(m.mask, 63, 36, 255, fault, 0);
    assert_int_equal(differing(&m, &mask), -1);
    expect_error(&m.error, KILN_INVALID_INPUT,
                 "%s: the mask has 63 x 36 pixels, the pictures 64 x 36", m.mask);
    assert_int_equal(m.result.counts[KILN_COMPARE_UNREADABLE], 1);
    test_remove_folder(m.folder);
}

static void the_error_map_is_black_where_nothing_is_judged(void **state)
{
    (void)state;
    struct masked m;
    masked_setup(&m);
    m.params.error_map = m.map;
    m.params.overwrite = true;
    for (int masked = 0; masked < 2; masked++) {
        const struct kiln_compare_mask mask = {MASK_SIZE, 20, 10, 6, 4, NULL};
        assert_int_equal(differing(&m, masked ? &mask : NULL), masked ? 0 : 24);
        struct kiln_asset_image *map = kiln_asset_image_load(NULL, m.map, &m.error);
        assert_non_null(map);
        assert_true(map->width == 64 && map->height == 36);
        const uint8_t *centre = (const uint8_t *)map->pixels + 4 * (12 * 64 + 23);
        const uint8_t *corner = (const uint8_t *)map->pixels + 4 * (35 * 64 + 63);
        assert_true((centre[0] > 200) == !masked);
        assert_true(corner[0] < 8 && corner[1] < 8 && corner[2] < 8);
        kiln_asset_image_destroy(&map);
    }
    test_remove_folder(m.folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_told_and_summed_up),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(requests_without_sense_are_refused),
        cmocka_unit_test(masked_rectangles_are_not_judged),
        cmocka_unit_test(mask_pictures_must_fit),
        cmocka_unit_test(the_error_map_is_black_where_nothing_is_judged),
    };
    return cmocka_run_group_tests_name("comparison", tests, NULL, NULL);
}
