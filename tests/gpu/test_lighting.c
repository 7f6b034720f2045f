/* Checks that particles light and shade the backdrop (lib/draw/light/lighting.c): fire lights the
 * floor, and smoke attenuates the light on it by the transmittance exp(-optical depth). If this
 * fails, flames shed no light, or the shadows of smoke are too dark or missing. Each technique of
 * the backdrop runs all tests. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "draw/backdrop/backdrop.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/pools.h"
#include "support/scenes.h"

enum { WIDTH = 64, HEIGHT = 36, STEP = 30, SLOTS = 512 };

/* The camera looks straight down at the floor, 5 m below it, and the sun is in the zenith. */
static const char SCENE[] = "kiln: 1\n"
                            "output: {size: [64, 36], fps: 60}\n"
                            "camera: {position: [0, 5, 0], target: [0, 0, 0], fov: 40 deg}\n"
                            "backdrop:\n"
                            "  haze: 0\n"
                            "  sky: {top: [0.1, 0.2, 0.4], horizon: [0.1, 0.2, 0.4]}\n"
                            "  sun: {direction: [0, 1, 0], color: [2, 1, 0.5]}\n"
                            "  floor: {color: [0.5, 0.5, 0.5]}\n"
                            "systems:\n"
                            "  smoke:\n"
                            "    emit: {life: 1 s}\n"
                            "    look: {size: 0.5 m, opacity: 0.5, fade: {in: 0, out: 0}}\n"
                            "  fire:\n"
                            "    emit: {life: 1 s}\n"
                            "    look: {blend: add, color: [3, 1, 0.3], size: 1 m, light: 1,\n"
                            "           fade: {in: 0, out: 0}}\n";

struct fixture {
    struct kiln_scene *scene;
    struct kiln_pool pool;
    struct kiln_moment moment;
    struct kiln_image color, depth;
    struct kiln_threads *threads;
    struct kiln_lighting_stage *lighting;
    struct kiln_backdrop_stage *backdrop;
};

static void set_up(struct fixture *f, void *device)
{
    struct kiln_error error = {0};
    static const uint32_t capacities[2] = {SLOTS, SLOTS};
    *f = (struct fixture){.scene = load_scene(SCENE, NULL)};
    pool_init(&f->pool, device, capacities, 2);
    f->threads = kiln_threads_create(2);
    assert_non_null(f->threads);
    kiln_image_init(&f->color, device, WIDTH, HEIGHT, GL_RGBA32F, "color");
    kiln_image_init(&f->depth, device, WIDTH, HEIGHT, GL_R32F, "depth");
    assert_true(kiln_moment_init(&f->moment, device, f->scene, NULL, &error));
    f->lighting = kiln_lighting_create(device, &f->moment, f->threads, &error);
    f->backdrop = backdrop_create(device, &f->moment, &f->color, &f->depth, &error);
    assert_true(f->lighting && f->backdrop);
}

static void tear_down(struct fixture *f)
{
    kiln_backdrop_destroy(&f->backdrop);
    kiln_lighting_destroy(&f->lighting);
    kiln_moment_finish(&f->moment);
    kiln_threads_destroy(&f->threads);
    kiln_image_finish(&f->color);
    kiln_image_finish(&f->depth);
    kiln_pool_finish(&f->pool);
    kiln_scene_destroy(&f->scene);
}

/* Adds a particle to a system: at rest at (x, y, z), m, and born at the start of step 1. */
static void place(struct fixture *f, uint32_t system, float x, float y, float z)
{
    struct kiln_error error = {0};
    struct kiln_particle *records = kiln_buffer_host(&f->pool.records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    struct kiln_pool_system *slots = &f->pool.systems[system];
    uint32_t serial = (uint32_t)slots->next_serial++;
    records[slots->base + serial] = (struct kiln_particle){
        .position_serial = {FLOAT_BITS(x), FLOAT_BITS(y), FLOAT_BITS(z), serial},
        .velocity_birth = {0, 0, 0, 1u << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
}

/* Draws the backdrop at step STEP, and copies the linear colour of pixel (x, y) to rgb. */
static void draw(struct fixture *f, int x, int y, float rgb[3])
{
    struct kiln_error error = {0};
    struct kiln_lighting lighting;
    assert_true(kiln_moment_fill(&f->moment, &f->pool, kiln_instant_at_step(STEP), true, &error));
    assert_true(kiln_lighting_run(f->lighting, &f->moment, NULL, &lighting, &error));
    assert_true(kiln_backdrop_draw(f->backdrop, &f->moment, &lighting, &error));
    const float *pixels = kiln_image_host(&f->color, KILN_READ, &error);
    assert_non_null(pixels);
    memcpy(rgb, pixels + 4 * (y * WIDTH + x), 3 * sizeof *rgb);
}

/* Under smoke, the light of sun and sky on the floor must fall by the smoke's transmittance, here
 * that of 400 puffs, 100 for each square metre, 1 m above the floor. The corner of the picture,
 * beside the smoke, must stay as bright. */
static void smoke_shades_the_floor(void **state)
{
    struct fixture f;
    set_up(&f, *state);
    float clear[3], shaded[3], aside[3];
    draw(&f, WIDTH / 2, HEIGHT / 2, clear);
    for (int i = 0; i < 400; i++)
        place(&f, 0, -1 + 2 * ((float)(i % 20) + 0.5f) / 20, 1,
              -1 + 2 * ((float)(i / 20) + 0.5f) / 20);
    draw(&f, WIDTH / 2, HEIGHT / 2, shaded);
    draw(&f, 1, 1, aside);
    const double pi = acos(-1.0);
    /* optical depth: puffs per m^2 times the extinction cross section of a puff, m^2
     * (find_extinction, light_simd.c) */
    double depth = 100 * -log(1 - 0.6 * 0.5) * 15 / 16 * 0.25 * 0.25 * 32 * pi / 105;
    for (int c = 0; c < 3; c++) {
        double expected = (double)clear[c] * exp(-depth);
        if (fabs((double)shaded[c] - expected) > 0.05 * expected)
            fail_msg("channel %d is %g instead of %g", c, (double)shaded[c], expected);
        assert_true(fabsf(aside[c] - clear[c]) < 1e-5f);
    }
    tear_down(&f);
}

/* A fire must make the floor next to it brighter and redder, and distant floor brighter by less.
 * The light must go out with its particle. */
static void fire_lights_the_floor(void **state)
{
    struct fixture f;
    set_up(&f, *state);
    float without[3], with[3], far[3];
    draw(&f, WIDTH / 2 + 4, HEIGHT / 2, without);
    place(&f, 1, 0, 0.5f, 0);
    draw(&f, WIDTH / 2 + 4, HEIGHT / 2, with);
    draw(&f, WIDTH - 1, HEIGHT / 2, far);
    assert_true(with[0] > 1.1f * without[0]);
    assert_true(with[0] / with[2] > 1.1f * without[0] / without[2]);
    assert_true(far[0] > without[0] && far[0] < with[0]);
    /* Without the particle, the floor is as dark as before. */
    f.pool.systems[1].next_serial = 0;
    draw(&f, WIDTH / 2 + 4, HEIGHT / 2, with);
    assert_memory_equal(with, without, sizeof with);
    tear_down(&f);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(smoke_shades_the_floor),
        test_on_device(fire_lights_the_floor),
    };
    return backdrops_run("lighting", tests, sizeof tests / sizeof *tests, false, argc, argv);
}
