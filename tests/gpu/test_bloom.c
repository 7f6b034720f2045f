/* lib/post/bloom*.c against a plain reference: each technique. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "post/bloom.h"
#include "support/cmocka.h"
#include "support/device.h"

static enum kiln_bloom_technique technique = KILN_BLOOM_GL;

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

/* A bloom stage for an image, and the scene that it reads. */
struct fixture {
    struct kiln_scene *scene;
    struct kiln_image source;
    struct kiln_threads *threads;
    struct kiln_bloom_stage *stage;
};

static struct kiln_scene *parse(const char *post)
{
    char text[512];
    int length = snprintf(text, sizeof text, "kiln: 1\npost: {%s}\n", post);
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, (size_t)length, "test", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* Returns the source's pixels, to be written before the first run. */
static float *fixture_init(struct fixture *f, struct kiln_device *device, const char *post,
                           int width, int height, GLenum format)
{
    struct kiln_error error = {0};
    f->scene = parse(post);
    kiln_image_init(&f->source, device, (uint32_t)width, (uint32_t)height, format, "source");
    f->threads = kiln_threads_create(3);
    assert_non_null(f->threads);
    const struct kiln_bloom_params params = {technique, f->threads, &f->source, format};
    f->stage = kiln_bloom_create(device, f->scene, &params, &error);
    assert_non_null(f->stage);
    float *pixels = kiln_image_host(&f->source, KILN_OVERWRITE, &error);
    assert_non_null(pixels);
    return pixels;
}

static void fixture_finish(struct fixture *f)
{
    kiln_bloom_destroy(&f->stage);
    kiln_threads_destroy(&f->threads);
    kiln_image_finish(&f->source);
    kiln_scene_destroy(&f->scene);
}

/* Runs the stage; its result on the host. */
static const float *run(struct fixture *f, const struct kiln_bloom_inputs *inputs, uint32_t size[2])
{
    struct kiln_error error = {0};
    float scale = 0;
    struct kiln_image *result = kiln_bloom_run(f->stage, inputs, &scale, &error);
    assert_non_null(result);
    size[0] = result->width;
    size[1] = result->height;
    assert_true(fabs((double)result->width - (double)scale * f->source.width) < 1.0);
    const float *got = kiln_image_host(result, KILN_READ, &error);
    assert_non_null(got);
    return got;
}

/* Mostly dark, with a few very bright sparks; the same in expected. */
static void scatter_sparks(float *pixels, struct plane *expected)
{
    for (int i = 0; i < expected->width * expected->height * 4; i++) {
        pixels[i] = rand() % 50 == 0 ? (float)(rand() % 1000) / 10.0f : 0.01f;
        expected->pixels[i] = (double)pixels[i];
    }
}

static void assert_planes_equal(const float *got, const uint32_t size[2],
                                const struct plane *expected)
{
    assert_int_equal(size[0], expected->width);
    assert_int_equal(size[1], expected->height);
    for (int i = 0; i < expected->width * expected->height * 4; i++)
        assert_true(fabs((double)got[i] - expected->pixels[i]) <=
                    1e-5 * (1.0 + expected->pixels[i]));
}

static const struct kiln_bloom_inputs NO_INPUTS = {0};

static void gaussian_matches_c(void **state)
{
    static const int sizes[][2] = {{96, 54}, {97, 55}, {16, 16}, {5, 40}};
    srand(7);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        struct fixture f;
        float *pixels = fixture_init(&f, *state, "bloom: {kind: gaussian}", sizes[s][0],
                                     sizes[s][1], GL_RGBA32F);
        struct plane expected = plane_create(sizes[s][0], sizes[s][1]);
        scatter_sparks(pixels, &expected);
        expected = blur(blur(shrink(expected, 3), 1, 0), 0, 1);
        expected = blur(blur(shrink(expected, 2), 1, 0), 0, 1);
        uint32_t size[2];
        const float *got = run(&f, &NO_INPUTS, size);
        assert_planes_equal(got, size, &expected);
        free(expected.pixels);
        fixture_finish(&f);
    }
}

