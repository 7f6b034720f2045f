/* Particles at less than full resolution: near what full resolution shows, the same from both
 * techniques, without what belongs behind an edge before it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages.h"
#include "support/device.h"

enum { WIDTH = 101, HEIGHT = 67, PIXELS = WIDTH * HEIGHT, BEAUTY = 0, DEPTH, FIRE, SMOKE, BLOOM };

/* Smoke and fire behind a post and before a wall, and a sphere that glows. */
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

struct setting {
    const char *overrides[3];
    size_t count;
    struct kiln_techniques techniques;
};

static const struct kiln_techniques CPU = {
    .raster = KILN_RASTER_CPU, .bloom = KILN_BLOOM_CPU, .composite = KILN_COMPOSITE_CPU};
static const struct kiln_techniques GL = {
    .raster = KILN_RASTER_GEOMETRY, .bloom = KILN_BLOOM_GL, .composite = KILN_COMPOSITE_GL};

/* The host's particles, brought to the frame's size in GL. */
static const struct kiln_techniques SPREAD_IN_GL = {
    .raster = KILN_RASTER_CPU, .bloom = KILN_BLOOM_CPU, .composite = KILN_COMPOSITE_GL};

/* The layers of a frame. */
static struct kiln_picture *draw(struct kiln_device *device, const struct setting *setting)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = KILN_SCENE_DEFAULTS;
    params.overrides = setting->overrides;
    params.override_count = setting->count;
    struct kiln_scene *scene = kiln_scene_parse(SCENE, sizeof SCENE - 1, "test", &params, &error);
    assert_string_equal(error.message, "");
    struct kiln_threads *threads = kiln_threads_create(2);
    struct kiln_run run = {0};
    uint32_t capacities[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < scene->system_count; i++)
        capacities[i] = scene->systems[i].capacity;
    kiln_pool_init(&run.pool, device, capacities, scene->system_count);
    struct kiln_stages stages;
    struct kiln_output_needs needs = {.bits = 8, .layers = true};
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS], drawn = 0, count = kiln_stages_layers(names, channels);
    if (!kiln_stages_init(&stages, device, scene, &setting->techniques, needs, threads, &run.pool,
                          &error))
        fail_msg("%s", error.message);
    for (uint32_t step = 1; step <= 50; step++)
        assert_true(kiln_simulate_step(stages.simulate, &run.pool, step, &error));
    struct kiln_picture *picture =
        kiln_picture_create(WIDTH, HEIGHT, 8, names, channels, count, &error);
    assert_non_null(picture);
    if (!kiln_stages_draw(&stages, &run.pool, 50, 0, &drawn, &error) ||
        !kiln_stages_compose(&stages, 0, &error) || !kiln_stages_read(&stages, picture, &error))
        fail_msg("%s", error.message);
    kiln_stages_finish(&stages);
    kiln_pool_finish(&run.pool);
    kiln_threads_destroy(&threads);
    kiln_scene_destroy(&scene);
    return picture;
}

/* Sum of the differences of a layer in parts of the first one's sum. */
static double difference(const struct kiln_picture *a, const struct kiln_picture *b, int layer)
{
    double sum = 1e-9, off = 0;
    for (int i = 0; i < PIXELS * 4; i++) {
        double one = (double)a->layers[layer].pixels[i], other = (double)b->layers[layer].pixels[i];
        assert_true(isfinite(other));
        sum += fabs(one);
        off += fabs(one - other);
    }
    return off / sum;
}

static void techniques_agree(void **state)
{
    const struct setting settings[] = {
        {{HALF}, 1, CPU},           {{QUARTER}, 1, CPU},
        {{HALF, MIXED}, 2, CPU},    {{QUARTER, MIXED}, 2, CPU},
        {{HALF, SEPARATE}, 2, CPU}, {{QUARTER, MIXED, SEPARATE}, 3, CPU},
    };
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        struct setting spread = settings[i], all = settings[i];
        spread.techniques = SPREAD_IN_GL;
        all.techniques = GL;
        struct kiln_picture *want = draw(*state, &settings[i]);
        struct kiln_picture *got[2] = {draw(*state, &spread), draw(*state, &all)};
        for (int layer = BEAUTY; layer <= BLOOM; layer++) {
            if (layer == DEPTH)
                continue;
            double off[2] = {difference(want, got[0], layer), difference(want, got[1], layer)};
            print_message("%zu %d %.2g %.2g\n", i, layer, off[0], off[1]);
            assert_true(off[0] < 1e-5 && off[1] < 1e-2);
        }
        for (int k = 0; k < 2; k++)
            kiln_picture_destroy(&got[k]);
        kiln_picture_destroy(&want);
    }
}

/* The smaller, the further away; finer at edges, nearer. */
static void near_full_resolution(void **state)
{
    const struct setting settings[] = {
        {{HALF}, 1, CPU}, {{QUARTER}, 1, CPU}, {{HALF, MIXED}, 2, CPU}, {{QUARTER, MIXED}, 2, CPU}};
    static const double most[4][2] = {{0.02, 0.2}, {0.04, 0.4}, {0.01, 0.1}, {0.01, 0.1}};
    for (int compose = 0; compose < 2; compose++) {
        struct setting full = {{SEPARATE}, compose ? 1 : 0, CPU};
        struct kiln_picture *want = draw(*state, &full);
        double off[4][5];
        for (int i = 0; i < 4; i++) {
            struct setting setting = settings[i];
            if (compose)
                setting.overrides[setting.count++] = SEPARATE;
            struct kiln_picture *got = draw(*state, &setting);
            for (int layer = BEAUTY; layer <= BLOOM; layer++)
                off[i][layer] = layer == DEPTH ? 0 : difference(want, got, layer);
            print_message("%d: beauty %.2g fire %.2g smoke %.2g bloom %.2g\n", i, off[i][BEAUTY],
                          off[i][FIRE], off[i][SMOKE], off[i][BLOOM]);
            assert_true(off[i][BEAUTY] > 1e-5 && off[i][BEAUTY] < most[i][0]);
            assert_true(off[i][FIRE] < most[i][1] && off[i][SMOKE] < most[i][1]);
            assert_true(off[i][BLOOM] > 1e-4 && off[i][BLOOM] < most[i][1]);
            kiln_picture_destroy(&got);
        }
        assert_true(off[1][SMOKE] > 1.3 * off[0][SMOKE]);
        assert_true(off[2][SMOKE] < 0.9 * off[0][SMOKE] && off[3][SMOKE] < 0.9 * off[1][SMOKE]);
        kiln_picture_destroy(&want);
    }
}

/* Where full resolution shows no smoke because a post is before it, no other may, and beside it the
 * smoke is not gone. */
static void nothing_bleeds(void **state)
{
    const struct setting full = {{NULL}, 0, CPU};
    struct kiln_picture *want = draw(*state, &full);
    for (int i = 0; i < 4; i++) {
        struct setting setting = {{i & 1 ? QUARTER : HALF, MIXED}, i & 2 ? 2 : 1, CPU};
        struct kiln_picture *got = draw(*state, &setting);
        int posts = 0, beside = 0, lost = 0;
        for (int p = 0; p < PIXELS; p++) {
            float before = want->layers[SMOKE].pixels[4 * p + 3];
            float after = got->layers[SMOKE].pixels[4 * p + 3];
            if (want->layers[DEPTH].pixels[p] < 2.95f && before == 0.0f) {
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

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(techniques_agree),
        test_on_device(near_full_resolution),
        test_on_device(nothing_bleeds),
    };
    return cmocka_run_group_tests_name("coarse", tests, test_device_open, test_device_close);
}
