/* lib/compare/flip: numbers of the authors' reference implementation, and what must hold for any
 * pair of pictures. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "compare/flip.h"
#include "compare/pool.h"
#include "support/cmocka.h"
#include "support/errors.h"

struct picture {
    uint32_t width, height;
    float *rgb;
};

static double srgb(int level)
{
    double x = level / 255.0;
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static struct picture flat(uint32_t width, uint32_t height, double r, double g, double b)
{
    struct picture p = {width, height, malloc(sizeof(float) * 3 * width * height)};
    assert_non_null(p.rgb);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        p.rgb[3 * i] = (float)r;
        p.rgb[3 * i + 1] = (float)g;
        p.rgb[3 * i + 2] = (float)b;
    }
    return p;
}

static struct kiln_error_pool flip(struct picture reference, struct picture test)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    size_t pixels = (size_t)reference.width * reference.height;
    float *errors = malloc(pixels * sizeof *errors);
    assert_true(threads && errors);
    struct kiln_flip_pair pair = {reference.rgb, test.rgb, reference.width, reference.height};
    struct kiln_error_pool summary = {0};
    if (!kiln_flip_ldr(&pair, &KILN_FLIP_DEFAULTS, threads, errors, &error) ||
        !kiln_pool_errors(errors, pixels, &summary, &error))
        fail_msg("%s", error.message);
    free(errors);
    kiln_threads_destroy(&threads);
    free(reference.rgb);
    free(test.rgb);
    return summary;
}

static void assert_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("got %.7f, expected %.7f", got, expected);
}

static void flat_pairs_match_the_reference(void **state)
{
    (void)state;
    double low = srgb(128), near = srgb(129), far = srgb(136);
    assert_near(flip(flat(70, 70, 0, 0, 0), flat(70, 70, 1, 1, 1)).mean, 0.96738, 1e-4);
    assert_near(flip(flat(70, 70, 0, 1, 0), flat(70, 70, 0, 0, 1)).mean, 1.0, 1e-4);
    assert_near(flip(flat(70, 70, 1, 0, 0), flat(70, 70, 0, 1, 0)).mean, 0.98666, 1e-4);
    assert_near(flip(flat(70, 70, low, low, low), flat(70, 70, near, near, near)).mean, 0.02986,
                1e-4);
    assert_near(flip(flat(70, 70, low, low, low), flat(70, 70, far, far, far)).mean, 0.1276, 1e-4);
    assert_near(flip(flat(70, 70, 0.1, 0.1, 0.1), flat(70, 70, 0.9, 0.9, 0.9)).mean, 0.9514, 1e-4);
}

static void a_white_pixel_matches_the_reference(void **state)
{
    (void)state;
    struct picture test = flat(64, 64, 0, 0, 0);
    for (int c = 0; c < 3; c++)
        test.rgb[3 * (32 * 64 + 32) + c] = 1.0f;
    struct kiln_error_pool s = flip(flat(64, 64, 0, 0, 0), test);
    assert_near(s.mean, 0.003493, 1e-4);
    assert_near(s.weighted_median, 0.480561, 1e-4);
    assert_near(s.maximum, 0.864906, 1e-4);
}

static struct picture edge(uint32_t white_from)
{
    struct picture p = flat(64, 64, 0, 0, 0);
    for (uint32_t i = 0; i < 64 * 64; i++) {
        for (int c = 0; c < 3; c++)
            p.rgb[3 * i + (uint32_t)c] = i % 64 >= white_from ? 1.0f : 0.0f;
    }
    return p;
}

static void a_moved_edge_matches_the_reference(void **state)
{
    (void)state;
    struct kiln_error_pool s = flip(edge(31), edge(32));
    assert_near(s.mean, 0.051732, 1e-4);
    assert_near(s.maximum, 0.772917, 1e-4);
    struct kiln_error_pool swapped = flip(edge(32), edge(31));
    assert_near(swapped.mean, s.mean, 1e-7);
    assert_near(swapped.maximum, s.maximum, 1e-7);
}

static struct picture noise(uint32_t width, uint32_t height, unsigned seed)
{
    struct picture p = flat(width, height, 0, 0, 0);
    srand(seed);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        p.rgb[i] = (float)(rand() % 1001) / 1000.0f;
    return p;
}

/* Sizes that are no multiple of a tile, one pixel, one row: no seam, nothing out of range. */
static void any_size_is_compared(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 300}, {300, 1}, {257, 65}, {511, 129}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint32_t w = sizes[i][0], h = sizes[i][1];
        struct kiln_error_pool same = flip(noise(w, h, 1), noise(w, h, 1));
        assert_true(same.mean == 0.0 && same.maximum == 0.0);
        struct kiln_error_pool other = flip(noise(w, h, 1), noise(w, h, 2));
        assert_true(other.mean > 0.05 && other.maximum <= 1.0 && other.minimum >= 0.0);
    }
}

/* Constant pictures have constant errors, at tile borders as well. */
static void tiles_leave_no_seam(void **state)
{
    (void)state;
    struct kiln_error_pool s = flip(flat(600, 150, 0.2, 0.3, 0.4), flat(600, 150, 0.25, 0.3, 0.4));
    assert_true(s.maximum > 0.01 && s.maximum - s.minimum < 1e-5);
}