/* Tents that reach into the neighbours. */
static struct plane halve(const struct plane *from)
{
    static const double weights[4] = {0.125, 0.375, 0.375, 0.125};
    struct plane to = plane_create((from->width + 1) / 2, (from->height + 1) / 2);
    for (int i = 0; i < to.width * to.height * 16; i++) {
        int x = i / 16 % to.width, y = i / 16 / to.width, dx = i % 4, dy = i / 4 % 4;
        int sx = 2 * x - 1 + dx, sy = 2 * y - 1 + dy;
        const double *p = at(from, sx < 0 ? 0 : sx, sy < 0 ? 0 : sy);
        for (int c = 0; c < 4; c++)
            at(&to, x, y)[c] += weights[dx] * weights[dy] * p[c];
    }
    return to;
}

/* The quadratic B-spline, from its pieces. */
static double spline(double x)
{
    x = fabs(x);
    return x < 0.5 ? 0.75 - x * x : x < 1.5 ? 0.5 * (1.5 - x) * (1.5 - x) : 0;
}

static void join(struct plane *level, const struct plane *below, double radius)
{
    for (int y = 0; y < level->height; y++) {
        for (int x = 0; x < level->width; x++) {
            double sum[4] = {0};
            double cx = (x + 0.5) / 2 - 0.5, cy = (y + 0.5) / 2 - 0.5;
            for (int j = (int)floor(cy) - 1; j <= (int)floor(cy) + 2; j++) {
                for (int i = (int)floor(cx) - 1; i <= (int)floor(cx) + 2; i++) {
                    const double *p = at(below, i < 0 ? 0 : i, j < 0 ? 0 : j);
                    for (int c = 0; c < 4; c++)
                        sum[c] += spline(i - cx) * spline(j - cy) * p[c];
                }
            }
            for (int c = 0; c < 4; c++)
                at(level, x, y)[c] += radius * (sum[c] - at(level, x, y)[c]);
        }
    }
}

/* From a level down: what comes out of the pyramid's upper end. */
static struct plane pyramid(const struct plane *from, double radius)
{
    struct plane level = halve(from);
    if (level.width >= 16 && level.height >= 16) {
        struct plane below = pyramid(&level, radius);
        join(&level, &below, radius);
        free(below.pixels);
    }
    return level;
}

static void pyramid_matches_c(void **state)
{
    static const int sizes[][2] = {{96, 54}, {97, 129}, {16, 16}, {5, 40}, {1, 1}};
    static const double radii[] = {0, 0.7, 1};
    srand(8);
    for (size_t s = 0; s < 5; s++) {
        for (size_t r = 0; r < 3; r++) {
            char post[64];
            snprintf(post, sizeof post, "bloom: {kind: pyramid, radius: %g}", radii[r]);
            struct fixture f;
            float *pixels = fixture_init(&f, *state, post, sizes[s][0], sizes[s][1], GL_RGBA32F);
            struct plane source = plane_create(sizes[s][0], sizes[s][1]);
            scatter_sparks(pixels, &source);
            struct plane expected = pyramid(&source, radii[r]);
            uint32_t size[2];
            const float *got = run(&f, &NO_INPUTS, size);
            assert_planes_equal(got, size, &expected);
            free(source.pixels);
            free(expected.pixels);
            fixture_finish(&f);
        }
    }
}

