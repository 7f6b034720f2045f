/* Sprites before, within and behind gas: a picture would show sprites through gas that hides them,
 * or gas through sprites before it. Whole pictures are compared with a reference that marches
 * through the gas from each sprite of a pixel to the next one. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_fixture.h"
#include "support/gas_view.h"
#include "support/raster.h"
#include "support/scenes.h"

enum {
    SIZE = GAS_VIEW_SIZE,
    FLOATS = GAS_VIEW_FLOATS,
    PIXELS = FLOATS / 4,
    SMOKE = 24, /* sprites of each system */
    SPRITES = 2 * SMOKE,
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

/* A picture, with alpha, and its glow. */
struct drawn {
    float color[FLOATS], glow[FLOATS];
};

struct fixture {
    struct gas_view gas;
    struct raster raster;
    struct kiln_volume_stage *stage;
    struct kiln_threads *threads;
    struct kiln_particle *records;
    uint32_t *entries;
    float depths[SPRITES]; /* of the sprites, m */
};

static void set_depth(struct kiln_image *image, float depth_m)
{
    struct kiln_error error = {0};
    float *depth = kiln_image_host(image, KILN_OVERWRITE, &error);
    for (int i = 0; i < PIXELS; i++)
        depth[i] = depth_m;
}

/* Fills a domain with a ball of smoke, in the upper half of which flames are a thin shell. The
 * smoke is of lumps, so that its density changes from cell to cell. cells: along an edge. */
static void fill(struct kiln_gas *gas, int32_t cells)
{
    const float middle = 0.5f * (float)(cells - 1), scale = 64.0f / (float)cells;
    gas_fixture_ball(gas, cells, 2.0f / (float)cells, 0.45f, 1.0f, 1.0f);
    for (int32_t z = 0; z < cells; z++)
        for (int32_t y = 0; y < cells; y++)
            for (int32_t x = 0; x < cells; x++) {
                const size_t number =
                    kiln_gas_brick_index(gas, x / GAS_BRICK, y / GAS_BRICK, z / GAS_BRICK);
                const int32_t in =
                    (z % GAS_BRICK * GAS_BRICK + y % GAS_BRICK) * GAS_BRICK + x % GAS_BRICK;
                if (!gas->brick[number].now)
                    continue;
                float *cell = gas->brick[number].now + (ptrdiff_t)in * GAS_CARRIED;
                const float a = scale * ((float)x - middle), b = scale * ((float)y - middle);
                const float c = scale * ((float)z - middle);
                const float radius = sqrtf(a * a + b * b + c * c);
                cell[GAS_SMOKE] *= 0.55f + 0.45f * sinf(0.5f * a) * sinf(0.4f * b) * sinf(0.6f * c);
                cell[GAS_FLAME] *= fabsf(radius - 22.0f) < 2.0f ? 1.0f : 0.0f;
            }
}

static int open_with(void **state, float extinction, bool by_fragment, bool half)
{
    struct kiln_error error = {0};
    static const char *const oit[] = {"post.compose=oit", NULL};
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    gas_view_open(&f->gas);
    const struct kiln_gas_look look = {.extinction = gas_view_value(extinction),
                                       .albedo = gas_view_value3(0.4f, 0.5f, 0.6f),
                                       .intensity = gas_view_value(9.0f),
                                       .absorption = gas_view_value(1.0f),
                                       .bloom = gas_view_value(0.5f),
                                       .glow = gas_view_value(1.0f),
                                       .lights = true};
    struct kiln_gas *gas = gas_view_add(&f->gas, look);
    fill(gas, half ? 16 : 64); /* half needs cells that are 2.5 pixels wide */
    f->gas.scene->gas[0].shape = gas->shape;
    f->gas.light.sky_top = f->gas.light.sky_horizon = FLOAT4(0.5f, 0.8f, 1.2f, 0.0f);
    if (half)
        f->gas.scene->gas[0].look.resolution = KILN_GAS_HALF;
    f->threads = kiln_threads_create(1);
    f->stage = kiln_volume_create(&f->gas.moment, true, f->threads, &error);
    assert_non_null(f->stage);

    struct raster *r = &f->raster;
    raster_open(r, load_scene(SCENE, by_fragment ? oit : NULL), 4, 2, STEP);
    raster_add_targets(r);
    raster_add_particles(r, SMOKE, SPRITES, &f->records, &f->entries);
    srand(11);
    for (uint32_t i = 0; i < SPRITES; i++) { /* from the farthest to the nearest */
        const float z = -1.3f + 2.6f * (float)i / (SPRITES - 1);
        const uint32_t slot = i % 2 * SMOKE + i / 2;
        const float x = raster_random(-0.9f, 0.9f), y = raster_random(0.1f, 1.9f);
        f->records[slot] = raster_random_particle(x, y, z, i, STEP);
        f->entries[i] = KILN_ENTRY(i % 2, slot);
        f->depths[i] = 10.0f - z;
    }
    *state = f;
    return 0;
}

