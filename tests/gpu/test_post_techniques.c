/* Checks that the GL and host techniques of the stages `bloom` (blur of bright light) and
 * `composite` (layers, exposure, tone mapping, dither) give the same picture, for any size. On the
 * host, the number of threads must change no byte. If this fails, the look of a scene depends on
 * the device. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "post/bloom.h"
#include "post/composite.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/scenes.h"

static struct kiln_scene *parse(const char *post, uint32_t width, uint32_t height)
{
    char text[512];
    snprintf(text, sizeof text, "kiln: 1\npost: {%s}\n", post);
    struct kiln_scene *scene = load_scene(text, NULL);
    scene->width = width;
    scene->height = height;
    return scene;
}

/* Fills an image with random premultiplied colours, from faint to 16 times as bright as white.
 * opaque: alpha is 1; otherwise it is random, from 0 to most_alpha. */
static void fill(struct kiln_image *image, void *device, uint32_t width, uint32_t height,
                 const char *label, bool opaque, float most_alpha)
{
    struct kiln_error error = {0};
    kiln_image_init(image, device, width, height, GL_RGBA32F, label);
    float *p = kiln_image_host(image, KILN_OVERWRITE, &error);
    assert_non_null(p);
    for (size_t i = 0; i < (size_t)width * height; i++, p += 4) {
        p[3] = opaque ? 1.0f : most_alpha * (float)(rand() % 1001) / 1000.0f;
        float light = ldexpf((float)(rand() % 1000) / 1000.0f, rand() % 14 - 9);
        for (int c = 0; c < 3; c++)
            p[c] = light * (float)(rand() % 1001) / 1000.0f;
    }
}

struct inputs {
    struct kiln_image scene, particles, fire, bloom;
    struct kiln_composite_inputs all;
};

/* One case for check_composite: the picture's size, px; the bits of each channel of the displayed
 * picture, 8 or 16; the layers that are composed; and the size of the bloom relative to the
 * picture. */
struct variant {
    uint32_t width, height, bits;
    bool transparent, particles, fire, bloom;
    float bloom_scale;
};

static void inputs_init(struct inputs *in, void *device, const struct variant *v)
{
    *in = (struct inputs){.all = {.frame = 17, .bloom_scale = v->bloom_scale}};
    uint32_t w = v->width, h = v->height;
    uint32_t small_width = (uint32_t)ceilf((float)w * v->bloom_scale);
    uint32_t small_height = (uint32_t)ceilf((float)h * v->bloom_scale);
    fill(&in->scene, device, w, h, "scene", !v->transparent, 0.7f);
    fill(&in->particles, device, w, h, "particles", false, 1.0f);
    fill(&in->fire, device, w, h, "fire", false, 3.0f);
    fill(&in->bloom, device, small_width, small_height, "bloom", false, 1.0f);
    in->all.scene = &in->scene;
    in->all.particles = v->particles ? &in->particles : NULL;
    in->all.fire = v->fire ? &in->fire : NULL;
    in->all.bloom = v->bloom ? &in->bloom : NULL;
}

static void inputs_finish(struct inputs *in)
{
    kiln_image_finish(&in->scene);
    kiln_image_finish(&in->particles);
    kiln_image_finish(&in->fire);
    kiln_image_finish(&in->bloom);
}

struct composed {
    uint8_t *display;
    float *beauty;
};

static struct composed compose(void *device, const struct kiln_scene *scene,
                               enum kiln_composite_technique technique, uint32_t threads,
                               uint32_t bits, const struct kiln_composite_inputs *inputs)
{
    struct kiln_error error = {0};
    size_t channels = (size_t)scene->width * scene->height * 4;
    struct composed out = {malloc(channels * bits / 8), malloc(channels * sizeof(float))};
    struct kiln_threads *workers = kiln_threads_create(threads);
    const struct kiln_composite_params params = {technique, workers, bits, true, false};
    struct kiln_composite_stage *stage = kiln_composite_create(device, scene, &params, &error);
    assert_non_null(stage);
    assert_true(kiln_composite_run(stage, inputs, &error));
    assert_true(kiln_composite_read_display(stage, out.display, &error));
    assert_true(kiln_composite_take_beauty(stage, &out.beauty, &error));
    kiln_composite_destroy(&stage);
    kiln_threads_destroy(&workers);
    return out;
}

