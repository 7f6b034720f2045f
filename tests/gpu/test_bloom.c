/* Checks the bloom, the glow around bright light (lib/post/bloom*.c), by GL and by the CPU. The
 * blurs of the thesis (Heinz 2019) and of the pyramid are compared with references in double
 * precision; of the Gaussian blur, the width is checked. If this fails, the glow has the wrong
 * width or brightness, depends on the picture's size, or spreads infinity.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "post/bloom.h"
#include "support/cmocka.h"
#include "support/device.h"

static enum kiln_bloom_technique technique = KILN_BLOOM_GL;

struct plane { /* an RGBA picture in doubles */
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

/* Returns the pixel at (x, y); coordinates outside of the picture are clamped to its edge. */
static double *at(const struct plane *p, int x, int y)
{
    return p->pixels +
           ((size_t)clamp(y, p->height - 1) * (size_t)p->width + (size_t)clamp(x, p->width - 1)) *
               4;
}

/* Returns a picture that is reduced by `factor` along each axis: each pixel is the mean of factor x
 * factor pixels of `from`. Frees the pixels of `from`. */
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

/* Returns a picture blurred along (dx, dy) by eleven weights of a Gaussian with a standard
 * deviation of 2 px. Frees the pixels of `from`.
 */
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

/* Holds a bloom stage, the image that it blurs, and the scene that it reads. */
struct fixture {
    struct kiln_scene *scene;
    struct kiln_image source;
    struct kiln_threads *threads;
    struct kiln_bloom_stage *stage;
    double scale; /* width of the last result divided by the source's width */
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

/* Makes the stage for a source of width x height pixels. post: keys of the scene's section `post`;
 * format: of the source and the intermediate images. Returns the source's pixels, which the test
 * writes before the first run. */
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

/* Runs the stage. Sets `size` to the width and height of the result, px, and returns its pixels on
 * the host. */
static const float *run(struct fixture *f, const struct kiln_bloom_inputs *inputs, uint32_t size[2])
{
    struct kiln_error error = {0};
    float scale = 0;
    struct kiln_image *result = kiln_bloom_run(f->stage, inputs, &scale, &error);
    assert_non_null(result);
    f->scale = (double)scale;
    size[0] = result->width;
    size[1] = result->height;
    assert_true(fabs((double)result->width - (double)scale * f->source.width) < 1.0);
    const float *got = kiln_image_host(result, KILN_READ, &error);
    assert_non_null(got);
    return got;
}

/* Fills both pictures with the same pixels: mostly dark, with a few very bright sparks. */
static void scatter_sparks(float *pixels, struct plane *expected)
{
    for (int i = 0; i < expected->width * expected->height * 4; i++) {
        pixels[i] = rand() % 50 == 0 ? (float)(rand() % 1000) / 10.0f : 0.01f;
        expected->pixels[i] = (double)pixels[i];
    }
}

static void assert_planes_equal(const float *got, const uint32_t size[2],
                                const struct plane *expected, double tolerance)
{
    assert_int_equal(size[0], expected->width);
    assert_int_equal(size[1], expected->height);
    for (int i = 0; i < expected->width * expected->height * 4; i++) {
        double error = fabs((double)got[i] - expected->pixels[i]);
        if (error > tolerance * (1.0 + expected->pixels[i]))
            fail_msg("%d x %d: %g instead of %g", expected->width, expected->height, (double)got[i],
                     expected->pixels[i]);
    }
}

static const struct kiln_bloom_inputs NO_INPUTS = {0};

static void thesis_matches_c(void **state)
{
    static const int sizes[][2] = {{96, 54}, {97, 55}, {16, 16}, {5, 40}};
    srand(7);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        struct fixture f;
        float *pixels =
            fixture_init(&f, *state, "bloom: {kind: thesis}", sizes[s][0], sizes[s][1], GL_RGBA32F);
        struct plane expected = plane_create(sizes[s][0], sizes[s][1]);
        scatter_sparks(pixels, &expected);
        expected = blur(blur(shrink(expected, 3), 1, 0), 0, 1);
        expected = blur(blur(shrink(expected, 2), 1, 0), 0, 1);
        uint32_t size[2];
        const float *got = run(&f, &NO_INPUTS, size);
        assert_planes_equal(got, size, &expected, 1e-5);
        free(expected.pixels);
        fixture_finish(&f);
    }
}

/* Returns a picture of half the size. Each pixel is the mean of 4 x 4 pixels of `from`, weighted by
 * a tent filter, whose outer pixels also count for the neighbours. */
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

/* Returns the value of the quadratic B-spline at a distance x from its centre, px. */
static double spline(double x)
{
    x = fabs(x);
    return x < 0.5 ? 0.75 - x * x : x < 1.5 ? 0.5 * (1.5 - x) * (1.5 - x) : 0;
}