static int open_thin(void **state)
{
    return open_with(state, 1.0f, false, false);
}

static int open_thick(void **state)
{
    return open_with(state, 8.0f, false, false);
}

static int open_thin_oit(void **state)
{
    return open_with(state, 1.0f, true, false);
}

static int open_thick_oit(void **state)
{
    return open_with(state, 8.0f, true, false);
}

static int open_half(void **state)
{
    return open_with(state, 1.0f, false, true);
}

static int open_thick_half(void **state)
{
    return open_with(state, 8.0f, false, true);
}

static int close_all(void **state)
{
    struct fixture *f = *state;
    kiln_volume_destroy(&f->stage);
    kiln_threads_destroy(&f->threads);
    raster_close(&f->raster);
    gas_view_close(&f->gas);
    free(f);
    return 0;
}

/* Draws the gas before a depth, and its glow, into the bloom of the raster's target. */
static void draw_gas(struct fixture *f, float depth_m)
{
    struct kiln_error error = {0};
    set_depth(&f->gas.depth, depth_m);
    const struct kiln_volume_draw draw = {.moment = &f->gas.moment,
                                          .pool = &f->gas.pool,
                                          .backdrop = &f->gas.light,
                                          .depth = &f->gas.depth,
                                          .profiles = true};
    assert_true(kiln_volume_draw(f->stage, &draw, &error));
    assert_true(kiln_volume_add_glow(f->stage, KILN_VOLUME_ALL, &f->raster.bloom, false, &error));
}

/* Draws sprites [first, first + count) to the raster's targets. */
static void draw_sprites(struct fixture *f, uint32_t first, uint32_t count,
                         const struct kiln_tile_gas *gas, bool by_fragment)
{
    uint32_t all[SPRITES];
    memcpy(all, f->entries, sizeof all);
    memmove(f->entries, f->entries + first, count * sizeof *all);
    struct kiln_particles_draw job = raster_job(&f->raster);
    job.count = count;
    job.keep_bloom = gas != NULL;
    job.gas = gas;
    job.by_fragment = by_fragment;
    raster_draw(&f->raster, &job, 1);
    memcpy(f->entries, all, sizeof all);
}

static void take(struct fixture *f, struct drawn *to)
{
    struct kiln_error error = {0};
    memcpy(to->color, kiln_image_host(&f->raster.color, KILN_READ, &error), sizeof to->color);
    memcpy(to->glow, kiln_image_host(&f->raster.bloom, KILN_READ, &error), sizeof to->glow);
}

/* Draws gas and sprites as the stages do. */
static void draw_both(struct fixture *f, bool by_fragment, struct drawn *to)
{
    struct kiln_error error = {0};
    draw_gas(f, 1e9f);
    const struct kiln_tile_gas gas = {.profiles = kiln_volume_profiles(f->stage),
                                      .width = SIZE,
                                      .height = SIZE,
                                      .scale = 1.0f,
                                      .smoke = 1.0f,
                                      .flame = 1.0f,
                                      .glow = 1.0f};
    assert_non_null(gas.profiles);
    draw_sprites(f, 0, SPRITES, &gas, by_fragment);
    assert_true(kiln_volume_put_under(f->stage, KILN_VOLUME_ALL, &f->raster.color, &error));
    take(f, to);
}

