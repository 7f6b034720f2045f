/* Checks particles that are drawn at half or a quarter of the picture's resolution and then
 * enlarged. They must look nearly as at full resolution and the same in GL and on the host, and
 * smoke behind an object must not bleed over the object's edges. If this fails, smoke has halos or
 * holes at edges, or looks different on another machine. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/simd.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/frame.h"

enum { WIDTH = 101, HEIGHT = 67, PIXELS = WIDTH * HEIGHT };

/* A scene with smoke and fire behind a post and in front of a wall, and a glowing sphere. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [101, 67], fps: 60, frames: 60}\n"
    "camera: {position: [0, 1, 4], target: [0, 1, 0]}\n"
    "backdrop:\n"
    "  objects:\n"
    "    - box: {center: [-0.4, 1, 1], size: [0.3, 3, 0.3]}\n"
    "    - box: {center: [0.8, 1, -1], size: [1, 3, 0.3]}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 60, life: 2 s, speed: 1 m/s, from: {sphere: {origin: [0, 1, 0]}}}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:smoke', size: 1.2 m, opacity: 0.8, color: 0.3, lit: 0, soft: 2}\n"
    "  fire:\n"
    "    emit: {rate: 60, life: 1 s, speed: 1 m/s, from: {sphere: {origin: [0, 1, 0]}}}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', blend: add, size: 0.9 m, temperature: 1800,\n"
    "           bloom: [1, 0.5, 0.25]}\n"
    "  ball:\n"
    "    emit: {rate: 1, life: 2 s, speed: 0 m/s, from: {point: {origin: [0.6, 1.5, 1]}}}\n"
    "    look: {shape: sphere, size: 0.4 m, bloom: 1}\n";

static const char *const HALF = "post.particles.resolution=half";
static const char *const QUARTER = "post.particles.resolution=quarter";
static const char *const MIXED = "post.particles.mixed=true";
static const char *const SEPARATE = "post.compose=separate";

/* Techniques that draw particles on the host and enlarge their picture to the frame's size in
 * GL. */
static const struct kiln_techniques ENLARGED_IN_GL = {
    .raster = KILN_RASTER_CPU, .bloom = KILN_BLOOM_CPU, .composite = KILN_COMPOSITE_GL};

static struct kiln_picture *draw(struct kiln_device *device, const struct frame_setting *setting)
{
    return frame_draw(device, SCENE, 50, setting);
}

/* GL and the host enlarge the same picture of particles alike, except for rounding. If GL also
 * draws the particles, layers have a relative difference below 1 %. */
static void techniques_agree(void **state)
{
    const struct frame_setting settings[] = {
        {{HALF}, 1, FRAME_CPU, 0},           {{QUARTER}, 1, FRAME_CPU, 0},
        {{HALF, MIXED}, 2, FRAME_CPU, 0},    {{QUARTER, MIXED}, 2, FRAME_CPU, 0},
        {{HALF, SEPARATE}, 2, FRAME_CPU, 0}, {{QUARTER, MIXED, SEPARATE}, 3, FRAME_CPU, 0},
    };
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        struct frame_setting enlarged = settings[i], all = settings[i];
        enlarged.techniques = ENLARGED_IN_GL;
        all.techniques = FRAME_GL;
        struct kiln_picture *want = draw(*state, &settings[i]);
        struct kiln_picture *got[2] = {draw(*state, &enlarged), draw(*state, &all)};
        for (int layer = FRAME_BEAUTY; layer <= FRAME_BLOOM; layer++) {
            if (layer == FRAME_DEPTH)
                continue;
            double off[2] = {frame_difference(want, got[0], layer),
                             frame_difference(want, got[1], layer)};
            print_message("%zu %d %.2g %.2g\n", i, layer, off[0], off[1]);
            assert_true(off[0] < 1e-5 + test_rounding() && off[1] < 1e-2);
        }
        for (int k = 0; k < 2; k++)
            kiln_picture_destroy(&got[k]);
        kiln_picture_destroy(&want);
    }
}

/* Half resolution is nearer to full resolution than a quarter. Mixed resolution
 * (post.particles.mixed), which is full at edges, is nearer than the same resolution everywhere. */
