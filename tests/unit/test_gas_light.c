/* lib/draw/light/gas_cells and gas_light, lib/draw/volume/volume_lamps and volume_shade: gas would
 * throw too dark or too light a shadow on what is around it, its flames would shed too much light,
 * from the wrong place, or light that jumps, or lamps, sun and sky would shine on gas through smoke
 * and objects. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/gas_light.h"
#include "draw/light/lamps.h"
#include "draw/light/lighting.h"
#include "support/cmocka.h"
#include "support/gas_fixture.h"
#include "support/gas_view.h"

enum { GRID = KILN_SMOKE_GRID, MIDDLE = GAS_VIEW_MIDDLE, SIZE = GAS_VIEW_SIZE };

static const double PI = 3.14159265358979;

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most))
        fail_msg("found %.6f, expected %.6f within %g", found, expected, most);
}

/* Returns a look whose flames shine, and whose smoke throws shadows. */
static struct kiln_gas_look look_of(float extinction, float absorption, float intensity)
{
    return (struct kiln_gas_look){.extinction = gas_view_value(extinction),
                                  .absorption = gas_view_value(absorption),
                                  .intensity = gas_view_value(intensity),
                                  .light = gas_view_value(1.0f),
                                  .lights = true,
                                  .shadow = true};
}

static struct kiln_gas *add(struct gas_view *f, struct kiln_gas_look look)
{
    struct kiln_gas *gas = gas_view_add(f, look);
    f->scene->gas[f->scene->gas_count - 1].burn.enabled = true;
    return gas;
}

static void gather(struct gas_view *f, struct kiln_gas_cells *cells, struct kiln_threads *threads)
{
    struct kiln_error error = {0};
    assert_true(kiln_gas_cells_gather(cells, &f->moment, &f->pool, threads, &error));
}

/* ---- shadows --------------------------------------------------------------------------------- */

/* Holds the grids of the gas of a view. */
struct shadow {
    struct kiln_threads *threads;
    struct kiln_gas_cells cells;
    struct kiln_smoke_shadow *shadow;
    struct kiln_smoke_grid grid;
    float depth[GRID * GRID * GRID];
    float extinction[GRID * GRID * GRID / 8];
};

/* Fills a grid; returns whether there is smoke. */
static bool cast(struct gas_view *f, struct shadow *s, float3 direction)
{
    const struct kiln_smoke smoke = {.gas = &s->cells};
    s->threads = kiln_threads_create(f->threads);
    s->shadow = kiln_smoke_shadow_create();
    s->grid = (struct kiln_smoke_grid){
        .direction = direction, .depth = s->depth, .extinction = s->extinction};
    gather(f, &s->cells, s->threads);
    return kiln_smoke_shadow_fill(s->shadow, &smoke, s->threads, &s->grid, 1);
}

static void finish_shadow(struct shadow *s)
{
    kiln_smoke_shadow_destroy(&s->shadow);
    kiln_threads_destroy(&s->threads);
    kiln_gas_cells_finish(&s->cells);
    free(s);
}

static struct shadow *new_shadow(void)
{
    struct shadow *s = calloc(1, sizeof *s);
    assert_non_null(s);
    return s;
}

static double depth_at(const struct shadow *s, double x, double y, double z)
{
    size_t cell[3];
    for (int i = 0; i < 3; i++) {
        const float4 row = s->grid.world_to_grid[i];
        const double at = (double)row.x * x + (double)row.y * y + (double)row.z * z + (double)row.w;
        const double last = GRID - 1, place = floor(at * GRID);
        assert_true(i == 2 || (at > 0 && at < 1));
        cell[i] = (size_t)(place < 0 ? 0 : place > last ? last : place);
    }
    return (double)s->depth[(cell[2] * GRID + cell[1]) * GRID + cell[0]];
}

/* The middle of a full box of 2 m has half of its depth before it, and what is below has all of it,
 * whichever way the light comes. Along a slanted way the box is longer. */
