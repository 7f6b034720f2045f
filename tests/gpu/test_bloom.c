/* lib/post/bloom.c against a plain C reference. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "post/bloom.h"
#include "support/device.h"

struct plane { /* RGBA in double */
    int width, height;
    double *pixels;
};

static struct plane plane_create(int width, int height)
{
    struct plane p = {width, height, calloc((size_t)width * (size_t)height * 4, sizeof(double))};
    assert_non_null(p.pixels);
    return p;
}

static int clamp(int x, int high)
{
    return x < 0 ? 0 : x > high ? high : x;
}

static double *at(const struct plane *p, int x, int y)
{
    return p->pixels +
           ((size_t)clamp(y, p->height - 1) * (size_t)p->width + (size_t)clamp(x, p->width - 1)) *
               4;
}

static struct plane shrink(struct plane from, int factor)
{
    struct plane to =
        plane_create((from.width + factor - 1) / factor, (from.height + factor - 1) / factor);
    for (int y = 0; y < to.height; y++) {
        for (int x = 0; x < to.width; x++) {
            for (int i = 0; i < factor * factor; i++) {
                const double *p = at(&from, x * factor + i % factor, y * factor + i / factor);
                for (int c = 0; c < 4; c++)
                    at(&to, x, y)[c] += p[c] / (factor * factor);
            }
        }
    }
    free(from.pixels);
    return to;
}

/* The eleven weights straight from the normal distribution, sigma 2. */
static struct plane blur(struct plane from, int dx, int dy)
{
    struct plane to = plane_create(from.width, from.height);
    double sum = 0;
    for (int i = -5; i <= 5; i++)
        sum += exp(-i * i / 8.0);
    for (int y = 0; y < to.height; y++) {
        for (int x = 0; x < to.width; x++) {
            for (int i = -5; i <= 5; i++) {
                const double *p = at(&from, x + i * dx, y + i * dy);
                for (int c = 0; c < 4; c++)
                    at(&to, x, y)[c] += exp(-i * i / 8.0) / sum * p[c];
            }
        }
    }
    free(from.pixels);
    return to;
}

static void bloom_matches_c(void **state)
{
    static const int sizes[][2] = {{96, 54}, {97, 55}, {16, 16}, {5, 40}};
    struct kiln_error error = {0};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        int width = sizes[s][0], height = sizes[s][1];
        struct kiln_image source;
        kiln_image_init(&source, *state, (uint32_t)width, (uint32_t)height, GL_RGBA32F, "source");
        float *pixels = kiln_image_host(&source, KILN_OVERWRITE, &error);
        assert_non_null(pixels);
        struct plane expected = plane_create(width, height);
        srand(7);
        for (int i = 0; i < width * height * 4; i++) {
            /* mostly dark, with a few very bright sparks */
            pixels[i] = rand() % 50 == 0 ? (float)(rand() % 1000) / 10.0f : 0.01f;
            expected.pixels[i] = (double)pixels[i];
        }
        expected = blur(blur(shrink(expected, 3), 1, 0), 0, 1);
        expected = blur(blur(shrink(expected, 2), 1, 0), 0, 1);

        struct kiln_bloom_stage *stage =
            kiln_bloom_create(*state, (uint32_t)width, (uint32_t)height, GL_RGBA32F, &error);
        assert_non_null(stage);
        struct kiln_image *result = kiln_bloom_run(stage, &source, &error);
        assert_non_null(result);
        const float *got = kiln_image_host(result, KILN_READ, &error);
        assert_non_null(got);
        assert_int_equal(result->width, expected.width);
        assert_int_equal(result->height, expected.height);
        for (int i = 0; i < expected.width * expected.height * 4; i++)
            assert_true(fabs((double)got[i] - expected.pixels[i]) <=
                        1e-5 * (1.0 + expected.pixels[i]));
        free(expected.pixels);
        kiln_bloom_destroy(&stage);
        kiln_image_finish(&source);
    }
}

enum { EDGE = 240, BLURRED = EDGE / 6 };

/* The red channel, blurred in a format, of a black square with one bright pixel near its middle. */
static void blur_spark(struct kiln_device *device, GLenum format, float brightness,
                       float red[BLURRED * BLURRED])
{
    struct kiln_error error = {0};
    struct kiln_image source;
    kiln_image_init(&source, device, EDGE, EDGE, format, "source");
    float *pixels = kiln_image_host(&source, KILN_OVERWRITE, &error);
    assert_non_null(pixels);
    memset(pixels, 0, sizeof(float) * EDGE * EDGE * 4);
    pixels[(120 * EDGE + 121) * 4] = brightness;
    struct kiln_bloom_stage *stage = kiln_bloom_create(device, EDGE, EDGE, format, &error);
    assert_non_null(stage);
    struct kiln_image *result = kiln_bloom_run(stage, &source, &error);
    assert_non_null(result);
    const float *got = kiln_image_host(result, KILN_READ, &error);
    assert_non_null(got);
    for (int i = 0; i < BLURRED * BLURRED; i++)
        red[i] = got[4 * i];
    kiln_bloom_destroy(&stage);
    kiln_image_finish(&source);
}

/* Blurring moves light, it makes none: inside a large picture the sum stays. */
static void bloom_keeps_the_light(void **state)
{
    float red[BLURRED * BLURRED];
    blur_spark(*state, GL_RGBA32F, 360.0f, red);
    double sum = 0;
    for (int i = 0; i < BLURRED * BLURRED; i++)
        sum += (double)red[i];
    assert_true(fabs(36.0 * sum - 360.0) < 1e-2);
}

/* The targets of a GPU have 16 bits: a pixel that overflowed glows like a bright one. */
static void infinity_does_not_spread(void **state)
{
    float red[BLURRED * BLURRED], bright[BLURRED * BLURRED];
    blur_spark(*state, GL_RGBA16F, INFINITY, red);
    blur_spark(*state, GL_RGBA16F, 65504.0f, bright);
    assert_true(bright[20 * BLURRED + 20] > 10.0f);
    assert_memory_equal(red, bright, sizeof red);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(bloom_matches_c),
        test_on_device(bloom_keeps_the_light),
        test_on_device(infinity_does_not_spread),
    };
    return cmocka_run_group_tests_name("bloom", tests, test_device_open, test_device_close);
}