static void near_full_resolution(void **state)
{
    const struct frame_setting settings[] = {{{HALF}, 1, FRAME_CPU, 0},
                                             {{QUARTER}, 1, FRAME_CPU, 0},
                                             {{HALF, MIXED}, 2, FRAME_CPU, 0},
                                             {{QUARTER, MIXED}, 2, FRAME_CPU, 0}};
    static const double most[4][2] = {{0.02, 0.2}, {0.04, 0.4}, {0.01, 0.1}, {0.01, 0.1}};
    for (int compose = 0; compose < 2; compose++) {
        struct frame_setting full = {{SEPARATE}, compose ? 1 : 0, FRAME_CPU, 0};
        struct kiln_picture *want = draw(*state, &full);
        double off[4][5];
        for (int i = 0; i < 4; i++) {
            struct frame_setting setting = settings[i];
            if (compose)
                setting.overrides[setting.count++] = SEPARATE;
            struct kiln_picture *got = draw(*state, &setting);
            for (int layer = FRAME_BEAUTY; layer <= FRAME_BLOOM; layer++)
                off[i][layer] = layer == FRAME_DEPTH ? 0 : frame_difference(want, got, layer);
            print_message("%d: beauty %.2g fire %.2g smoke %.2g bloom %.2g\n", i,
                          off[i][FRAME_BEAUTY], off[i][FRAME_FIRE], off[i][FRAME_SMOKE],
                          off[i][FRAME_BLOOM]);
            assert_true(off[i][FRAME_BEAUTY] > 1e-5 && off[i][FRAME_BEAUTY] < most[i][0]);
            assert_true(off[i][FRAME_FIRE] < most[i][1] && off[i][FRAME_SMOKE] < most[i][1]);
            assert_true(off[i][FRAME_BLOOM] > 1e-4 && off[i][FRAME_BLOOM] < most[i][1]);
            kiln_picture_destroy(&got);
        }
        assert_true(off[1][FRAME_SMOKE] > 1.3 * off[0][FRAME_SMOKE]);
        assert_true(off[2][FRAME_SMOKE] < 0.9 * off[0][FRAME_SMOKE] &&
                    off[3][FRAME_SMOKE] < 0.9 * off[1][FRAME_SMOKE]);
        kiln_picture_destroy(&want);
    }
}

/* Pixels in which a near object hides the smoke at full resolution have no smoke (alpha below 0.02)
 * at lower resolutions either. Of the pixels with dense smoke at full resolution (alpha above 0.5),
 * at most one in fifty loses it (alpha below 0.25). */
static void smoke_does_not_bleed_over_edges(void **state)
{
    const struct frame_setting full = {{NULL}, 0, FRAME_CPU, 0};
    struct kiln_picture *want = draw(*state, &full);
    for (int i = 0; i < 4; i++) {
        struct frame_setting setting = {
            {i & 1 ? QUARTER : HALF, MIXED}, i & 2 ? 2 : 1, FRAME_CPU, 0};
        struct kiln_picture *got = draw(*state, &setting);
        int posts = 0, beside = 0, lost = 0;
        for (int p = 0; p < PIXELS; p++) {
            float before = want->layers[FRAME_SMOKE].pixels[4 * p + 3];
            float after = got->layers[FRAME_SMOKE].pixels[4 * p + 3];
            if (want->layers[FRAME_DEPTH].pixels[p] < 2.95f && before == 0.0f) {
                posts++;
                assert_true(after < 0.02f);
            } else if (before > 0.5f) {
                beside++;
                lost += after < 0.25f;
            }
        }
        assert_true(posts > 200 && beside > 400 && lost <= beside / 50);
        kiln_picture_destroy(&got);
    }
    kiln_picture_destroy(&want);
}

/* The host draws the same bytes at every SIMD level and with any number of threads. */
static void threads_and_vectors_change_no_byte(void **state)
{
    struct frame_setting setting = {{QUARTER, MIXED}, 2, FRAME_CPU, 1};
    setenv("KILN_SIMD", kiln_simd_name(KILN_SIMD_PLAIN), 1);
    struct kiln_picture *want = draw(*state, &setting);
    for (enum kiln_simd simd = KILN_SIMD_PLAIN; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        setenv("KILN_SIMD", kiln_simd_name(simd), 1);
        setting.threads = 1 + (uint32_t)simd;
        struct kiln_picture *got = draw(*state, &setting);
        for (int layer = 0; layer < FRAME_LAYERS; layer++)
            assert_memory_equal(want->layers[layer].pixels, got->layers[layer].pixels,
                                sizeof(float) * want->layers[layer].channels * PIXELS);
        kiln_picture_destroy(&got);
    }
    kiln_picture_destroy(&want);
    unsetenv("KILN_SIMD");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(techniques_agree),
        test_on_device(near_full_resolution),
        test_on_device(smoke_does_not_bleed_over_edges),
        test_on_device(threads_and_vectors_change_no_byte),
    };
    return cmocka_run_group_tests_name("coarse", tests, test_device_open, test_device_close);
}