/* Mixes a pyramid level in place with `below`, the next smaller level, enlarged by quadratic
 * B-splines. radius: the share of `below` in the mix, 0 to 1. */
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

/* Returns the integral of the tent function max(0, 1 - |t|) over t from minus infinity to x. */
static double triangle_left_of(double x)
{
    x = x < -1 ? -1 : x > 1 ? 1 : x;
    return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2;
}

/* Returns a picture that is smaller by the factor `ratio` along each axis. Each pixel is a weighted
 * mean: the weight of a source pixel is the integral over it of a tent filter, which reaches
 * `ratio` source pixels to each side. */
static struct plane reduce(const struct plane *from, double ratio)
{
    struct plane to =
        plane_create((int)ceil(from->width / ratio - 1e-3), (int)ceil(from->height / ratio - 1e-3));
    int reach = (int)ratio + 2;
    for (int y = 0; y < to.height; y++) {
        for (int x = 0; x < to.width; x++) {
            double cx = (x + 0.5) * ratio - 0.5, cy = (y + 0.5) * ratio - 0.5;
            for (int j = (int)cy - reach; j <= (int)cy + reach; j++) {
                for (int i = (int)cx - reach; i <= (int)cx + reach; i++) {
                    double weight = (triangle_left_of((i + 0.5 - cx) / ratio) -
                                     triangle_left_of((i - 0.5 - cx) / ratio)) *
                                    (triangle_left_of((j + 0.5 - cy) / ratio) -
                                     triangle_left_of((j - 0.5 - cy) / ratio));
                    const double *p = at(from, i, j);
                    for (int c = 0; c < 4; c++)
                        at(&to, x, y)[c] += weight * p[c];
                }
            }
        }
    }
    return to;
}

/* Returns a level after it was mixed with the `levels` - 1 smaller levels below it. The pixels are
 * those of `level`, changed in place. missing: how many finer levels a larger picture's pyramid
 * has; for each of them, the share of the levels below is multiplied by `radius` once more. */
static struct plane pyramid(struct plane level, int missing, int levels, double radius)
{
    if (levels > 1) {
        struct plane below = pyramid(halve(&level), 0, levels - 1, radius);
        join(&level, &below, pow(radius, missing + 1));
        free(below.pixels);
    }
    return level;
}

/* The pyramid equals the reference for pictures of several heights: taller than its finest level
 * (360 rows), lower than its coarsest (11.25 rows), and between two levels. The first level is the
 * largest of 360, 180, 90, 45, 22.5 and 11.25 rows that the picture can fill, so a small picture
 * has few levels. */
static void pyramid_matches_c(void **state)
{
    static const struct {
        int width, height, missing;
        double ratio;
    } sizes[] = {{96, 54, 3, 54 / 45.0},
                 {97, 129, 2, 129 / 90.0},
                 {16, 16, 5, 16 / 11.25},
                 {5, 40, 4, 40 / 22.5},
                 {1, 1, 5, 1},
                 {20, 720, 0, 2},
                 {30, 1000, 0, 1000 / 360.0}};
    static const double radii[] = {0, 0.7, 1};
    srand(8);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        for (size_t r = 0; r < 3; r++) {
            char post[64];
            snprintf(post, sizeof post, "bloom: {kind: pyramid, radius: %g}", radii[r]);
            struct fixture f;
            float *pixels =
                fixture_init(&f, *state, post, sizes[s].width, sizes[s].height, GL_RGBA32F);
            struct plane source = plane_create(sizes[s].width, sizes[s].height);
            scatter_sparks(pixels, &source);
            struct plane expected = pyramid(reduce(&source, sizes[s].ratio), sizes[s].missing,
                                            6 - sizes[s].missing, radii[r]);
            uint32_t size[2];
            const float *got = run(&f, &NO_INPUTS, size);
            assert_planes_equal(got, size, &expected, 2e-4);
            free(source.pixels);
            free(expected.pixels);
            fixture_finish(&f);
        }
    }
}

/* Returns the value of the cubic B-spline, by which the composite stage enlarges the glow, at a
 * distance x from its centre, in pixels of the glow. */
static double cubic_spline(double x)
{
    x = fabs(x);
    return x < 1 ? (4 - 6 * x * x + 3 * x * x * x) / 6 : x < 2 ? pow(2 - x, 3) / 6 : 0;
}

/* Returns the red channel of the glow, enlarged to the frame's size, at the place (x, y), px of the
 * frame. size: width and height of the glow, px; ratio: the frame's width divided by the glow's
 * width. */