static void a_box_dims_by_its_optical_depth(void **state)
{
    (void)state;
    static const float3 ways[] = {{0, 1, 0}, {1, 0, 0}, {0, -0.6f, 0.8f}};
    static const double lengths[] = {1.0, 1.0, 1.25};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        struct gas_view f;
        struct shadow *s = new_shadow();
        gas_view_open(&f);
        struct kiln_gas *gas = add(&f, look_of(0.7f, 0.2f, 0.0f));
        gas_fixture_full(gas, 64, 2.0f / 64.0f, 1.0f, 0.0f, 0.5f);
        f.scene->gas[0].shape = gas->shape;
        assert_true(cast(&f, s, ways[i]));
        const double x = (double)ways[i].x, y = (double)ways[i].y, z = (double)ways[i].z;
        const double k = 0.8, half = lengths[i];
        assert_near(depth_at(s, 0, 1, 0), k * half, 0.04);
        assert_near(depth_at(s, -1.5 * x, 1 - 1.5 * y, -1.5 * z), 2 * k * half, 0.04);
        assert_near(depth_at(s, 1.3 * half * x, 1 + 1.3 * half * y, 1.3 * half * z), 0, 0.01);
        finish_shadow(s);
        gas_view_close(&f);
    }
}

/* A ball dims by its chord. Its domain lies in a node that turns it and makes it twice as large. */
static void a_ball_in_a_node_dims_by_its_chord(void **state)
{
    (void)state;
    struct gas_view f;
    struct shadow *s = new_shadow();
    gas_view_open(&f);
    struct kiln_gas *gas = add(&f, look_of(0.5f, 0.0f, 0.0f));
    gas_fixture_ball(gas, 64, 2.0f / 64.0f, 0.4f, 1.0f, 0.0f);
    f.scene->gas[0].shape = gas->shape;
    f.scene->gas[0].attach = (struct kiln_attach){.name = "cart", .node = 0};
    assert_true(cast(&f, s, (float3){0, 1, 0}));
    for (int i = 0; i < 4; i++) {
        const double aside = 0.3 * i, chord = 2 * sqrt(1.6 * 1.6 - aside * aside);
        assert_near(depth_at(s, 3 + aside, -5, 1), 0.5 * chord, 0.05);
        assert_near(depth_at(s, 3, -5, 1 + aside), 0.5 * chord, 0.05);
    }
    finish_shadow(s);
    gas_view_close(&f);
}

/* Small gas in a large grid keeps its sum: large steps read means of many cells. */
static void small_gas_keeps_its_sum(void **state)
{
    (void)state;
    static const float corners[][3] = {{-9, 0, -9}, {9, 7, 9}};
    struct gas_view f;
    struct shadow *s = new_shadow();
    gas_view_open(&f);
    for (int i = 0; i < 2; i++) {
        struct kiln_gas *gas = add(&f, look_of(0.4f, 0.0f, 0.0f));
        gas_fixture_full(gas, 32, 1.0f / 32.0f, 1.0f, 0.0f, 0.0f);
        gas->shape.corner = FLOAT3(corners[i][0], corners[i][1], corners[i][2]);
        f.scene->gas[i].shape = gas->shape;
    }
    assert_true(cast(&f, s, (float3){0, 1, 0}));
    double sum = 0,
           edge_m = 1 / sqrt((double)(s->grid.world_to_grid[1].x * s->grid.world_to_grid[1].x +
                                      s->grid.world_to_grid[1].z * s->grid.world_to_grid[1].z));
    for (int i = 0; i < GRID * GRID; i++)
        sum += (double)s->depth[i];
    assert_near(sum * edge_m * edge_m / (GRID * GRID), 2 * 0.4, 0.06);
    finish_shadow(s);
    gas_view_close(&f);
}

static void only_gas_with_shadows_dims(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct gas_view f;
        struct shadow *s = new_shadow();
        gas_view_open(&f);
        gas_fixture_full(add(&f, look_of(0.7f, 0.0f, 0.0f)), 32, 2.0f / 32.0f, i == 3 ? 0.0f : 1.0f,
                         0.0f, 0.0f);
        f.scene->gas[0].look.shadow = i != 1;
        f.scene->gas[0].enabled = i != 2;
        assert_true(kiln_scene_has_smoke(f.scene) == (i == 0 || i == 3));
        assert_true(cast(&f, s, (float3){0, 1, 0}) == (i == 0));
        finish_shadow(s);
        gas_view_close(&f);
    }
}

