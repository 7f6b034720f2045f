/* Draws sprites within gas for tests of how the two are blended, and the reference for it. The
 * sprites are billboards parallel to the picture, so that each has one depth. */
#include "support/gas_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_fixture.h"
#include "support/scenes.h"

enum {
    SIZE = GAS_VIEW_SIZE,
    FLOATS = GAS_VIEW_FLOATS,
    PIXELS = FLOATS / 4,
    SPRITES = GAS_DEPTH_SPRITES,
    SMOKE = SPRITES / 2, /* sprites of each system */
    STEP = 30,
};

/* The view is that of gas_view.h. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [65, 65], fps: 30, frames: 60}\n"
    "simulation: {rate: 30}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 15 deg}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 1, life: 4 s, from: {point: {}}}\n"
    "    look: {size: 0.6 m, thickness: 0, opacity: 0.7, color: [0.5, 0.4, 0.3], lit: 1, bloom: "
    "[0.2, 0.2, "
    "0.2]}\n"
    "  fire:\n"
    "    emit: {rate: 1, life: 4 s, from: {point: {}}}\n"
    "    look: {atlas: 'builtin:fire', blend: add, size: 0.4 m, thickness: 0, temperature: 1700,\n"
    "           intensity: 3, bloom: [1, 0.5, 0.25]}\n";

static void set_depth(struct kiln_image *image, float depth_m)
{
    struct kiln_error error = {0};
    float *depth = kiln_image_host(image, KILN_OVERWRITE, &error);
    for (int i = 0; i < PIXELS; i++)
        depth[i] = depth_m;
}

/* Adds the sprites, from the farthest to the nearest. `tiled` takes them in the other order. */
static void add_sprites(struct gas_depth *f)
{
    struct raster *r = &f->raster;
    struct kiln_particle *records;
    uint32_t *entries;
    raster_add_particles(r, SMOKE, SPRITES, &records, &entries);
    srand(11);
    for (uint32_t i = 0; i < SPRITES; i++) {
        const float z = -1.3f + 2.6f * (float)i / (SPRITES - 1);
        const uint32_t slot = i % 2 * SMOKE + i / 2;
        const float x = raster_random(-0.9f, 0.9f), y = raster_random(0.1f, 1.9f);
        records[slot] = raster_random_particle(x, y, z, i, STEP);
        f->depths[i] = 10.0f - z;
    }
}

void gas_depth_open(struct gas_depth *f, const struct gas_depth_setting *setting)
{
    struct kiln_error error = {0};
    static const char *const oit[] = {"post.compose=oit", NULL};
    const bool half = setting->half;
    *f = (struct gas_depth){.by_fragment = setting->by_fragment, .half = setting->half};
    gas_view_open_on(&f->gas, setting->march_in_gl ? setting->device : NULL);
    const struct kiln_gas_look look = {.extinction = gas_view_value(setting->extinction),
                                       .albedo = gas_view_value3(0.4f, 0.5f, 0.6f),
                                       .intensity = gas_view_value(9.0f),
                                       .absorption = gas_view_value(1.0f),
                                       .bloom = gas_view_value(0.5f),
                                       .glow = gas_view_value(1.0f),
                                       .lights = true};
    struct kiln_gas *gas = gas_view_add(&f->gas, look);
    gas_fixture_lumps(gas, half ? 16 : 64); /* half needs cells that are 2.5 pixels wide */
    f->gas.scene->gas[0].shape = gas->shape;
    f->gas.light.sky_top = f->gas.light.sky_horizon = FLOAT4(0.5f, 0.8f, 1.2f, 0.0f);
    if (half && !setting->march_in_gl)
        f->gas.scene->gas[0].look.resolution = KILN_GAS_HALF;
    f->threads = kiln_threads_create(1);
    f->stage = kiln_volume_create(&f->gas.moment, true, f->threads, &error);
    assert_non_null(f->stage);
    if (setting->march_in_gl) {
        f->in_gl = kiln_volume_create(&f->gas.moment, true, f->threads, &error);
        assert_non_null(f->in_gl);
        assert_true(kiln_volume_use_gl(f->in_gl, setting->device, &error));
    }

    struct raster *r = &f->raster;
    raster_open_on(r, setting->device, setting->technique,
                   load_scene(SCENE, setting->by_fragment ? oit : NULL), 4, 2, STEP);
    r->scene->gas[0] = f->gas.scene->gas[0]; /* which programs of GL depend on */
    r->scene->gas_count = 1;
    raster_add_targets(r);
    add_sprites(f);
}