/* What the bright pass lets through: the backdrop, too, and by its exposed light; fire over all. */
static void bright_pass_takes_what_is_bright(void **state)
{
    enum { SIZE = 64 };
    struct kiln_error error = {0};
    struct fixture f;
    fixture_init(&f, *state,
                 "exposure: 1, compose: separate, "
                 "bloom: {kind: pyramid, source: bright, threshold: 3, radius: 0}",
                 SIZE, SIZE, GL_RGBA32F);
    struct kiln_image inputs[3];
    static const char *const labels[] = {"scene", "particles", "fire"};
    /* After exposure the scene alone is 4 in green, beyond 3 by a quarter of itself; half covered
     * by particles it is 2; with a fire of 1.5 over that, 5 in red. */
    static const float colors[3][4] = {{1, 2, 0, 1}, {0, 0, 0, 0.5f}, {2, 0, 0, 0}};
    for (int i = 0; i < 3; i++) {
        kiln_image_init(&inputs[i], *state, SIZE, SIZE, GL_RGBA32F, labels[i]);
        float *p = kiln_image_host(&inputs[i], KILN_OVERWRITE, &error);
        assert_non_null(p);
        for (int k = 0; k < SIZE * SIZE; k++) {
            bool there = i == 0 || (i == 1 && k / SIZE >= SIZE / 2) ||
                         (i == 2 && k / SIZE >= SIZE / 2 && k % SIZE >= SIZE / 2);
            for (int c = 0; c < 4; c++)
                p[4 * k + c] = there ? colors[i][c] : 0;
        }
    }
    const struct kiln_bloom_inputs all = {&inputs[0], &inputs[1], &inputs[2], 0};
    uint32_t size[2];
    const float *got = run(&f, &all, size);
    static const int places[3][2] = {{8, 8}, {8, 24}, {24, 24}}; /* of 32x32 */
    static const float expected[3][3] = {
        {0.25f, 0.5f, 0}, {0, 0, 0}, {2.5f * 0.4f, 1.0f * 0.4f, 0}};
    for (int i = 0; i < 3; i++) {
        const float *p = got + 4 * (places[i][1] * 32 + places[i][0]);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(p[c] - expected[i][c]) < 1e-5f);
    }
    for (int i = 0; i < 3; i++)
        kiln_image_finish(&inputs[i]);
    fixture_finish(&f);
}

enum { EDGE = 240, MOST = EDGE / 2 };

/* The red channel, spread in a format, of a black square with one bright pixel near its middle;
 * returns the edge of the result. */
static int spread_spark(struct kiln_device *device, const char *post, GLenum format,
                        float brightness, float red[MOST * MOST])
{
    struct fixture f;
    float *pixels = fixture_init(&f, device, post, EDGE, EDGE, format);
    memset(pixels, 0, sizeof(float) * EDGE * EDGE * 4);
    pixels[(120 * EDGE + 121) * 4] = brightness;
    uint32_t size[2];
    const float *got = run(&f, &NO_INPUTS, size);
    for (uint32_t i = 0; i < size[0] * size[1]; i++)
        red[i] = got[4 * i];
    fixture_finish(&f);
    return (int)size[0];
}

static const char *const KINDS[] = {"bloom: {kind: gaussian}",
                                    "bloom: {kind: pyramid, radius: 0.5}"};

/* Blurring moves light, it makes none: inside a large picture the sum stays. */
static void bloom_keeps_the_light(void **state)
{
    static float red[MOST * MOST];
    for (int kind = 0; kind < 2; kind++) {
        int edge = spread_spark(*state, KINDS[kind], GL_RGBA32F, 360.0f, red);
        double sum = 0;
        for (int i = 0; i < edge * edge; i++)
            sum += (double)red[i];
        double share = (double)EDGE / edge;
        assert_true(fabs(share * share * sum - 360.0) < 1e-2);
    }
}

/* The targets of a GPU have 16 bits: a pixel that overflowed glows like a bright one. */
static void infinity_does_not_spread(void **state)
{
    static float red[MOST * MOST], bright[MOST * MOST];
    for (int kind = 0; kind < 2; kind++) {
        int edge = spread_spark(*state, KINDS[kind], GL_RGBA16F, INFINITY, red);
        spread_spark(*state, KINDS[kind], GL_RGBA16F, 65504.0f, bright);
        assert_true(bright[edge / 2 * edge + edge / 2] > 10.0f);
        assert_memory_equal(red, bright, sizeof(float) * (size_t)(edge * edge));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(gaussian_matches_c),
        test_on_device(pyramid_matches_c),
        test_on_device(bright_pass_takes_what_is_bright),
        test_on_device(bloom_keeps_the_light),
        test_on_device(infinity_does_not_spread),
    };
    int failed = cmocka_run_group_tests_name("gl", tests, test_device_open, test_device_close);
    technique = KILN_BLOOM_CPU;
    return failed + cmocka_run_group_tests_name("cpu", tests, test_device_open, test_device_close);
}
