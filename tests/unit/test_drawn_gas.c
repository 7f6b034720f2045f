/* lib/draw/volume: gas would let through too much or too little of what is behind it, flames would
 * shine in wrong colours, a side away from the sun would be lit, or a picture would depend on
 * threads, on the width of vectors, or on the order of domains. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "asset/atlas/blackbody.h"
#include "draw/light/flame_colors.h"
#include "draw/volume/volume_field.h"
#include "support/cmocka.h"
#include "support/gas_fixture.h"
#include "support/gas_view.h"

enum { SIZE = GAS_VIEW_SIZE, MIDDLE = GAS_VIEW_MIDDLE, FLOATS = GAS_VIEW_FLOATS };

static double luminance(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most))
        fail_msg("found %.6f, expected %.6f within %g", found, expected, most);
}

/* ---- what gas hides -------------------------------------------------------------------------- */

static void a_ball_dims_by_the_length_of_its_chord(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas =
        gas_view_add(&f, (struct kiln_gas_look){.extinction = gas_view_value(0.8f)});
    gas_fixture_ball(gas, 64, 2.0f / 64.0f, 0.4f, 1.0f, 0.0f);
    const float *picture = gas_view_draw(&f);
    assert_near((double)picture[MIDDLE + 3], 1.0 - exp(-0.8 * 1.6), 1e-3);
    assert_true(picture[3] == 0.0f && picture[FLOATS - 1] == 0.0f);
    for (int i = 0; i < FLOATS; i += 4)
        assert_true(picture[i] == 0.0f && picture[i + 1] == 0.0f && picture[i + 2] == 0.0f);
    gas_view_close(&f);
}

/* The gas of this ball begins in the first cell of bricks whose lower neighbours are empty. */
static void a_ball_is_as_its_mirror_image(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas =
        gas_view_add(&f, (struct kiln_gas_look){.extinction = gas_view_value(0.8f)});
    gas_fixture_ball(gas, 64, 2.0f / 64.0f, 23.0f / 64.0f, 1.0f, 0.0f);
    assert_null(gas->brick[kiln_gas_brick_index(gas, 0, 4, 4)].now);
    const float *picture = gas_view_draw(&f);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            const double alpha = (double)picture[4 * (y * SIZE + x) + 3];
            assert_near((double)picture[4 * (y * SIZE + SIZE - 1 - x) + 3], alpha, 1e-5);
            assert_near((double)picture[4 * ((SIZE - 1 - y) * SIZE + x) + 3], alpha, 1e-5);
        }
    gas_view_close(&f);
}