void gas_depth_close(struct gas_depth *f)
{
    kiln_volume_destroy(&f->stage);
    kiln_volume_destroy(&f->in_gl);
    kiln_threads_destroy(&f->threads);
    raster_close(&f->raster);
    gas_view_close(&f->gas);
}

/* Draws the gas before a depth, and its glow, into the bloom of the raster's target. */
static void draw_gas(struct gas_depth *f, struct kiln_volume_stage *stage, float depth_m)
{
    struct kiln_error error = {0};
    set_depth(&f->gas.depth, depth_m);
    const struct kiln_volume_draw draw = {.moment = &f->gas.moment,
                                          .pool = &f->gas.pool,
                                          .backdrop = &f->gas.light,
                                          .depth = &f->gas.depth,
                                          .profiles = true};
    assert_true(kiln_volume_draw(stage, &draw, &error));
    assert_true(kiln_volume_add_glow(stage, KILN_VOLUME_ALL, &f->raster.bloom, false, &error));
}

/* Draws sprites [first, first + count) to the raster's targets. */
static void draw_sprites(struct gas_depth *f, uint32_t first, uint32_t count,
                         const struct kiln_tile_gas *gas)
{
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(&f->raster.entries, KILN_OVERWRITE, &error);
    assert_non_null(entries);
    const bool nearest_first = f->raster.technique == KILN_RASTER_TILED && !f->by_fragment;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = first + (nearest_first ? count - 1 - k : k);
        entries[k] = KILN_ENTRY(i % 2, i % 2 * SMOKE + i / 2);
    }
    struct kiln_particles_draw job = raster_job(&f->raster);
    job.count = count;
    job.keep_bloom = gas != NULL;
    job.gas = gas;
    job.by_fragment = f->by_fragment;
    raster_draw(&f->raster, &job, 1);
}

static void take(struct gas_depth *f, struct gas_depth_drawn *to)
{
    struct kiln_error error = {0};
    memcpy(to->color, kiln_image_host(&f->raster.color, KILN_READ, &error), sizeof to->color);
    memcpy(to->glow, kiln_image_host(&f->raster.bloom, KILN_READ, &error), sizeof to->glow);
}

void gas_depth_draw(struct gas_depth *f, bool behind, struct gas_depth_drawn *to)
{
    struct kiln_error error = {0};
    struct kiln_volume_stage *stage = f->in_gl ? f->in_gl : f->stage;
    draw_gas(f, stage, 1e9f);
    const struct kiln_tile_gas gas = {.profiles = kiln_volume_profiles(stage),
                                      .width = SIZE,
                                      .height = SIZE,
                                      .scale = 1.0f,
                                      .smoke = 1.0f,
                                      .flame = 1.0f,
                                      .glow = 1.0f};
    assert_non_null(gas.profiles);
    draw_sprites(f, 0, SPRITES, behind ? NULL : &gas);
    assert_true(kiln_volume_put_under(stage, KILN_VOLUME_ALL, &f->raster.color, &error));
    take(f, to);
}