/* Without a domain, its gas does not dim, and a puff of smoke beside it does. */
static void a_domain_is_left_out(void **state)
{
    (void)state;
    struct gas_view f;
    struct shadow *s = new_shadow();
    static float all[GRID * GRID * GRID];
    float *const depths[] = {s->depth};
    gas_view_open(&f);
    struct kiln_gas *gas = add(&f, look_of(0.7f, 0.0f, 0.0f));
    gas_fixture_full(gas, 32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
    f.scene->gas[0].shape = gas->shape;
    struct kiln_puff puff = {.position = {3.0f, 1.0f, 0.0f}, .radius = 1.0f, .extinction = 2.0f};
    uint32_t count = 1;
    const struct kiln_smoke smoke = {
        .puffs = &puff, .counts = &count, .chunk_count = 1, .gas = &s->cells};
    s->threads = kiln_threads_create(2);
    s->shadow = kiln_smoke_shadow_create();
    s->grid = (struct kiln_smoke_grid){.direction = {0, 1, 0}, .depth = s->depth};
    gather(&f, &s->cells, s->threads);
    assert_true(kiln_smoke_shadow_fill(s->shadow, &smoke, s->threads, &s->grid, 1));
    const double below_gas = depth_at(s, 0, -1, 0), below_puff = depth_at(s, 3, -1, 0);
    assert_near(below_gas, 1.4, 0.04);
    assert_true(below_puff > 0.5);
    memcpy(all, s->depth, sizeof all);
    assert_true(kiln_smoke_shadow_without(s->shadow, 0, s->threads, depths, 1));
    assert_near(depth_at(s, 0, -1, 0), 0.0, 0.0);
    assert_near(depth_at(s, 3, -1, 0), below_puff, 0.0);
    assert_true(kiln_smoke_shadow_without(s->shadow, 1, s->threads, depths, 1));
    assert_memory_equal(s->depth, all, sizeof all);
    count = 0;
    assert_true(!kiln_smoke_shadow_without(s->shadow, 0, s->threads, depths, 1));
    finish_shadow(s);
    gas_view_close(&f);
}

/* ---- light of flames ------------------------------------------------------------------------- */

static uint32_t shed(struct gas_view *f, struct kiln_draw_light lights[KILN_GAS_LIGHTS])
{
    struct kiln_gas_cells cells = {.count = 0};
    struct kiln_threads *threads = kiln_threads_create(f->threads);
    gather(f, &cells, threads);
    assert_int_equal(cells.count, 1);
    const uint32_t count = kiln_gas_light_gather(&cells.blocks[0], threads, lights);
    kiln_gas_cells_finish(&cells);
    kiln_threads_destroy(&threads);
    return count;
}

/* Returns the luminance of all lights. */
static double all_of(const struct kiln_draw_light *lights, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += 0.2126 * (double)lights[i].color.x + 0.7152 * (double)lights[i].color.y +
               0.0722 * (double)lights[i].color.z;
    return sum;
}

/* Even gas that emits j a metre, in a volume V, has lights of j V / pi together, and of it the part
 * (1 - exp(-k L)) / (k L) if it swallows k. Temperature 1 has the luminance 1. */
static void flames_shed_what_leaves_them(void **state)
{
    (void)state;
    static const double absorptions[] = {0.0, 0.05, 0.9, 6.0};
    double whole = 0;
    for (int i = 0; i < 4; i++) {
        struct gas_view f;
        struct kiln_draw_light lights[KILN_GAS_LIGHTS];
        gas_view_open(&f);
        struct kiln_gas_look look =
            look_of(0.5f * (float)absorptions[i], (float)absorptions[i], 3.0f);
        struct kiln_gas *gas = add(&f, look);
        gas_fixture_full(gas, 32, 2.0f / 32.0f, 1.0f, 1.0f, 0.5f);
        f.scene->gas[0].shape = gas->shape;
        const uint32_t count = shed(&f, lights);
        const double depth = absorptions[i] * 2.0;
        const double part = depth > 0 ? (1 - exp(-depth)) / depth : 1;
        assert_int_equal(count, KILN_GAS_LIGHTS);
        whole = i == 0 ? all_of(lights, count) : whole;
        assert_near(all_of(lights, count) / (whole * part), 1.0, 2e-3);
        gas_view_close(&f);
    }
    assert_near(whole / (3.0 * 0.5 * 8.0 / PI), 1.0, 1e-2); /* a step of the table of colours */
}

static void a_fire_needs_flames(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct gas_view f;
        struct kiln_draw_light lights[KILN_GAS_LIGHTS];
        gas_view_open(&f);
        struct kiln_gas *gas = add(&f, look_of(1.0f, 0.0f, 3.0f));
        gas_fixture_full(gas, 32, 2.0f / 32.0f, 1.0f, 1.0f, i == 0 ? 0.0f : 0.5f);
        f.scene->gas[0].shape = gas->shape;
        f.scene->gas[0].look.light = gas_view_value(i == 1 ? 0.0f : 1.0f);
        f.scene->gas[0].burn.enabled = i != 2;
        if (i == 3)
            f.scene->gas[0].look.intensity = gas_view_value(0.0f);
        assert_true(kiln_scene_has_firelight(f.scene) == (i == 0));
        assert_int_equal(kiln_scene_shadow_lights(f.scene), i == 0 ? KILN_GAS_LIGHTS : 0);
        assert_int_equal(shed(&f, lights), 0);
        gas_view_close(&f);
    }
}

