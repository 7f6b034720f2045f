/* Checks the composite stage (lib/post/composite*.c), which makes the final picture, by GL and by
 * the CPU. Composition of scene, particles and fire, exposure, and ACES tone mapping are compared
 * with formulas in double precision. AgX tone mapping, dither and alpha are checked for the
 * properties that they must have. If this fails, pictures have wrong colours, banding or black
 * pixels, or transparent pictures lose light when they are put over another background. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "post/composite.h"
#include "support/cmocka.h"
#include "support/device.h"

enum { WIDTH = 48, HEIGHT = 36, PIXELS = WIDTH * HEIGHT };

static enum kiln_composite_technique technique = KILN_COMPOSITE_GL;
static bool texture = false; /* fixture_init sets kiln_composite_params.texture to this */

static struct kiln_scene *parse(const char *post)
{
    char text[1024];
    int length = snprintf(text, sizeof text,
                          "kiln: 1\noutput: {size: [%d, %d], frames: 2}\n"
                          "camera: {position: [0, 1, 5], target: [0, 1, 0]}\n"
                          "post: {dither: false, %s}\n",
                          WIDTH, HEIGHT, post);
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, (size_t)length, "test", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* Makes an image of random premultiplied colours. scale: the largest light that a channel has where
 * alpha is 1; opaque: true if all alphas are 1, false if they are random. */
static void fill(struct kiln_image *image, void *device, const char *label, float scale,
                 bool opaque)
{
    struct kiln_error error = {0};
    kiln_image_init(image, device, WIDTH, HEIGHT, GL_RGBA32F, label);
    float *p = kiln_image_host(image, KILN_OVERWRITE, &error);
    assert_non_null(p);
    for (int i = 0; i < PIXELS; i++, p += 4) {
        p[3] = opaque ? 1.0f : (float)(rand() % 1001) / 1000.0f;
        for (int c = 0; c < 3; c++)
            p[c] = scale * p[3] * (float)(rand() % 1001) / 1000.0f;
    }
}

/* Returns the sRGB value, 0 to 1, of linear display light from 0 to 1. */
static double encode(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

static double clamp01(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* Replaces linear red, green and blue by the result of Stephen Hill's fit of the ACES tone mapping,
 * linear and from 0 to 1. */
static void aces(double v[3])
{
    static const double in[3][3] = {
        {0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
    static const double out[3][3] = {{1.60475, -0.53108, -0.07367},
                                     {-0.10208, 1.10813, -0.00605},
                                     {-0.00327, -0.07276, 1.07602}};
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
        a[i] = in[i][0] * v[0] + in[i][1] * v[1] + in[i][2] * v[2];
        b[i] = (a[i] * (a[i] + 0.0245786) - 0.000090537) /
               (a[i] * (0.983729 * a[i] + 0.4329510) + 0.238081);
    }
    for (int i = 0; i < 3; i++)
        v[i] = clamp01(out[i][0] * b[0] + out[i][1] * b[1] + out[i][2] * b[2]);
}

/* Computes the expected display colour of a pixel without bloom: sRGB and alpha, 0 to 1. scene,
 * particles, fire: premultiplied, linear; fire is NULL for none; exposure: in stops; use_aces:
 * false for no tone mapping. */
static void reference(const float *scene, const float *particles, const float *fire,
                      double exposure, bool use_aces, double out[4])
{
    double color[4];
    for (int c = 0; c < 4; c++)
        color[c] = (double)particles[c] + (double)scene[c] * (1.0 - (double)particles[3]);
    if (fire) {
        double alpha = fmin((double)fire[3], 1.0);
        for (int c = 0; c < 4; c++)
            color[c] = (c < 3 ? (double)fire[c] : alpha) + color[c] * (1.0 - alpha);
    }
    for (int c = 0; c < 3; c++)
        color[c] *= exp2(exposure);
    if (use_aces)
        aces(color);
    for (int c = 0; c < 3; c++)
        out[c] = encode(clamp01(color[c]));
    out[3] = 1.0;
}

/* Holds a composite stage, its scene and its images. Only the images in `inputs` are composed; a
 * test sets them. */
struct fixture {
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_composite_stage *stage;
    struct kiln_image back, particles, fire;
    struct kiln_composite_inputs inputs;
};

/* Makes the stage, a random opaque backdrop, and random particles and fire. light: the largest
 * light in a channel of particles of alpha 1; 0 makes all particles fully transparent. bits: per
 * channel of the display picture, 8 or 16. */
static void fixture_init(struct fixture *f, void *device, const char *post, uint32_t bits,
                         float light)
{
    struct kiln_error error = {0};
    *f = (struct fixture){.scene = parse(post)};
    srand(11);
    fill(&f->back, device, "scene", 1.5f, true);
    fill(&f->particles, device, "particles", light, false);
    fill(&f->fire, device, "fire", 3.0f, false);
    if (light == 0.0f)
        memset(f->particles.host, 0, sizeof(float) * PIXELS * 4);
    f->threads = kiln_threads_create(2);
    assert_non_null(f->threads);
    const struct kiln_composite_params params = {
        .technique = technique, .threads = f->threads, .bits = bits, .texture = texture};
    f->stage = kiln_composite_create(device, f->scene, &params, &error);
    assert_non_null(f->stage);
    f->inputs = (struct kiln_composite_inputs){.scene = &f->back, .particles = &f->particles};
}

static void fixture_finish(struct fixture *f)
{
    kiln_composite_destroy(&f->stage);
    kiln_threads_destroy(&f->threads);
    kiln_image_finish(&f->back);
    kiln_image_finish(&f->particles);
    kiln_image_finish(&f->fire);
    kiln_scene_destroy(&f->scene);
}

/* Returns the backdrop's pixels, linear RGBA, all of which the test must write before the first
 * run. */
static float *backdrop_pixels(struct fixture *f)
{
    struct kiln_error error = {0};
    float *pixels = kiln_image_host(&f->back, KILN_OVERWRITE, &error);
    assert_non_null(pixels);
    return pixels;
}

/* Runs the stage and reads the display picture into `got`: 4 * PIXELS values, uint8_t or uint16_t,
 * as the stage has 8 or 16 bits a channel. */
static void run(struct fixture *f, void *got)
{
    struct kiln_error error = {0};
    assert_true(kiln_composite_run(f->stage, &f->inputs, &error));
    assert_true(kiln_composite_read_display(f->stage, got, &error));
}

/* Compares the picture of random images with the colours of `reference`, pixel by pixel. */
static void check(void *device, const char *post, uint32_t bits, bool with_fire, double exposure,
                  bool use_aces)
{
    struct fixture f;
    fixture_init(&f, device, post, bits, 2.0f);
    f.inputs.fire = with_fire ? &f.fire : NULL;
    uint16_t got[PIXELS * 4];
    run(&f, got);
    double levels = bits == 16 ? 65535.0 : 255.0;
    double tolerance = bits == 16 ? 6.0 : 1.0; /* levels; pow and log2 of drivers are inexact */
    for (int i = 0; i < PIXELS; i++) {
        double expected[4];
        reference(f.back.host + 4 * i, f.particles.host + 4 * i,
                  with_fire ? f.fire.host + 4 * i : NULL, exposure, use_aces, expected);
        for (int c = 0; c < 4; c++) {
            double value =
                bits == 16 ? (double)got[4 * i + c] : (double)((const uint8_t *)got)[4 * i + c];
            assert_true(fabs(value - levels * expected[c]) <= tolerance);
        }
    }
    fixture_finish(&f);
}

static void merged_matches_c(void **state)
{
    check(*state, "tonemap: none", 8, false, 0.0, false);
    check(*state, "tonemap: none, exposure: -1.5", 16, false, -1.5, false);
}

static void separate_fire_matches_c(void **state)
{
    check(*state, "tonemap: none, compose: separate", 16, true, 0.0, false);
}

static void aces_matches_c(void **state)
{
    check(*state, "tonemap: aces", 16, false, 0.0, true);
}

/* AgX tone mapping turns grey light into greys that grow with the light: light 0.18 becomes about
 * the middle of the range, light ten stops darker black, and light ten stops brighter white. */
static void agx_keeps_greys_neutral(void **state)
{
    struct fixture f;
    fixture_init(&f, *state, "tonemap: agx", 16, 0.0f);
    float *p = backdrop_pixels(&f);
    for (int i = 0; i < PIXELS; i++) {
        float grey = 0.18f * exp2f(-10.0f + 20.0f * (float)i / PIXELS); /* a ramp of 20 stops */
        p[4 * i] = p[4 * i + 1] = p[4 * i + 2] = grey;
        p[4 * i + 3] = 1.0f;
    }
    uint16_t got[PIXELS * 4];
    run(&f, got);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(abs(got[4 * i] - got[4 * i + 1]) < 200 &&
                    abs(got[4 * i] - got[4 * i + 2]) < 200);
        assert_true(i == 0 || got[4 * i] + 2 >= got[4 * (i - 1)]);
    }
    assert_true(got[0] < 1000);
    assert_true(got[4 * (PIXELS - 1)] > 64000);
    double middle = got[4 * (PIXELS / 2)] / 65535.0; /* display value of light 0.18, 0 to 1 */
    assert_true(middle > 0.42 && middle < 0.52);
    fixture_finish(&f);
}

/* Each tone mapping shows extreme light as white: 1e20, whose square overflows a float, and
 * infinity, to which half floats overflow. If its arithmetic made a NaN of such light, the pixel
 * would be black. */
static void any_brightness_is_white(void **state)
{
    static const char *const posts[] = {"tonemap: none", "tonemap: agx", "tonemap: aces"};
    for (size_t k = 0; k < 3; k++) {
        struct fixture f;
        fixture_init(&f, *state, posts[k], 8, 0.0f);
        float *p = backdrop_pixels(&f);
        for (int i = 0; i < PIXELS * 4; i++)
            p[i] = i % 4 == 3 ? 1.0f : i < PIXELS ? 1e20f : i < 2 * PIXELS ? INFINITY : 1e5f;
        uint8_t got[PIXELS * 4];
        run(&f, got);
        for (int i = 0; i < PIXELS * 4; i++)
            assert_true(got[i] >= 250);
        fixture_finish(&f);
    }
}

/* Dither changes each pixel by at most two levels and keeps the mean of the picture. It gives the
 * same picture each time for the same frame, and another picture for another frame. */
static void dither_is_small_and_repeatable(void **state)
{
    struct fixture f;
    fixture_init(&f, *state, "tonemap: none", 8, 0.0f);
    f.scene->post.dither = true;
    float *p = backdrop_pixels(&f);
    for (int i = 0; i < PIXELS * 4; i++)
        p[i] = i % 4 == 3 ? 1.0f : 0.2160f; /* light whose sRGB value is 128.04 of 255 levels */
    f.inputs.frame = 5;
    uint8_t first[PIXELS * 4], again[PIXELS * 4], other[PIXELS * 4];
    run(&f, first);
    run(&f, again);
    f.inputs.frame = 6;
    run(&f, other);
    assert_memory_equal(first, again, sizeof first);
    assert_memory_not_equal(first, other, sizeof first);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_true(first[4 * i] >= 127 && first[4 * i] <= 130);
        sum += first[4 * i];
    }
    assert_true(fabs(sum / PIXELS - 255.0 * encode(0.2160)) < 0.05);
    fixture_finish(&f);
}

/* A picture without a backdrop has straight (not premultiplied) alpha: alpha times the sRGB value
 * equals the sRGB value of the particles' light. So a viewer that blends sRGB values over black
 * shows the right light. */
static void transparent_pictures_keep_the_light(void **state)
{
    struct fixture f;
    fixture_init(&f, *state, "tonemap: none", 16, 0.9f);
    memset(backdrop_pixels(&f), 0, sizeof(float) * PIXELS * 4);
    uint16_t got[PIXELS * 4];
    run(&f, got);
    for (int i = 0; i < PIXELS; i++) {
        const float *light = f.particles.host + 4 * i;
        double alpha = got[4 * i + 3] / 65535.0;
        assert_true(alpha + 1e-4 >= (double)light[3]);
        for (int c = 0; c < 3; c++) {
            double over_black = alpha * got[4 * i + c] / 65535.0;
            assert_true(fabs(over_black - encode((double)light[c])) < 2e-4);
        }
    }
    fixture_finish(&f);
}

/* Returns the linear display light, 0 to 1, of an sRGB value from 0 to 1. */
static double decode(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

/* Other renderers blend textures in linear light. So in a picture made as a texture, alpha times
 * the linear light of the colour equals the linear light that the usual picture shows over black.
 */
static void textures_keep_the_light(void **state)
{
    static const char *const posts[] = {"tonemap: none", "tonemap: agx", "tonemap: aces"};
    for (size_t k = 0; k < 3; k++) {
        uint16_t got[2][PIXELS * 4];
        int covered = 0, shining = 0;
        for (size_t i = 0; i < 2; i++) {
            struct fixture f;
            texture = i == 1;
            fixture_init(&f, *state, posts[k], 16, 0.9f);
            texture = false;
            memset(backdrop_pixels(&f), 0, sizeof(float) * PIXELS * 4);
            for (int p = 0; p < PIXELS; p += 2) /* like fire, with more light than alpha */
                f.particles.host[4 * p + 3] *= 0.1f;
            run(&f, got[i]);
            for (int p = 0; p < PIXELS && i == 1; p++) {
                const double alpha = got[1][4 * p + 3] / 65535.0;
                const double own = (double)f.particles.host[4 * p + 3];
                assert_true(alpha + 1e-4 >= own);
                covered += fabs(alpha - own) < 1e-4;
                shining += alpha > own + 1e-3;
            }
            fixture_finish(&f);
        }
        for (int p = 0; p < PIXELS * 4; p++) {
            const double shown = got[0][p] / 65535.0 * got[0][p | 3] / 65535.0;
            const double light = decode(got[1][p] / 65535.0) * got[1][p | 3] / 65535.0;
            assert_true(p % 4 == 3 || fabs(light - decode(shown)) < 4e-4);
        }
        assert_true(covered > PIXELS / 4 && shining > PIXELS / 4);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(merged_matches_c),
        test_on_device(separate_fire_matches_c),
        test_on_device(aces_matches_c),
        test_on_device(agx_keeps_greys_neutral),
        test_on_device(any_brightness_is_white),
        test_on_device(dither_is_small_and_repeatable),
        test_on_device(transparent_pictures_keep_the_light),
        test_on_device(textures_keep_the_light),
    };
    int failed = cmocka_run_group_tests_name("gl", tests, test_device_open, test_device_close);
    technique = KILN_COMPOSITE_CPU;
    return failed + cmocka_run_group_tests_name("cpu", tests, test_device_open, test_device_close);
}