static double glow_at(const float *glow, const uint32_t size[2], double ratio, double x, double y)
{
    double cx = (x + 0.5) / ratio - 0.5, cy = (y + 0.5) / ratio - 0.5, sum = 0;
    for (int j = (int)cy - 1; j <= (int)cy + 2; j++) {
        for (int i = (int)cx - 1; i <= (int)cx + 2; i++)
            sum += cubic_spline(i - cx) * cubic_spline(j - cy) *
                   (double)glow[4 * (clamp(j, (int)size[1] - 1) * (int)size[0] +
                                     clamp(i, (int)size[0] - 1))];
    }
    return sum;
}

/* The margin on each side of the bright square is a ROOMth of the picture's height wide. */
enum { ROOM = 4 };

/* Measures the glow of a bright square in the middle of a black picture. height: of the picture,
 * px; spot: the square's edge, px; distances: `count` distances to the right of the square's
 * middle, as fractions of the picture's height; values: the red light of the glow at these
 * distances. The light of the square's pixels sums to height^2 / 1000. */
static void measure_spot(struct kiln_device *device, const char *post, int height, int spot,
                         const double *distances, size_t count, double *values)
{
    struct fixture f;
    int width = 2 * height / ROOM + spot, left = (width - spot) / 2, top = (height - spot) / 2;
    float *pixels = fixture_init(&f, device, post, width, height, GL_RGBA32F);
    memset(pixels, 0, sizeof(float) * (size_t)(width * height) * 4);
    double light = (double)height * height / (double)(spot * spot) / 1000;
    for (int y = top; y < top + spot; y++) {
        for (int x = left; x < left + spot; x++)
            pixels[4 * (y * width + x)] = (float)light;
    }
    uint32_t size[2];
    const float *glow = run(&f, &NO_INPUTS, size);
    for (size_t i = 0; i < count; i++)
        values[i] =
            glow_at(glow, size, 1 / f.scale, left + (spot - 1) / 2.0 + distances[i] * height,
                    top + (spot - 1) / 2.0);
    fixture_finish(&f);
}

/* The Gaussian bloom turns one bright pixel into a Gaussian whose standard deviation is the scene's
 * `sigma`, a fraction of the picture's height. This holds in small and large pictures, for narrow
 * and wide Gaussians, within 2 % of the peak. */
static void gaussian_is_as_wide_as_asked(void **state)
{
    static const struct {
        int height;
        double sigma;
    } cases[] = {{90, 0.02},   {181, 0.019}, {270, 0.019}, {271, 0.05},
                 {720, 0.003}, {720, 0.019}, {720, 0.08},  {1081, 0.019}};
    static const double distances[] = {0, 0.25, 0.5, 1, 1.5, 2, 3};
    enum { COUNT = sizeof distances / sizeof *distances };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char post[64];
        snprintf(post, sizeof post, "bloom: {kind: gaussian, sigma: %g}", cases[k].sigma);
        double places[COUNT], values[COUNT];
        for (int i = 0; i < COUNT; i++)
            places[i] = distances[i] * cases[k].sigma;
        measure_spot(*state, post, cases[k].height, 1, places, COUNT, values);
        double peak = 1e-3 / (2 * 3.14159265358979 * cases[k].sigma * cases[k].sigma);
        for (int i = 0; i < COUNT; i++) {
            double expected = exp(-0.5 * distances[i] * distances[i]);
            double error = fabs(values[i] / peak - expected);
            if (error > 0.02)
                fail_msg("%d rows, sigma %g: %g instead of %g of the peak at %g sigma",
                         cases[k].height, cases[k].sigma, values[i] / peak, expected, distances[i]);
        }
    }
}

/* Returns how much a picture's height changes the glow of a bright square: the largest absolute
 * difference between the glows in pictures of `height` rows and of 720 rows, divided by the peak at
 * 720 rows. The square's edge is a twentieth of each picture's height. */
static double size_error(struct kiln_device *device, const char *post, int height)
{
    static const double distances[] = {0, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.2};
    enum { COUNT = sizeof distances / sizeof *distances };
    double values[COUNT], expected[COUNT], worst = 0;
    measure_spot(device, post, 720, 36, distances, COUNT, expected);
    measure_spot(device, post, height, height / 20, distances, COUNT, values);
    for (int i = 0; i < COUNT; i++)
        worst = fmax(worst, fabs(values[i] - expected[i]) / expected[0]);
    return worst;
}