static void composed_free(struct composed *c)
{
    free(c->display);
    free(c->beauty);
}

/* Checks that two composites are equal except for rounding. Displayed values may differ by 1 of
 * 8-bit levels or 12 of 16-bit levels, and on average by 0.02 or 2. Linear values may differ by a
 * relative 1e-5. glow: bloom is magnified in the picture; then linear values, of up to 16, may also
 * differ by 1e-3, since GL computes texture coordinates less exactly. */
static void assert_alike(const struct composed *a, const struct composed *b, size_t channels,
                         uint32_t bits, bool glow, const char *what)
{
    double sum = 0;
    int most = 0;
    for (size_t i = 0; i < channels; i++) {
        int x = bits == 8 ? a->display[i] : ((const uint16_t *)(const void *)a->display)[i];
        int y = bits == 8 ? b->display[i] : ((const uint16_t *)(const void *)b->display)[i];
        most = abs(x - y) > most ? abs(x - y) : most;
        sum += abs(x - y);
        double allowed =
            (1e-5 + test_rounding()) * fabs((double)a->beauty[i]) + (glow ? 1e-3 : 1e-8);
        assert_true(fabs((double)(a->beauty[i] - b->beauty[i])) <= allowed);
    }
    print_message("%s, %u bits: at most %d, mean %.5f\n", what, bits, most, sum / (double)channels);
    assert_true(most <= (bits == 8 ? 1 : 12));
    assert_true(sum / (double)channels < (bits == 8 ? 0.02 : 2.0));
}

static void check_composite(void *device, const char *post, const struct variant *v)
{
    struct kiln_scene *scene = parse(post, v->width, v->height);
    struct inputs in;
    inputs_init(&in, device, v);
    size_t channels = (size_t)v->width * v->height * 4;
    struct composed gl = compose(device, scene, KILN_COMPOSITE_GL, 1, v->bits, &in.all);
    struct composed one = compose(device, scene, KILN_COMPOSITE_CPU, 1, v->bits, &in.all);
    struct composed three = compose(device, scene, KILN_COMPOSITE_CPU, 3, v->bits, &in.all);
    assert_memory_equal(one.display, three.display, channels * v->bits / 8);
    assert_memory_equal(one.beauty, three.beauty, channels * sizeof(float));
    assert_alike(&gl, &one, channels, v->bits, v->bloom, post);
    composed_free(&gl);
    composed_free(&one);
    composed_free(&three);
    inputs_finish(&in);
    kiln_scene_destroy(&scene);
}

/* Composites agree for every tone mapping, with and without dither, and for several combinations of
 * layers. */
static void composites_are_alike(void **state)
{
    static const char *const posts[] = {
        "tonemap: none",
        "tonemap: none, dither: false, exposure: -2.5",
        "tonemap: agx",
        "tonemap: agx, dither: false",
        "tonemap: aces, bloom: {strength: 0.3}",
        "tonemap: aces, dither: false, exposure: 1.3",
    };
    srand(3);
    for (size_t k = 0; k < sizeof posts / sizeof *posts; k++) {
        for (uint32_t set = 0; set < 6; set++) {
            const struct variant v = {
                .width = 301,
                .height = 173,
                .bits = set % 2 ? 16 : 8,
                .transparent = set == 2 || set == 3,
                .particles = set < 5,
                .fire = set == 1 || set == 2 || set == 4,
                .bloom = set != 0,
                .bloom_scale = set < 4 ? 1.0f / 6.0f : 0.5f,
            };
            check_composite(*state, posts[k], &v);
        }
    }
}

/* Composites agree for pictures that are smaller than a work group or have odd sizes. */
static void composites_of_any_size_are_alike(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {3, 5}, {5, 3}, {1, 300}, {257, 2}, {128, 9}};
    srand(4);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        for (int half = 0; half < 2; half++) {
            const struct variant v = {
                .width = sizes[s][0],
                .height = sizes[s][1],
                .bits = 8,
                .particles = true,
                .bloom = true,
                .bloom_scale = half ? 0.5f : 1.0f / 6.0f,
            };
            check_composite(*state, "tonemap: agx", &v);
        }
    }
}