static void what_is_not_finite_is_refused(void **state)
{
    (void)state;
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < 3; i++) {
        struct kiln_error error = {0};
        struct picture a = flat(8, 8, 0, 0, 0), b = flat(8, 8, 0, 0, 0);
        float errors[64];
        struct kiln_threads *threads = kiln_threads_create(1);
        struct kiln_flip_pair pair = {a.rgb, b.rgb, 8, 8};
        b.rgb[3 * (2 * 8 + 5) + 1] = bad[i];
        assert_false(kiln_flip_ldr(&pair, &KILN_FLIP_DEFAULTS, threads, errors, &error));
        expect_error(&error, KILN_INVALID_INPUT,
                     "test picture: pixel 5,2 has a value that is not finite");

        struct kiln_flip_exposures exposures = {.start = 0.0f, .stop = 1.0f, .count = 2};
        error = (struct kiln_error){0};
        assert_false(
            kiln_flip_hdr(&pair, &KILN_FLIP_DEFAULTS, &exposures, threads, errors, &error));
        expect_error(&error, KILN_INVALID_INPUT,
                     "test picture: pixel 5,2 has a value that is not finite");
        struct kiln_flip_pair turned = {b.rgb, NULL, 8, 8};
        error = (struct kiln_error){0};
        assert_false(kiln_flip_choose_exposures(&turned, &exposures, &error));
        expect_error(&error, KILN_INVALID_INPUT,
                     "reference picture: pixel 5,2 has a value that is not finite");
        kiln_threads_destroy(&threads);
        free(a.rgb);
        free(b.rgb);
    }
}

static struct kiln_error_pool hdr(struct picture reference, struct picture test)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    size_t pixels = (size_t)reference.width * reference.height;
    float *errors = malloc(pixels * sizeof *errors);
    assert_true(threads && errors);
    struct kiln_flip_pair pair = {reference.rgb, test.rgb, reference.width, reference.height};
    struct kiln_flip_exposures exposures = {0};
    struct kiln_error_pool summary = {0};
    if (!kiln_flip_choose_exposures(&pair, &exposures, &error) ||
        !kiln_flip_hdr(&pair, &KILN_FLIP_DEFAULTS, &exposures, threads, errors, &error) ||
        !kiln_pool_errors(errors, pixels, &summary, &error))
        fail_msg("%s", error.message);
    assert_true(exposures.count >= 2 && exposures.stop > exposures.start);
    free(errors);
    kiln_threads_destroy(&threads);
    free(reference.rgb);
    free(test.rgb);
    return summary;
}

static struct picture flame(double light)
{
    struct picture p = flat(64, 64, 0, 0, 0);
    for (size_t i = 3 * 1000; i < 3 * 1100; i++)
        p.rgb[i] = (float)light;
    return p;
}

/* The trap: the median of fire on black is 0, and an exposure range made from it is empty, so that
 * nothing is compared. */
static void fire_on_black_is_compared(void **state)
{
    (void)state;
    assert_true(hdr(flame(60.0), flame(20.0)).maximum > 0.1);
    /* The darkest exposure shows 20 at 0.85 of white: there is little room above. */
    assert_true(hdr(flame(20.0), flame(60.0)).maximum > 0.02);
    assert_true(hdr(flame(20.0), flame(20.0)).maximum == 0.0);
    assert_true(hdr(flame(0.0), flame(5.0)).maximum > 0.1);
    assert_true(hdr(flame(0.0), flame(0.0)).maximum == 0.0);
}

/* HDR sees what burns out at one exposure. */
static void hdr_sees_into_the_lights(void **state)
{
    (void)state;
    struct picture a = flat(64, 64, 0.2, 0.2, 0.2), b = flat(64, 64, 0.2, 0.2, 0.2);
    for (size_t i = 0; i < 64 * 20; i++) {
        a.rgb[3 * i] = a.rgb[3 * i + 1] = a.rgb[3 * i + 2] = 50.0f;
        b.rgb[3 * i] = b.rgb[3 * i + 1] = b.rgb[3 * i + 2] = 80.0f;
    }
    assert_true(hdr(a, b).mean > 0.03);
}

static void percentiles_are_weighted(void **state)
{
    (void)state;
    static const float errors[] = {0.4f, 0.1f, 0.2f, 0.3f, 0.0f};
    struct kiln_error error = {0};
    double value = 0;
    assert_true(kiln_pool_percentile(errors, 5, 0.0, &value, &error));
    assert_near(value, 0.1, 1e-7);
    assert_true(kiln_pool_percentile(errors, 5, 0.5, &value, &error));
    assert_near(value, 0.3, 1e-7); /* 0.1 + 0.2 is 0.3 of 1.0, and 0.3 more exceeds one half */
    assert_true(kiln_pool_percentile(errors, 5, 1.0, &value, &error));
    assert_near(value, 0.4, 1e-7);
    assert_false(kiln_pool_percentile(errors, 5, 1.5, &value, &error));
    assert_false(kiln_pool_percentile(errors, 0, 0.5, &value, &error));
    expect_error(&error, KILN_INVALID_INPUT, "no pixels: nothing was compared");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_pairs_match_the_reference),
        cmocka_unit_test(a_white_pixel_matches_the_reference),
        cmocka_unit_test(a_moved_edge_matches_the_reference),
        cmocka_unit_test(any_size_is_compared),
        cmocka_unit_test(tiles_leave_no_seam),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(fire_on_black_is_compared),
        cmocka_unit_test(hdr_sees_into_the_lights),
        cmocka_unit_test(percentiles_are_weighted),
    };
    return cmocka_run_group_tests_name("flip", tests, NULL, NULL);
}