/* Draws the gas alone before a depth: light, alpha and glow. */
static void draw_gas_before(struct fixture *f, float depth_m, struct drawn *to)
{
    struct kiln_error error = {0};
    float *color = kiln_image_host(&f->raster.color, KILN_OVERWRITE, &error);
    memset(color, 0, FLOATS * sizeof *color);
    draw_gas(f, depth_m);
    assert_true(kiln_volume_put_under(f->stage, KILN_VOLUME_ALL, &f->raster.color, &error));
    take(f, to);
}

/* Adds the light of gas between two depths, and then that of a sprite at the farther one, to what
 * is nearer. left: the part of the light that sprites let through so far. */
static void add_segment(struct drawn *sum, float *left, const struct drawn *before,
                        const struct drawn *behind, const struct drawn *sprite)
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

static void draw_reference(struct fixture *f, struct drawn *sum)
{
    static struct drawn gas[2], sprite;
    static float left[PIXELS];
    memset(sum, 0, sizeof *sum);
    memset(gas, 0, sizeof gas);
    for (int i = 0; i < PIXELS; i++)
        left[i] = 1.0f;
    for (uint32_t i = SPRITES; i-- > 0;) {
        draw_gas_before(f, f->depths[i], &gas[1]);
        draw_sprites(f, i, 1, NULL, false);
        take(f, &sprite);
        add_segment(sum, left, &gas[0], &gas[1], &sprite);
        gas[0] = gas[1];
    }
    draw_gas_before(f, 1e9f, &gas[1]);
    add_segment(sum, left, &gas[0], &gas[1], NULL);
}

/* Returns the greatest part of a pixel's light, or with alpha of the light from behind, by which a
 * picture is off. Light of less than a part `least` of the picture's brightest counts as that. */
static double difference(const float *found, const float *expected, bool alpha, double least)
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

static void check(struct fixture *f, bool by_fragment)
{
    static struct drawn found, expected;
    draw_reference(f, &expected);
    draw_both(f, by_fragment, &found);
    const bool half = f->gas.scene->gas[0].look.resolution == KILN_GAS_HALF;
    const double most = half ? 1.0 / 24.0 : 1.0 / 64.0, least = half ? 1.0 / 16.0 : 1e-3;
    const double color = difference(found.color, expected.color, true, least);
    const double glow = difference(found.glow, expected.glow, false, least);
    if (color > most)
        fail_msg("the light of a pixel is off by %.4f of it", color);
    if (!by_fragment && glow > most) /* lists of fragments have no glow of gas */
        fail_msg("the glow of a pixel is off by %.4f of it", glow);
}

static void sprites_are_blended_with_gas(void **state)
{
    check(*state, false);
}

static void fragments_are_blended_with_gas(void **state)
{
    check(*state, true);
}

/* The reference would be no test if gas behind all sprites were as near to it. */
static void gas_behind_all_sprites_is_far_from_the_reference(void **state)
{
    struct fixture *f = *state;
    struct kiln_error error = {0};
    static struct drawn found, expected;
    draw_reference(f, &expected);
    draw_gas(f, 1e9f);
    draw_sprites(f, 0, SPRITES, NULL, false);
    assert_true(kiln_volume_put_under(f->stage, KILN_VOLUME_ALL, &f->raster.color, &error));
    take(f, &found);
    assert_true(difference(found.color, expected.color, true, 1e-3) > 0.5);
}

static void bits_are_the_same_at_all_levels(void **state)
{
    struct fixture *f = *state;
    static struct drawn first, other;
    for (int by_fragment = 0; by_fragment < 2; by_fragment++) {
        bool some = false;
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            assert_int_equal(setenv("KILN_SIMD", kiln_simd_name(simd), 1), 0);
            draw_both(f, by_fragment, some ? &other : &first);
            unsetenv("KILN_SIMD");
            if (some)
                assert_memory_equal(&other, &first, sizeof other);
            some = true;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_thin, close_all),
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_thick, close_all),
        cmocka_unit_test_setup_teardown(fragments_are_blended_with_gas, open_thin_oit, close_all),
        cmocka_unit_test_setup_teardown(fragments_are_blended_with_gas, open_thick_oit, close_all),
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_half, close_all),
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_thick_half, close_all),
        cmocka_unit_test_setup_teardown(gas_behind_all_sprites_is_far_from_the_reference, open_thin,
                                        close_all),
        cmocka_unit_test_setup_teardown(bits_are_the_same_at_all_levels, open_thin_oit, close_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