/* Fills a domain of 64^3 cells with a round flame whose amount falls off smoothly. */
static void fill_flame(struct kiln_gas *gas, const double at[3], double radius)
{
    for (int32_t z = 0; z < 64; z++)
        for (int32_t y = 0; y < 64; y++)
            for (int32_t x = 0; x < 64; x++) {
                const double away[3] = {x + 0.5 - at[0], y + 0.5 - at[1], z + 0.5 - at[2]};
                const double square =
                    (away[0] * away[0] + 0.25 * away[1] * away[1] + away[2] * away[2]) /
                    (radius * radius);
                struct kiln_gas_brick *brick =
                    &gas->brick[kiln_gas_brick_index(gas, x / 8, y / 8, z / 8)];
                float *q = brick->now + ((z % 8 * 8 + y % 8) * 8 + x % 8) * GAS_CARRIED;
                q[GAS_TEMPERATURE] = 0.8f;
                q[GAS_FLAME] = square < 1 ? (float)((1 - square) * (1 - square)) : 0.0f;
                q[GAS_SMOKE] = 0.0f;
            }
}

/* All lights together lie in the middle of the fire; as it drifts by a quarter of a cell, each of
 * them does, and none of them changes. */
static void lights_move_with_the_fire(void **state)
{
    (void)state;
    const double cell = 2.0 / 64;
    struct kiln_draw_light lights[KILN_GAS_LIGHTS], before[KILN_GAS_LIGHTS];
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = add(&f, look_of(1.0f, 0.0f, 3.0f));
    gas_fixture_full(gas, 64, (float)cell, 0.0f, 0.0f, 0.0f);
    f.scene->gas[0].shape = gas->shape;
    for (int step = 0; step < 24; step++) {
        const double drift = 0.25 * step;
        fill_flame(gas, (double[]){26 + drift, 28 + drift, 30 - drift}, 11.3);
        assert_int_equal(shed(&f, lights), KILN_GAS_LIGHTS);
        double mean[3] = {0}, all = 0;
        for (int k = 0; k < KILN_GAS_LIGHTS; k++) {
            const double one = (double)lights[k].color.x;
            const float4 p = lights[k].position_radius2;
            const double at[3] = {(double)p.x, (double)p.y, (double)p.z};
            all += one;
            for (int c = 0; c < 3; c++)
                mean[c] += one * at[c];
            if (step == 0)
                continue;
            const float4 q = before[k].position_radius2;
            const double way[3] = {(double)q.x, (double)q.y, (double)q.z};
            for (int c = 0; c < 3; c++)
                assert_near(at[c] - way[c], (c == 2 ? -0.25 : 0.25) * cell, 0.03 * cell);
            assert_near(one / (double)before[k].color.x, 1.0, 0.01);
            assert_near((double)(p.w / q.w), 1.0, 0.01);
        }
        for (int c = 0; c < 3; c++) {
            const double corner = c == 1 ? 0.0 : -1.0, start = 26 + 2 * c;
            const double at = corner + cell * (start + (c == 2 ? -drift : drift));
            assert_near(mean[c] / all, at, 0.02 * cell);
        }
        memcpy(before, lights, sizeof before);
    }
    gas_view_close(&f);
}

/* ---- lamps on gas ---------------------------------------------------------------------------- */