/* Draws the gas alone before a depth: light, alpha and glow. */
static void draw_gas_before(struct gas_depth *f, float depth_m, struct gas_depth_drawn *to)
{
    struct kiln_error error = {0};
    float *color = kiln_image_host(&f->raster.color, KILN_OVERWRITE, &error);
    memset(color, 0, FLOATS * sizeof *color);
    draw_gas(f, f->stage, depth_m);
    assert_true(kiln_volume_put_under(f->stage, KILN_VOLUME_ALL, &f->raster.color, &error));
    take(f, to);
}

/* Adds the light of gas between two depths, and then that of a sprite at the farther one, to what
 * is nearer. left: the part of the light that sprites let through so far. */
static void add_segment(struct gas_depth_drawn *sum, float *left,
                        const struct gas_depth_drawn *before, const struct gas_depth_drawn *behind,
                        const struct gas_depth_drawn *sprite)
{
    for (int i = 0; i < FLOATS; i++) {
        const int pixel = i / 4;
        if (i % 4 == 3)
            continue;
        const float clear = 1.0f - behind->color[4 * pixel + 3];
        sum->color[i] += left[pixel] * (behind->color[i] - before->color[i]);
        sum->glow[i] += left[pixel] * (behind->glow[i] - before->glow[i]);
        if (sprite) {
            sum->color[i] += left[pixel] * clear * sprite->color[i];
            sum->glow[i] += left[pixel] * clear * sprite->glow[i];
        }
    }
    for (int pixel = 0; pixel < PIXELS; pixel++) {
        if (sprite)
            left[pixel] *= 1.0f - sprite->color[4 * pixel + 3];
        else
            sum->color[4 * pixel + 3] = 1.0f - left[pixel] * (1.0f - behind->color[4 * pixel + 3]);
    }
}

void gas_depth_draw_reference(struct gas_depth *f, struct gas_depth_drawn *sum)
{
    static struct gas_depth_drawn gas[2], sprite;
    static float left[PIXELS];
    memset(sum, 0, sizeof *sum);
    memset(gas, 0, sizeof gas);
    for (int i = 0; i < PIXELS; i++)
        left[i] = 1.0f;
    for (uint32_t i = SPRITES; i-- > 0;) {
        draw_gas_before(f, f->depths[i], &gas[1]);
        draw_sprites(f, i, 1, NULL);
        take(f, &sprite);
        add_segment(sum, left, &gas[0], &gas[1], &sprite);
        gas[0] = gas[1];
    }
    draw_gas_before(f, 1e9f, &gas[1]);
    add_segment(sum, left, &gas[0], &gas[1], NULL);
}

double gas_depth_difference(const float found[GAS_VIEW_FLOATS],
                            const float expected[GAS_VIEW_FLOATS], bool alpha, double least)
{
    double most = 0.0;
    float brightest = 0.0f;
    for (int i = 0; i < FLOATS; i++)
        brightest = i % 4 < 3 && expected[i] > brightest ? expected[i] : brightest;
    for (int i = 0; i < FLOATS; i++) {
        if (i % 4 == 3 && !alpha)
            continue;
        const double light =
            i % 4 == 3 ? 1.0 : fmax((double)expected[i], least * (double)brightest);
        most = fmax(most, fabs((double)found[i] - (double)expected[i]) / light);
    }
    return most;
}

void gas_depth_check(struct gas_depth *f)
{
    static struct gas_depth_drawn found, expected;
    gas_depth_draw_reference(f, &expected);
    gas_depth_draw(f, false, &found);
    const double most = f->half ? 1.0 / 24.0 : f->in_gl ? 1.0 / 40.0 : 1.0 / 64.0;
    const double least = f->half && !f->in_gl ? 1.0 / 16.0 : 1e-3;
    const double color = gas_depth_difference(found.color, expected.color, true, least);
    const double glow = gas_depth_difference(found.glow, expected.glow, false, least);
    if (color > most)
        fail_msg("the light of a pixel is off by %.4f of it", color);
    if (glow > most)
        fail_msg("the glow of a pixel is off by %.4f of it", glow);
}