static void glow_is_the_same_part_of_any_picture(void **state)
{
    static const int heights[] = {180, 260, 360, 480, 1080};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        double gaussian = size_error(*state, "bloom: {kind: gaussian}", heights[i]);
        double pyramid = size_error(*state, "bloom: {kind: pyramid}", heights[i]);
        double thesis = size_error(*state, "bloom: {kind: thesis}", heights[i]);
        if (gaussian > 0.01 || pyramid > 0.05)
            fail_msg("%d rows: gaussian differs by %g, pyramid by %g of the peak", heights[i],
                     gaussian, pyramid);
        /* The thesis's bloom has a fixed width in pixels, so its glow must differ. */
        assert_true(thesis > 0.05);
    }
}

/* The bright pass lets through the part of the light that exceeds the threshold after exposure. The
 * light is the composition of all layers: the scene, attenuated by the particles in front of it,
 * and fire added to both. */
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
    /* The exposure doubles light. The scene's green becomes 4, of which a quarter is above the
     * threshold 3, so a quarter of the scene's light passes. Where particles of alpha 0.5 cover the
     * scene, green becomes 2, and nothing passes. With fire of red 2 added there, red becomes 2 *
     * (0.5 + 2) = 5, and 0.4 of the light passes. */
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
    static const uint32_t places[3][2] = {{1, 1}, {1, 3}, {3, 3}}; /* x, y in quarters of `size` */
    static const float expected[3][3] = {
        {0.25f, 0.5f, 0}, {0, 0, 0}, {2.5f * 0.4f, 1.0f * 0.4f, 0}};
    for (int i = 0; i < 3; i++) {
        const float *p =
            got + 4 * (places[i][1] * size[1] / 4 * size[0] + places[i][0] * size[0] / 4);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(p[c] - expected[i][c]) < 1e-5f);
    }
    for (int i = 0; i < 3; i++)
        kiln_image_finish(&inputs[i]);
    fixture_finish(&f);
}

enum { EDGE = 240, MOST = EDGE };

/* Blurs a black picture of EDGE x EDGE pixels, with one pixel of red `brightness` near its middle.
 * format: of the source and the intermediate images. Copies the red channel of the result, row by
 * row, to `red`, sets *scale to the result's width divided by EDGE, and returns the result's width,
 * which is its height too, px. */
static int spread_spark(struct kiln_device *device, const char *post, GLenum format,
                        float brightness, float red[MOST * MOST], double *scale)
{
    struct fixture f;
    float *pixels = fixture_init(&f, device, post, EDGE, EDGE, format);
    memset(pixels, 0, sizeof(float) * EDGE * EDGE * 4);
    pixels[(120 * EDGE + 121) * 4] = brightness;
    uint32_t size[2];
    const float *got = run(&f, &NO_INPUTS, size);
    for (uint32_t i = 0; i < size[0] * size[1]; i++)
        red[i] = got[4 * i];
    *scale = f.scale;
    fixture_finish(&f);
    return (int)size[0];
}

static const char *const KINDS[] = {"bloom: {kind: gaussian}", "bloom: {kind: thesis}",
                                    "bloom: {kind: pyramid, radius: 0.5}"};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

/* Blurring keeps the sum of the picture's light, if the blur does not reach the picture's edge. A
 * pixel of the result counts 1 / scale^2 times, since it covers that many pixels of the source. */
static void bloom_keeps_the_light(void **state)
{
    static float red[MOST * MOST];
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        double scale;
        int edge = spread_spark(*state, KINDS[kind], GL_RGBA32F, 360.0f, red, &scale);
        double sum = 0;
        for (int i = 0; i < edge * edge; i++)
            sum += (double)red[i];
        assert_true(fabs(sum / (scale * scale) - 360.0) < 1e-2);
    }
}

/* A pixel of infinity, to which half floats overflow, glows exactly as a pixel of 65504, the
 * largest half float. Otherwise the blur would spread infinity over the picture. */
static void infinity_does_not_spread(void **state)
{
    static float red[MOST * MOST], bright[MOST * MOST];
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        double scale;
        int edge = spread_spark(*state, KINDS[kind], GL_RGBA16F, INFINITY, red, &scale);
        spread_spark(*state, KINDS[kind], GL_RGBA16F, 65504.0f, bright, &scale);
        assert_true(bright[edge / 2 * edge + edge / 2] > 10.0f);
        assert_memory_equal(red, bright, sizeof(float) * (size_t)(edge * edge));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(thesis_matches_c),
        test_on_device(gaussian_is_as_wide_as_asked),
        test_on_device(glow_is_the_same_part_of_any_picture),
        test_on_device(pyramid_matches_c),
        test_on_device(bright_pass_takes_what_is_bright),
        test_on_device(bloom_keeps_the_light),
        test_on_device(infinity_does_not_spread),
    };
    int failed = cmocka_run_group_tests_name("gl", tests, test_device_open, test_device_close);
    technique = KILN_BLOOM_CPU;
    return failed + cmocka_run_group_tests_name("cpu", tests, test_device_open, test_device_close);
}