/* Smoke of depth d before the middle of a box leaves known parts of the octaves there. */
static void smoke_dims_lamps_on_gas(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    struct shadow *s = new_shadow();
    gas_view_open(&f);
    struct kiln_gas_look look = look_of(0.5f, 0.0f, 0.0f);
    look.albedo = gas_view_value3(0.8f, 0.8f, 0.8f);
    struct kiln_gas *gas = add(&f, look);
    gas_fixture_full(gas, 64, 2.0f / 64.0f, 1.0f, 0.0f, 0.0f);
    f.scene->gas[0].shape = gas->shape;
    assert_true(cast(&f, s, (float3){0, 1, 0}));
    f.light.counts.y = 1;
    f.light.lights[0] = (struct kiln_draw_light){.position_radius2 = {0.0f, 101.0f, 0.0f, 0.25f},
                                                 .color = {5000.0f, 0.0f, 0.0f, 0.5f},
                                                 .casters.w = 1};
    struct kiln_lamp_smoke *smoke = kiln_lamp_smoke_create(f.moment.simd);
    struct kiln_lighting lighting = {.light_count = 1};
    lighting.lamp_smoke = kiln_lamp_smoke_run(smoke, &s->grid, s->threads, f.light.lights, 1,
                                              &lighting.lamp_smoke_count, &error);
    assert_non_null(lighting.lamp_smoke);
    f.lighting = &lighting;
    const double seen = 0.8 * (1 - exp(-0.5 * 2)), lit = 5000.0 / (100.0 * 100.0 + 0.25);
    const double part = 0.34 * exp(-0.5) + 0.26 * exp(-0.42 * 0.5) + 0.07 * exp(-0.16 * 0.5);
    assert_near((double)gas_view_draw(&f)[MIDDLE] / (seen * lit * part), 1.0, 0.03);
    gas_view_assert_bits(&f);

    lighting.gas_lights[0] =
        (struct kiln_light_range){0, 1}; /* as if it came from the gas itself */
    assert_true(gas_view_draw(&f)[MIDDLE] == 0.0f);
    kiln_lamp_smoke_destroy(&smoke);
    finish_shadow(s);
    gas_view_close(&f);
}

/* The shadow of a ball is 0.8 m wide in the middle of thin gas of 2 m; beside it is none. */
static void objects_hide_lamps_from_gas(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    gas_view_open(&f);
    struct kiln_gas_look look = look_of(0.001f, 0.0f, 0.0f);
    look.albedo = gas_view_value3(0.8f, 0.8f, 0.8f);
    gas_fixture_full(add(&f, look), 64, 2.0f / 64.0f, 1.0f, 0.0f, 0.0f);
    struct kiln_object *ball = &f.scene->backdrop.objects[f.scene->backdrop.object_count++];
    *ball = (struct kiln_object){.kind = KILN_OBJECT_SPHERE,
                                 .center = gas_view_value3(0.0f, 5.0f, 0.0f),
                                 .radius = gas_view_value(0.2f),
                                 .visible = true};
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    f.light.counts.y = 1;
    f.light.lights[0] = (struct kiln_draw_light){.position_radius2 = {0.0f, 9.0f, 0.0f, 0.0001f},
                                                 .color = {500.0f, 0.0f, 0.0f, 0.01f},
                                                 .casters = {1, 0, 0, 1}};
    const float open = gas_view_draw(&f)[MIDDLE];
    const float beside_open = gas_view_draw(&f)[MIDDLE + 4 * 20];
    kiln_lamps_find_casters(&f.moment, f.light.lights, 1);
    struct kiln_lighting lighting = {.light_count = 1};
    f.lighting = &lighting;
    const float *picture = gas_view_draw(&f);
    assert_true(open > 0.0f);
    assert_near((double)(picture[MIDDLE] / open), 0.6, 0.02);
    assert_near((double)(picture[MIDDLE + 4 * 20] / beside_open), 1.0, 1e-3);
    gas_view_assert_bits(&f);
    ball->center = gas_view_value3(5.0f, 5.0f, 0.0f);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    kiln_lamps_find_casters(&f.moment, f.light.lights, 1);
    assert_near((double)(gas_view_draw(&f)[MIDDLE] / open), 1.0, 1e-5);
    gas_view_close(&f);
}

/* ---- sun and sky on gas ---------------------------------------------------------------------- */

/* Names the light that reaches thin gas through a slab. */
enum light { SUN, SKY };

/* Returns the light of the middle of thin gas below a slab of 2 m, which hides `extinction` a metre
 * and throws a shadow or not. bits: whether the picture is also compared between levels and
 * threads.
 */