/* ---- bloom ----------------------------------------------------------------------------------- */

/* Runs the bloom stage. Returns an array of floats, RGBA, which the caller frees: first the blurred
 * bloom, then the bright light that was blurred. *count becomes the number of floats. */
static float *glow(void *device, const struct kiln_scene *scene,
                   enum kiln_bloom_technique technique, uint32_t threads, struct inputs *in,
                   size_t *count)
{
    struct kiln_error error = {0};
    struct kiln_threads *workers = kiln_threads_create(threads);
    struct kiln_image source;
    size_t pixels = (size_t)scene->width * scene->height * 4;
    kiln_image_init(&source, device, scene->width, scene->height, GL_RGBA32F, "source");
    float *to = kiln_image_host(&source, KILN_OVERWRITE, &error);
    memcpy(to, kiln_image_host(&in->fire, KILN_READ, &error), pixels * sizeof *to);
    const struct kiln_bloom_params params = {technique, workers, &source, GL_RGBA32F};
    struct kiln_bloom_stage *stage = kiln_bloom_create(device, scene, &params, &error);
    assert_non_null(stage);
    const struct kiln_bloom_inputs inputs = {in->all.scene, in->all.particles, in->all.fire, 0};
    float scale = 0.0f;
    struct kiln_image *result = kiln_bloom_run(stage, &inputs, &scale, &error);
    assert_non_null(result);
    size_t small = (size_t)result->width * result->height * 4;
    *count = small + pixels;
    float *out = malloc(*count * sizeof *out);
    memcpy(out, kiln_image_host(result, KILN_READ, &error), small * sizeof *out);
    memcpy(out + small, kiln_image_host(&source, KILN_READ, &error), pixels * sizeof *out);
    kiln_bloom_destroy(&stage);
    kiln_image_finish(&source);
    kiln_threads_destroy(&workers);
    return out;
}

static void check_bloom(void *device, const char *post, const struct variant *v)
{
    struct kiln_scene *scene = parse(post, v->width, v->height);
    struct inputs in;
    inputs_init(&in, device, v);
    size_t count = 0;
    float *gl = glow(device, scene, KILN_BLOOM_GL, 1, &in, &count);
    float *one = glow(device, scene, KILN_BLOOM_CPU, 1, &in, &count);
    float *three = glow(device, scene, KILN_BLOOM_CPU, 3, &in, &count);
    assert_memory_equal(one, three, count * sizeof *one);
    for (size_t i = 0; i < count; i++)
        assert_true(fabs((double)(gl[i] - one[i])) <= 1e-5 * fmax(0.1, fabs((double)gl[i])));
    free(gl);
    free(one);
    free(three);
    inputs_finish(&in);
    kiln_scene_destroy(&scene);
}

/* Blooms of every kind agree, for pictures of several sizes and with and without a layer of
 * fire. */
static void blooms_are_alike(void **state)
{
    static const char *const posts[] = {
        "bloom: {kind: thesis}",
        "bloom: {kind: gaussian}",
        "bloom: {kind: gaussian, sigma: 0.1}",
        "bloom: {kind: gaussian, source: bright, threshold: 0.8}, exposure: 1.5",
        "bloom: {kind: pyramid, radius: 0.7}",
        "bloom: {kind: pyramid, source: bright, threshold: 2}",
    };
    static const uint32_t sizes[][2] = {{1, 1}, {3, 5}, {301, 173}, {2, 64}, {96, 48}};
    srand(5);
    for (size_t k = 0; k < sizeof posts / sizeof *posts; k++) {
        for (uint32_t s = 0; s < 2 * sizeof sizes / sizeof *sizes; s++) {
            const struct variant v = {
                .width = sizes[s / 2][0],
                .height = sizes[s / 2][1],
                .particles = true,
                .fire = s % 2 != 0,
                .bloom_scale = 0.5f,
            };
            check_bloom(*state, posts[k], &v);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(composites_are_alike),
        test_on_device(composites_of_any_size_are_alike),
        test_on_device(blooms_are_alike),
    };
    return cmocka_run_group_tests_name("post", tests, test_device_open, test_device_close);
}
