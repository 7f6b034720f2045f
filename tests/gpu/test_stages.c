/* Checks that the stages of a frame, from particles to the composed picture, work together
 * (lib/frame/stages.c), and what the layers of an EXR hold. If this fails, fire and smoke cover
 * each other wrongly, layers have the wrong content, or a frame depends on which frames were drawn
 * before. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "frame/stages.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/pools.h"
#include "support/stages.h"

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT, BEAUTY = 0, DEPTH, FIRE, SMOKE, BLOOM };

static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [96, 64], fps: 60, frames: 60}\n"
    "camera: {position: [0, 1, 4], target: [0, 1, 0]}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 60, life: 2 s, speed: 1 m/s, from: {sphere: {origin: [0, 1, 0.4]}}}\n"
    "    look: {atlas: 'builtin:smoke', size: 0.8 m, opacity: 0.8, color: 0.02, lit: 1}\n"
    "  fire:\n"
    "    emit: {rate: 60, life: 1 s, speed: 1 m/s, from: {sphere: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:fire', blend: add, size: 0.7 m, temperature: 1800,\n"
    "           bloom: [1, 0.5, 0.25]}\n";

/* Holds a run of SCENE, the stages that draw it, and the last frame that was drawn. */
struct frame {
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_run run;
    struct kiln_stages stages;
    struct kiln_simulate *simulate;
    struct kiln_picture *picture;
    uint32_t drawn; /* number of particles drawn */
};

/* Simulates SCENE up to the end of step `steps`, draws that instant and reads the picture. */
static void step_and_draw(struct frame *f, uint32_t steps)
{
    struct kiln_error error = {0};
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS];
    uint32_t count = f->stages.layers
                         ? kiln_stages_layers(kiln_volume_domains(f->scene) > 0, names, channels)
                         : 0;
    for (uint32_t step = f->run.step + 1; step <= steps; step++)
        assert_true(kiln_simulate_step(f->simulate, &f->run.pool, step, &error));
    f->run.step = steps;
    if (!kiln_stages_draw(&f->stages, NULL, &f->run.pool, kiln_instant_at_step(steps), 0, &f->drawn,
                          &error) ||
        !kiln_stages_compose(&f->stages, 3, &error))
        fail_msg("%s", error.message);
    kiln_picture_destroy(&f->picture);
    f->picture = kiln_picture_create(WIDTH, HEIGHT, 8, names, channels, count, &error);
    assert_non_null(f->picture);
    assert_true(kiln_stages_read(&f->stages, f->picture, &error));
}