static void an_object_hides_what_is_behind_it(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    gas_view_open(&f);
    gas_fixture_full(gas_view_add(&f, (struct kiln_gas_look){.extinction = gas_view_value(0.7f)}),
                     32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
    float *depth = kiln_image_host(&f.depth, KILN_READ_WRITE, &error);
    depth[MIDDLE / 4] = 10.0f;      /* in the middle of the smoke */
    depth[MIDDLE / 4 + 1] = 9.0f;   /* where it begins */
    depth[MIDDLE / 4 + 2] = 10.37f; /* between two steps */
    const float *alpha = gas_view_draw(&f) + MIDDLE + 3;
    assert_near((double)alpha[-4], 1.0 - exp(-0.7 * 2.0), 1e-3);
    assert_near((double)alpha[0], 1.0 - exp(-0.7), 1e-4);
    assert_near((double)alpha[4], 0.0, 1e-4);
    assert_near((double)alpha[8], 1.0 - exp(-0.7 * 1.37), 1e-3);
    gas_view_close(&f);
}

static void the_camera_may_be_inside(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    gas_fixture_full(gas_view_add(&f, (struct kiln_gas_look){.extinction = gas_view_value(0.7f)}),
                     32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
    f.moment.view.eye.z = 0.25f; /* 1.25 m before the far side */
    const double way = 1.25 - (double)f.moment.view.eye.w;
    const float *picture = gas_view_draw(&f);
    assert_near((double)picture[MIDDLE + 3], 1.0 - exp(-0.7 * way), 1e-4);
    assert_true(picture[3] > 0.5f); /* all of the picture is in the gas */
    f.moment.view.eye.z = -2.0f;    /* behind it */
    assert_true(gas_view_draw(&f)[MIDDLE + 3] == 0.0f);
    gas_view_close(&f);
}

/* ---- flames ---------------------------------------------------------------------------------- */

static void even_flames_have_the_closed_form(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    const struct kiln_gas_look look = {.intensity = gas_view_value(3.0f),
                                       .absorption = gas_view_value(0.9f)};
    gas_fixture_full(gas_view_add(&f, look), 32, 2.0f / 32.0f, 0.0f, 1.0f, 0.5f);
    const float *pixel = gas_view_draw(&f) + MIDDLE;
    const double left = exp(-0.45 * 2.0);
    assert_near(luminance(pixel), 1.5 / 0.45 * (1.0 - left), 3e-3);
    assert_near((double)pixel[3], 1.0 - left, 1e-4);
    assert_true(pixel[0] > pixel[1] && pixel[1] > pixel[2]);

    f.scene->gas[0].look.absorption = gas_view_value(0.0f);
    assert_near(luminance(gas_view_draw(&f) + MIDDLE), 1.5 * 2.0, 3e-3);
    gas_view_close(&f);
}

/* Returns Planck's law, times the fit of the eye's sensitivity that kiln uses. */
static double luminance_of(double kelvin)
{
    double sum = 0.0;
    for (int nm = 380; nm <= 780; nm += 5) {
        const double a = (nm - 568.8) * (nm < 568.8 ? 0.0213 : 0.0247);
        const double b = (nm - 530.9) * (nm < 530.9 ? 0.0613 : 0.0322);
        const double seen = 0.821 * exp(-0.5 * a * a) + 0.286 * exp(-0.5 * b * b);
        const double um = nm * 1e-3;
        sum += seen / (pow(um, 5.0) * (exp(14387.77 / (um * kelvin)) - 1.0));
    }
    return sum;
}

static void flames_shine_by_plancks_law(void **state)
{
    (void)state;
    static struct kiln_flame_colors colors;
    struct kiln_observer observer;
    kiln_observer_fill(&observer);
    kiln_flame_colors_fill(&colors, &observer, 900.0f, 2250.0f);
    const double hottest = luminance_of(2250.0);
    for (int i = 0; i <= FLAME_COLORS; i += 16) {
        const double temperature = i * (double)FLAME_HOTTEST / FLAME_COLORS;
        const double kelvin = 900.0 + 1350.0 * temperature;
        const double expected = luminance_of(kelvin) / hottest;
        const float rgb[3] = {colors.rgb[i].x, colors.rgb[i].y, colors.rgb[i].z};
        const double found = (double)kiln_blackbody_luminance(&observer, (float)kelvin) /
                             (double)kiln_blackbody_luminance(&observer, 2250.0f);
        assert_near(found / expected, 1.0, 1e-5);
        /* colours outside of the gamut lose a negative blue, which is a part of their luminance */
        assert_near(luminance(rgb) / expected, 1.0, kelvin > 1800.0 ? 0.01 : 0.08);
    }
}

static void flames_light_the_smoke_beside_them(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas_look look = {.extinction = gas_view_value(1.0f),
                                 .albedo = gas_view_value3(0.8f, 0.8f, 0.8f),
                                 .intensity = gas_view_value(20.0f),
                                 .glow = gas_view_value(1.0f)};
    struct kiln_gas *gas = gas_view_add(&f, look);
    gas_fixture_full(gas, 32, 2.0f / 32.0f, 0.2f, 0.0f, 0.0f);
    for (int i = 0; i < GAS_BRICK_CELLS; i++) { /* a brick in the lower left front corner burns */
        float *cell = gas->brick[kiln_gas_brick_index(gas, 0, 0, 3)].now + i * GAS_CARRIED;
        cell[GAS_FLAME] = cell[GAS_TEMPERATURE] = 1.0f;
    }
    const float *picture = gas_view_draw(&f);
    const float *near = picture + MIDDLE - 4 * 8, *far = picture + MIDDLE + 4 * 20;
    assert_true(near[0] > 2.0f * far[0] && far[0] > 0.0f);
    assert_true(near[0] > near[1] && near[1] > near[2]);
    f.scene->gas[0].look.glow = gas_view_value(0.0f);
    assert_true(gas_view_draw(&f)[MIDDLE] == 0.0f);
    gas_view_close(&f);
}

/* The same fire in smoke, on cells of one size and of half of it. */
static void cells_do_not_change_the_light_of_flames(void **state)
{
    (void)state;
    double light[2];
    for (int i = 0; i < 2; i++) {
        struct gas_view f;
        const int32_t n = i ? 64 : 32;
        gas_view_open(&f);
        const struct kiln_gas_look look = {.extinction = gas_view_value(2.0f),
                                           .albedo = gas_view_value3(0.8f, 0.8f, 0.8f),
                                           .intensity = gas_view_value(20.0f),
                                           .glow = gas_view_value(1.0f)};
        struct kiln_gas *gas = gas_view_add(&f, look);
        gas_fixture_ball(gas, n, 2.0f / (float)n, 0.4f, 1.0f, 1.0f);
        light[i] = luminance(gas_view_draw(&f) + MIDDLE + 4 * SIZE * 12); /* below the flames */
        gas_view_close(&f);
    }
    assert_true(light[0] > 0.1);
    assert_near(light[1] / light[0], 1.0, 0.1);
}

/* ---- sun and sky ----------------------------------------------------------------------------- */

static void shine_from(struct gas_view *f, float x, float y, float z)
{
    f->moment.sun.towards = FLOAT3(x, y, z);
    f->light.sun_color = FLOAT4(3.14159265f, 3.14159265f, 3.14159265f, 0.0f);
}

static const struct kiln_gas_look SMOKE = {
    .extinction = {.constant = 6.0f},
    .albedo = {{.constant = 0.8f}, {.constant = 0.8f}, {.constant = 0.8f}},
    .lights = true};

static void the_side_of_the_sun_is_lit(void **state)
{
    (void)state;
    static const float ways[][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    struct gas_view f;
    gas_view_open(&f);
    gas_fixture_ball(gas_view_add(&f, SMOKE), 64, 2.0f / 64.0f, 0.4f, 1.0f, 0.0f);
    for (int i = 0; i < 4; i++) {
        shine_from(&f, ways[i][0], ways[i][1], ways[i][2]);
        const float *picture = gas_view_draw(&f);
        const int aside = 4 * (int)(ways[i][0] - ways[i][1] * SIZE) * 14;
        const float lit = picture[MIDDLE + aside], dark = picture[MIDDLE - aside];
        if (!(lit > 3.0f * dark) || !(dark > 0.0f))
            fail_msg("sun %d: %g on its side, %g on the other", i, (double)lit, (double)dark);
    }
    gas_view_close(&f);
}

/* Optically thin gas scatters a known part of the sun's light: its octaves, 0.67 together. */
static void thin_smoke_scatters_the_octaves(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    gas_fixture_full(gas_view_add(&f, SMOKE), 32, 2.0f / 32.0f, 0.001f, 0.0f, 0.0f);
    f.scene->gas[0].look.extinction = gas_view_value(1.0f);
    shine_from(&f, 0.6f, 0.8f, 0.0f);
    assert_near((double)gas_view_draw(&f)[MIDDLE] / (0.8 * 0.002 * 0.67), 1.0, 3e-3);

    f.light.sun_color = FLOAT4(0, 0, 0, 0);
    f.light.sky_top = FLOAT4(0.5f, 0.5f, 0.5f, 0);
    f.light.sky_horizon = FLOAT4(1.5f, 1.5f, 1.5f, 0);
    assert_near((double)gas_view_draw(&f)[MIDDLE] / (0.8 * 0.002), 1.0, 3e-3);
    gas_view_close(&f);
}

/* A ball between the sun and the gas shades its upper half's middle. */
static void objects_hide_the_sun_from_gas(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    gas_view_open(&f);
    struct kiln_gas_look look = SMOKE;
    look.extinction = gas_view_value(0.001f);
    gas_fixture_full(gas_view_add(&f, look), 32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
    struct kiln_object *ball = &f.scene->backdrop.objects[f.scene->backdrop.object_count++];
    *ball = (struct kiln_object){.kind = KILN_OBJECT_SPHERE,
                                 .center = gas_view_value3(0.0f, 5.0f, 0.0f),
                                 .radius = gas_view_value(2.0f),
                                 .visible = true};
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    shine_from(&f, 0.0f, 1.0f, 0.0f);
    const float dark = gas_view_draw(&f)[MIDDLE];
    ball->center = gas_view_value3(9.0f, 5.0f, 0.0f);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    shine_from(&f, 0.0f, 1.0f, 0.0f);
    const float lit = gas_view_draw(&f)[MIDDLE];
    assert_true(lit > 0.0f && dark < 0.01f * lit);
    gas_view_close(&f);
}

static void lamps_light_thin_smoke(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas_look look = SMOKE;
    look.extinction = gas_view_value(0.001f);
    gas_fixture_full(gas_view_add(&f, look), 32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
    f.light.counts.y = 1;
    f.light.lights[0] = (struct kiln_draw_light){.position_radius2 = {0.0f, 101.0f, 0.0f, 0.25f},
                                                 .color = {5000.0f, 0.0f, 0.0f, 0.5f}};
    const double expected = 0.8 * 0.002 * 0.67 * 5000.0 / (100.0 * 100.0 + 0.25);
    const float *pixel = gas_view_draw(&f) + MIDDLE;
    assert_near((double)pixel[0] / expected, 1.0, 3e-3);
    assert_true(pixel[1] == 0.0f);
    gas_view_close(&f);
}

/* Smoke of two colours, half of each, is red on the left and has the look's albedo on the right. */
static void smoke_has_colors_of_its_own(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = gas_view_add(&f, SMOKE);
    gas_fixture_full(gas, 32, 2.0f / 32.0f, 0.0f, 0.0f, 0.0f);
    const struct kiln_gas_shape shape = {.cells = gas->shape.cells,
                                         .cell = gas->shape.cell,
                                         .corner = gas->shape.corner,
                                         .colored = true};
    kiln_gas_finish(gas);
    kiln_gas_init(gas, &shape);
    assert_true(kiln_gas_set_window(gas, (struct kiln_gas_place){0, 0, 0}, shape.cells));
    for (size_t i = 0; i < 64; i++) {
        assert_true(kiln_gas_brick_take(gas, &gas->brick[i]));
        for (int k = 0; k < GAS_BRICK_CELLS; k++) {
            float *color = gas->brick[i].extras + 4 * k;
            gas->brick[i].now[k * GAS_CARRIED + GAS_SMOKE] = 1.0f;
            color[0] = i % 4 < 2 ? 0.5f * 0.4f : 0.0f;
            color[3] = i % 4 < 2 ? 0.5f : 0.0f;
        }
    }
    f.light.sky_top = f.light.sky_horizon = FLOAT4(1, 1, 1, 0);
    const float *picture = gas_view_draw(&f), *left = picture + MIDDLE - 40,
                *right = picture + MIDDLE + 40;
    assert_near((double)(right[0] / right[1]), 1.0, 1e-6);
    assert_near((double)(left[0] / left[1]), (0.4 + 0.2) / 0.4, 1e-3);
    assert_near((double)(left[1] / right[1]), 0.5, 0.01); /* the sky has no mirror */
    gas_view_close(&f);
}

/* The middle of thick smoke is seen from 9 m, so haze leaves exp(-0.9) of its colour. */
static void haze_veils_gas(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas_look look = SMOKE;
    look.extinction = gas_view_value(200.0f);
    look.intensity = gas_view_value(100.0f);
    look.lights = false;
    gas_fixture_full(gas_view_add(&f, look), 32, 2.0f / 32.0f, 1.0f, 1.0f, 1.0f);
    const double bare = luminance(gas_view_draw(&f) + MIDDLE);
    f.light.floor_params.z = 0.1f;
    f.light.sky_horizon = FLOAT4(0.25f, 0.25f, 0.25f, 0.0f);
    const float *veiled = gas_view_draw(&f) + MIDDLE;
    const double clear = exp(-0.9);
    assert_near(luminance(veiled), bare * clear + 0.25 * (1.0 - clear), 5e-3);
    assert_near((double)veiled[3], 1.0, 1e-6);
    f.light.counts.z = 1; /* a transparent backdrop has no haze */
    assert_near(luminance(gas_view_draw(&f) + MIDDLE), bare, 1e-6);
    gas_view_close(&f);
}

/* ---- domains --------------------------------------------------------------------------------- */

static void a_domain_in_a_node_lies_there(void **state)
{
    (void)state;
    static float expected[FLOATS];
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = gas_view_add(&f, SMOKE);
    gas_fixture_ball(gas, 32, 2.0f / 32.0f, 0.4f, 1.0f, 0.0f);
    shine_from(&f, 0.48f, 0.6f, 0.64f);
    memcpy(expected, gas_view_draw(&f), sizeof expected);

    /* the same box in the node's frame, which is turned by a quarter turn, and half as large */
    f.scene->gas[0].attach = (struct kiln_attach){.name = "cart", .node = 0};
    gas->shape.cell *= 0.5f;
    gas->shape.corner = FLOAT3(0.5f * 1.0f - 0.5f, 1.0f, -1.5f - 0.5f);
    const float *turned = gas_view_draw(&f);
    double difference = 0.0;
    for (int i = 0; i < FLOATS; i++)
        difference += fabs((double)(turned[i] - expected[i]));
    assert_near(difference / FLOATS, 0.0, 2e-3);
    assert_true(turned[MIDDLE + 3] > 0.99f);
    gas_view_close(&f);
}

static void the_nearer_domain_hides_the_other(void **state)
{
    (void)state;
    for (uint32_t nearer = 0; nearer < 2; nearer++) {
        struct gas_view f;
        gas_view_open(&f);
        for (uint32_t i = 0; i < 2; i++) {
            struct kiln_gas_look look = {.extinction = gas_view_value(20.0f), .lights = true};
            look.albedo = i == nearer ? gas_view_value3(0, 1, 0) : gas_view_value3(1, 0, 0);
            struct kiln_gas *gas = gas_view_add(&f, look);
            gas_fixture_full(gas, 16, 1.0f / 16.0f, 1.0f, 0.0f, 0.0f);
            gas->shape.corner.y = 0.5f;
            gas->shape.corner.z = i == nearer ? 1.0f : -2.0f;
        }
        f.light.sky_top = f.light.sky_horizon = FLOAT4(1, 1, 1, 0);
        const float *pixel = gas_view_draw(&f) + MIDDLE;
        assert_true(pixel[1] > 0.1f && pixel[0] < 1e-6f);
        gas_view_close(&f);
    }
}

/* ---- bits ------------------------------------------------------------------------------------ */

static void threads_and_vectors_make_no_difference(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas_look look = SMOKE;
    look.intensity = gas_view_value(5.0f);
    look.absorption = gas_view_value(1.0f);
    look.scattering = gas_view_value(0.5f);
    look.glow = gas_view_value(1.0f);
    gas_fixture_ball(gas_view_add(&f, look), 48, 2.0f / 48.0f, 0.4f, 1.0f, 0.9f);
    shine_from(&f, 0.48f, 0.6f, 0.64f);
    f.light.sky_top = f.light.sky_horizon = FLOAT4(0.2f, 0.3f, 0.4f, 0);
    f.light.floor_params.z = 0.02f;
    gas_view_assert_bits(&f);
    gas_view_close(&f);
}

/* A cell in the last corner of a brick is spread to the first cells of seven bricks without gas,
 * which are drawn for it. Raw cells would show thin sheets of gas as columns. */
static void cells_spread_to_their_neighbours(void **state)
{
    (void)state;
    struct kiln_gas gas = {0};
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_volume_field field = {.gas = NULL};
    const struct kiln_volume_seen seen = {.least_smoke = 1e-6f, .least_flame = 1e-6f};
    gas_fixture_full(&gas, 24, 0.1f, 0.0f, 0.0f, 0.0f);
    float *now = gas.brick[kiln_gas_brick_index(&gas, 0, 0, 0)].now;
    float *cell = now + (ptrdiff_t)(GAS_BRICK_CELLS - 1) * GAS_CARRIED;
    cell[GAS_SMOKE] = 1.0f;
    cell[GAS_FLAME] = 0.5f;
    cell[GAS_TEMPERATURE] = 0.75f;
    assert_true(kiln_volume_field_fill(&field, &gas, &seen, threads, &error));
    double sum = 0.0;
    for (int32_t k = 0; k < 27; k++) {
        const int32_t x = 6 + k % 3, y = 6 + k / 3 % 3, z = 6 + k / 9;
        const int32_t block =
            field.block_of[kiln_gas_brick_index(&gas, x / GAS_BRICK, y / GAS_BRICK, z / GAS_BRICK)];
        assert_true(block >= 0);
        const float *drawn = kiln_volume_cell(kiln_volume_block(&field, (uint32_t)block),
                                              x % GAS_BRICK, y % GAS_BRICK, z % GAS_BRICK);
        const double weight =
            (x == 7 ? 0.625 : 0.1875) * (y == 7 ? 0.625 : 0.1875) * (z == 7 ? 0.625 : 0.1875);
        assert_near((double)drawn[VOLUME_SMOKE], weight, 1e-6);
        assert_near((double)drawn[VOLUME_FLAME], 0.5 * weight, 1e-6);
        assert_near((double)drawn[VOLUME_TEMPERATURE], 0.75, 1e-6);
        sum += (double)drawn[VOLUME_SMOKE];
    }
    assert_near(sum, 1.0, 1e-6);
    kiln_volume_field_finish(&field);
    kiln_gas_finish(&gas);
    kiln_threads_destroy(&threads);
}

/* Gas of one cell is spread to those around it. Samples of a cube read its 4 cells along each axis
 * and the next one. */
static void cubes_without_gas_have_no_block(void **state)
{
    (void)state;
    static const int32_t places[] = {0, 2, 3, 4, 5, 7, 8, 12, 23};
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(1);
    const struct kiln_volume_seen seen = {.least_smoke = 1e-3f, .least_flame = 1e-3f};
    for (size_t n = 0; n < sizeof places / sizeof *places; n++) {
        struct kiln_gas gas = {0};
        struct kiln_volume_field field = {.gas = NULL};
        const int32_t at[3] = {places[n], places[(n + 1) % 9], places[(n + 4) % 9]};
        gas_fixture_full(&gas, 24, 0.1f, 1e-6f, 0.0f, 0.0f);
        const size_t brick =
            kiln_gas_brick_index(&gas, at[0] / GAS_BRICK, at[1] / GAS_BRICK, at[2] / GAS_BRICK);
        const int32_t row = at[2] % GAS_BRICK * GAS_BRICK + at[1] % GAS_BRICK;
        float *cell =
            gas.brick[brick].now + (ptrdiff_t)(row * GAS_BRICK + at[0] % GAS_BRICK) * GAS_CARRIED;
        cell[n % 2 ? GAS_SMOKE : GAS_FLAME] = 1.0f;
        assert_true(kiln_volume_field_fill(&field, &gas, &seen, threads, &error));
        for (int32_t k = 0; k < 6 * 6 * 6; k++) {
            const int32_t cube[3] = {k % 6, k / 6 % 6, k / 36};
            bool meets = true;
            for (int i = 0; i < 3; i++)
                meets = meets && at[i] >= 4 * cube[i] - 1 && at[i] <= 4 * cube[i] + 5;
            const int32_t block =
                field.block_of[kiln_gas_brick_index(&gas, cube[0] / 2, cube[1] / 2, cube[2] / 2)];
            assert_int_equal(field.cube_of[k], meets ? block : -1);
            assert_true(!meets || block >= 0);
        }
        kiln_volume_field_finish(&field);
        kiln_gas_finish(&gas);
    }
    kiln_threads_destroy(&threads);
}

static void a_scene_without_gas_takes_no_memory(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_footprint none = {.threads = 2}, some = {.threads = 2};
    gas_view_open(&f);
    kiln_volume_footprint(f.scene, &none);
    assert_int_equal(kiln_footprint_total(&none), 0);
    struct kiln_gas *gas = gas_view_add(&f, SMOKE);
    gas_fixture_full(gas, 32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
    f.scene->gas[0].shape = gas->shape;
    kiln_volume_footprint(f.scene, &some);
    /* blocks of 9^3 cells with 8 floats, and three planes of four floats */
    assert_true(kiln_footprint_total(&some) > UINT64_C(64) * 729 * 32 + SIZE * SIZE * 48);
    gas_view_close(&f);
}

static void no_gas_leaves_pictures_as_they_are(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = gas_view_add(&f, SMOKE);
    kiln_gas_init(gas, &(struct kiln_gas_shape){.cells = {32, 32, 32}, .cell = 0.1f});
    const float *picture = gas_view_draw(&f);
    for (int i = 0; i < FLOATS; i++)
        assert_true(picture[i] == 0.0f);
    gas_view_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_dims_by_the_length_of_its_chord),
        cmocka_unit_test(a_ball_is_as_its_mirror_image),
        cmocka_unit_test(an_object_hides_what_is_behind_it),
        cmocka_unit_test(the_camera_may_be_inside),
        cmocka_unit_test(even_flames_have_the_closed_form),
        cmocka_unit_test(flames_shine_by_plancks_law),
        cmocka_unit_test(flames_light_the_smoke_beside_them),
        cmocka_unit_test(cells_do_not_change_the_light_of_flames),
        cmocka_unit_test(the_side_of_the_sun_is_lit),
        cmocka_unit_test(thin_smoke_scatters_the_octaves),
        cmocka_unit_test(objects_hide_the_sun_from_gas),
        cmocka_unit_test(lamps_light_thin_smoke),
        cmocka_unit_test(smoke_has_colors_of_its_own),
        cmocka_unit_test(haze_veils_gas),
        cmocka_unit_test(a_domain_in_a_node_lies_there),
        cmocka_unit_test(the_nearer_domain_hides_the_other),
        cmocka_unit_test(threads_and_vectors_make_no_difference),
        cmocka_unit_test(cells_spread_to_their_neighbours),
        cmocka_unit_test(cubes_without_gas_have_no_block),
        cmocka_unit_test(a_scene_without_gas_takes_no_memory),
        cmocka_unit_test(no_gas_leaves_pictures_as_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