static double lit_below_slab(enum light light, float extinction, bool shadow, bool bits)
{
    struct gas_view f;
    struct kiln_error error = {0};
    gas_view_open(&f);
    struct kiln_gas_look look = look_of(0.001f, 0.0f, 0.0f);
    look.albedo = gas_view_value3(0.8f, 0.8f, 0.8f);
    gas_fixture_full(add(&f, look), 64, 2.0f / 64.0f, 1.0f, 0.0f, 0.0f);
    look.extinction = gas_view_value(extinction);
    look.shadow = shadow;
    struct kiln_gas *slab = add(&f, look);
    gas_fixture_full(slab, 64, 2.0f / 64.0f, 1.0f, 0.0f, 0.0f);
    slab->shape.corner.y += 3.0f; /* above the picture */
    for (int i = 0; i < 2; i++)
        f.scene->gas[i].shape = f.pool.gas[i].shape;
    f.scene->backdrop.sun_direction = gas_view_value3(0.0f, 1.0f, 0.0f);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    if (light == SUN)
        f.light.sun_color = (float4){9.0f, 9.0f, 9.0f, 0.0f};
    else
        f.light.sky_top = f.light.sky_horizon = (float4){9.0f, 9.0f, 9.0f, 0.0f};
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_lighting_stage *stage = kiln_lighting_create(NULL, &f.moment, threads, &error);
    struct kiln_lighting lighting;
    assert_non_null(stage);
    f.moment.pool = &f.pool;
    assert_true(kiln_lighting_run(stage, &f.moment, &f.pool, &lighting, &error));
    f.lighting = &lighting;
    const double lit = (double)gas_view_draw(&f)[MIDDLE];
    if (bits)
        gas_view_assert_bits(&f);
    kiln_lighting_destroy(&stage);
    kiln_threads_destroy(&threads);
    gas_view_close(&f);
    return lit;
}

/* A slab of depth d over thin gas leaves known parts of its sun: exp(-d) of what is scattered once,
 * and more of the octaves that have gone round it. Of the sky it leaves exp(-d / 2). Gas that
 * throws no shadow leaves all. */
static void other_gas_dims_sun_and_sky(void **state)
{
    (void)state;
    const double open = lit_below_slab(SUN, 0.45f, false, false);
    const double sky = lit_below_slab(SKY, 0.45f, false, false);
    assert_true(open > 0 && sky > 0);
    static const double extinctions[] = {0.2, 0.45, 1.1};
    for (int i = 0; i < 3; i++) {
        const double d = 2 * extinctions[i];
        const double part = lit_below_slab(SUN, (float)extinctions[i], true, i == 1) / open;
        const double most = 0.34 * exp(-d) + 0.26 * exp(-0.42 * d) + 0.07 * exp(-0.16 * d);
        assert_near(part, most / 0.67, 0.02);
        assert_near(lit_below_slab(SKY, (float)extinctions[i], true, i == 1) / sky, exp(-0.5 * d),
                    0.02);
    }
}

static void threads_do_not_change_light(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_draw_light first[KILN_GAS_LIGHTS], lights[KILN_GAS_LIGHTS];
    static float depth[GRID * GRID * GRID];
    gas_view_open(&f);
    struct kiln_gas *gas = add(&f, look_of(1.5f, 0.5f, 3.0f));
    gas_fixture_ball(gas, 64, 2.0f / 64.0f, 0.4f, 1.0f, 0.7f);
    f.scene->gas[0].shape = gas->shape;
    for (f.threads = 1; f.threads <= 3; f.threads++) {
        struct shadow *s = new_shadow();
        assert_int_equal(shed(&f, lights), KILN_GAS_LIGHTS);
        assert_true(cast(&f, s, (float3){0.6f, 0.8f, 0}));
        if (f.threads == 1) {
            memcpy(first, lights, sizeof first);
            memcpy(depth, s->depth, sizeof depth);
        }
        assert_memory_equal(first, lights, sizeof first);
        assert_memory_equal(depth, s->depth, sizeof depth);
        finish_shadow(s);
    }
    gas_view_close(&f);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_dims_by_its_optical_depth),
        cmocka_unit_test(a_ball_in_a_node_dims_by_its_chord),
        cmocka_unit_test(small_gas_keeps_its_sum),
        cmocka_unit_test(only_gas_with_shadows_dims),
        cmocka_unit_test(a_domain_is_left_out),
        cmocka_unit_test(flames_shed_what_leaves_them),
        cmocka_unit_test(a_fire_needs_flames),
        cmocka_unit_test(lights_move_with_the_fire),
        cmocka_unit_test(smoke_dims_lamps_on_gas),
        cmocka_unit_test(objects_hide_lamps_from_gas),
        cmocka_unit_test(other_gas_dims_sun_and_sky),
        cmocka_unit_test(threads_do_not_change_light),
    };
    return cmocka_run_group_tests_name("gas_light", tests, NULL, NULL);
}