static void frame_init_with(struct frame *f, struct kiln_device *device, const char *override,
                            bool layers)
{
    struct kiln_error error = {0};
    *f = (struct frame){0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = &override;
    params.override_count = override ? 1 : 0;
    f->scene = kiln_scene_parse(SCENE, sizeof SCENE - 1, "test", &params, &error);
    assert_string_equal(error.message, "");
    f->threads = kiln_threads_create(2);
    pool_init_of(&f->run.pool, device, f->scene);
    struct kiln_techniques techniques = {0};
    stages_open(&f->stages, &f->simulate, device, f->scene, &techniques, layers, f->threads,
                &f->run.pool);
}

static void frame_init(struct frame *f, struct kiln_device *device, const char *override)
{
    frame_init_with(f, device, override, true);
}

static void frame_finish(struct frame *f)
{
    kiln_picture_destroy(&f->picture);
    stages_close(&f->stages, &f->simulate);
    kiln_pool_finish(&f->run.pool);
    kiln_threads_destroy(&f->threads);
    kiln_scene_destroy(&f->scene);
}

static const float *layer(const struct frame *f, int index)
{
    return f->picture->layers[index].pixels;
}

static double sum(const float *pixels, int channel, int channels)
{
    double total = 0;
    for (int i = 0; i < PIXELS; i++)
        total += (double)pixels[i * channels + channel];
    return total;
}

static void layers_hold_what_they_say(void **state)
{
    struct frame f;
    frame_init(&f, *state, NULL);
    step_and_draw(&f, 50);
    assert_true(f.drawn > 60 && f.drawn <= 100);
    assert_true(sum(layer(&f, FIRE), 0, 4) > 10.0);
    assert_true(sum(layer(&f, FIRE), 3, 4) == 0.0); /* additive fire has no alpha */
    assert_true(sum(layer(&f, SMOKE), 3, 4) > 100.0);
    /* The smoke is dark. */
    assert_true(sum(layer(&f, SMOKE), 0, 4) < 0.2 * sum(layer(&f, SMOKE), 3, 4));
    for (int i = 0; i < PIXELS; i++) {
        assert_true(layer(&f, BEAUTY)[4 * i + 3] == 1.0f);
        assert_true(layer(&f, DEPTH)[i] > 2.3f);
        assert_true(layer(&f, BLOOM)[4 * i] >= 0.0f);
    }
    frame_finish(&f);
}

/* Smoke in front of fire must cover the fire and its bloom with post.compose=merged, and
 * with post.compose=separate fire must shine through (Heinz 2019, figure 4.3). */
static void fire_shines_through_only_when_separate(void **state)
{
    struct frame merged, separate;
    frame_init(&merged, *state, NULL);
    step_and_draw(&merged, 50);
    frame_init(&separate, *state, "post.compose=separate");
    step_and_draw(&separate, 50);
    assert_int_equal(merged.drawn, separate.drawn);
    double covered = sum(layer(&merged, BEAUTY), 0, 4);
    double through = sum(layer(&separate, BEAUTY), 0, 4);
    assert_true(through > 1.2 * covered);
    assert_true(sum(layer(&separate, BLOOM), 0, 4) > 1.2 * sum(layer(&merged, BLOOM), 0, 4));
    assert_true(sum(layer(&separate, FIRE), 3, 4) > 0.0);
    frame_finish(&merged);
    frame_finish(&separate);
}

/* Spheres must belong to the scene: here they replace the smoke in front of the fire. They must be
 * in the depth of the scene, hide fire, be absent from the layer of smoke, and keep their bloom. */
static void spheres_belong_to_the_scene(void **state)
{
    struct frame smoke, spheres;
    frame_init(&smoke, *state, NULL);
    step_and_draw(&smoke, 50);
    frame_init(&spheres, *state,
               "systems.smoke.look={shape: sphere, size: 0.5 m, bloom: 1, lit: 0}");
    step_and_draw(&spheres, 50);
    assert_int_equal(smoke.drawn, spheres.drawn);
    assert_true(sum(layer(&spheres, SMOKE), 3, 4) == 0.0);
    int nearer = 0;
    double fire = 0, unhidden = 0;
    for (int i = 0; i < PIXELS; i++) {
        float depth = layer(&spheres, DEPTH)[i];
        assert_true(depth <= layer(&smoke, DEPTH)[i]);
        if (depth == layer(&smoke, DEPTH)[i])
            continue;
        nearer++;
        fire += (double)layer(&spheres, FIRE)[4 * i];
        unhidden += (double)layer(&smoke, FIRE)[4 * i];
        /* At least two of the pixel's four samples show a sphere, whose bloom is 1. */
        assert_true(layer(&spheres, BLOOM)[4 * i] > 0.45f);
    }
    assert_true(nearer > 200 && unhidden > 10.0 && fire < 0.1 * unhidden);
    assert_true(sum(layer(&spheres, FIRE), 0, 4) > 10.0); /* fire is visible beside the spheres */
    frame_finish(&smoke);
    frame_finish(&spheres);
}

/* The bloom must add as much red light to the picture as the layer of bloom has. */
static void bloom_adds_light(void **state)
{
    struct frame with, without;
    frame_init(&with, *state, NULL);
    step_and_draw(&with, 50);
    frame_init(&without, *state, "post.bloom.kind=none");
    step_and_draw(&without, 50);
    double gain = sum(layer(&with, BEAUTY), 0, 4) - sum(layer(&without, BEAUTY), 0, 4);
    double glow = sum(layer(&with, BLOOM), 0, 4);
    /* Some of the light that the bloom spreads leaves the picture at its edges. */
    assert_true(gain > 0.9 * glow && gain < 1.05 * glow);
    frame_finish(&with);
    frame_finish(&without);
}

/* Fails unless a frame has the same bytes in all layers whether earlier frames were drawn and read
 * or not. */
static void expect_same_after_others(void **state, const char *override)
{
    struct frame all, last;
    frame_init(&all, *state, override);
    for (uint32_t step = 10; step <= 50; step += 10)
        step_and_draw(&all, step);
    frame_init(&last, *state, override);
    step_and_draw(&last, 50);
    assert_memory_equal(all.picture->display, last.picture->display, PIXELS * 4);
    for (uint32_t i = 0; i < last.picture->layer_count; i++)
        assert_memory_equal(layer(&all, (int)i), layer(&last, (int)i),
                            PIXELS * last.picture->layers[i].channels * sizeof(float));
    frame_finish(&all);
    frame_finish(&last);
}

static void frames_do_not_depend_on_earlier_ones(void **state)
{
    expect_same_after_others(state, "post.compose=merged");
    expect_same_after_others(state, "post.compose=separate");
    expect_same_after_others(state, "post.bloom.kind=none");
    expect_same_after_others(state, "post.particles={resolution: quarter, mixed: true}");
    expect_same_after_others(state, "systems.smoke.look={shape: sphere, size: 0.5 m, bloom: 1}");
}

static void no_particles_are_no_error(void **state)
{
    struct frame f;
    frame_init(&f, *state, "systems.*.emit.rate=0");
    step_and_draw(&f, 5);
    assert_int_equal(f.drawn, 0);
    assert_true(sum(layer(&f, FIRE), 0, 4) == 0.0 && sum(layer(&f, SMOKE), 3, 4) == 0.0);
    frame_finish(&f);
}

/* Returns whether the draw entries of the last pass are in the order of systems and serials. */
static bool is_in_order(struct frame *f)
{
    struct kiln_error error = {0};
    const struct kiln_particle *records = kiln_buffer_host(&f->run.pool.records, KILN_READ, &error);
    const uint32_t *entries = kiln_buffer_host(&f->stages.entries, KILN_READ, &error);
    assert_true(records && entries);
    bool in_order = true;
    for (uint32_t i = 1; i < f->drawn; i++) {
        uint32_t before = KILN_ENTRY_SYSTEM(entries[i - 1]), system = KILN_ENTRY_SYSTEM(entries[i]);
        uint32_t serial_before = records[KILN_ENTRY_SLOT(entries[i - 1])].position_serial.w;
        uint32_t serial = records[KILN_ENTRY_SLOT(entries[i])].position_serial.w;
        in_order = in_order && (system > before || (system == before && serial > serial_before));
    }
    return in_order;
}

/* Passes with particles that cover must be sorted by depth. Passes of additive particles alone must
 * keep the order of serials, since sums need no other order. */
static void only_covering_particles_are_sorted(void **state)
{
    static const struct {
        const char *override;
        bool sorted;
    } cases[] = {
        {"systems.smoke.enabled=false", false}, {"systems.*.look.blend=add", false},
        {"systems.fire.enabled=false", true},   {"post.compose=merged", true},
        {"post.compose=alpha", true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct frame f;
        frame_init_with(&f, *state, cases[i].override, false);
        step_and_draw(&f, 50);
        assert_true(f.drawn > 40);
        if (is_in_order(&f) == cases[i].sorted)
            fail_msg("%s", cases[i].override);
        frame_finish(&f);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(layers_hold_what_they_say),
        test_on_device(fire_shines_through_only_when_separate),
        test_on_device(spheres_belong_to_the_scene),
        test_on_device(bloom_adds_light),
        test_on_device(frames_do_not_depend_on_earlier_ones),
        test_on_device(no_particles_are_no_error),
        test_on_device(only_covering_particles_are_sorted),
    };
    return cmocka_run_group_tests_name("stages", tests, test_device_open, test_device_close);
}
