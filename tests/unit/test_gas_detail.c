/* The detail of drawn gas: noise would swim through the gas, be seen when it begins anew, become
 * hair where gas is sheared, or change the amount of gas; edges would not become steeper, or veils
 * of thin smoke would be lost. */
#include <math.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_view.h"

enum { SIZE = GAS_VIEW_SIZE, FLOATS = GAS_VIEW_FLOATS };

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most))
        fail_msg("found %.6f, expected %.6f within %g", found, expected, most);
}

/* Makes a domain of even thin smoke that came from where it is. */
static struct kiln_gas *add_detailed(struct gas_view *f, uint32_t detail)
{
    const struct kiln_gas_look look = {.extinction = gas_view_value(0.2f),
                                       .albedo = gas_view_value3(0.8f, 0.8f, 0.8f),
                                       .lights = true};
    struct kiln_gas *gas = gas_view_add(f, look);
    const struct kiln_gas_shape shape = {.cells = {64, 64, 64},
                                         .cell = 2.0f / 64.0f,
                                         .corner = FLOAT3(-1.0f, 0.0f, -1.0f),
                                         .detailed = true};
    f->scene->gas[0].detail = detail;
    kiln_gas_init(gas, &shape);
    assert_true(kiln_gas_set_window(gas, (struct kiln_gas_place){0, 0, 0}, shape.cells));
    for (size_t i = 0; i < 512; i++) {
        assert_true(kiln_gas_brick_take(gas, &gas->brick[i]));
        for (int k = 0; k < GAS_BRICK_CELLS; k++)
            gas->brick[i].now[k * GAS_CARRIED + GAS_SMOKE] = 1.0f;
    }
    return gas;
}

/* Sets the ways of a group everywhere. */
static void set_ways(struct kiln_gas *gas, uint32_t group, float x)
{
    for (size_t i = 0; i < 512; i++)
        for (size_t k = 0; k < GAS_BRICK_CELLS; k++)
            gas->brick[i].extras[(group * GAS_BRICK_CELLS + k) * GAS_CARRIED] = x;
}

/* Gives a way or an amount of smoke to the gas at a place, cells from the window's first one. */
typedef float3 way_at(float x, float y, float z);
typedef float smoke_at(float x);

static float3 place_of(size_t brick, size_t k)
{
    return (float3){(float)(brick % 8 * GAS_BRICK + k % GAS_BRICK),
                    (float)(brick / 8 % 8 * GAS_BRICK + k / GAS_BRICK % GAS_BRICK),
                    (float)(brick / 64 * GAS_BRICK + k / GAS_BRICK / GAS_BRICK)};
}

/* Sets the ways of both groups, which are given in cells. */
static void set_ways_at(struct kiln_gas *gas, way_at *way_of)
{
    for (size_t i = 0; i < 512; i++)
        for (size_t k = 0; k < GAS_BRICK_CELLS; k++) {
            const float3 at = place_of(i, k), way = way_of(at.x, at.y, at.z);
            for (size_t group = 0; group < 2; group++) {
                float *to = gas->brick[i].extras + (group * GAS_BRICK_CELLS + k) * GAS_CARRIED;
                to[0] = way.x * gas->shape.cell;
                to[1] = way.y * gas->shape.cell;
                to[2] = way.z * gas->shape.cell;
            }
        }
}

static void set_smoke(struct kiln_gas *gas, smoke_at *smoke_of, float factor)
{
    for (size_t i = 0; i < 512; i++)
        for (size_t k = 0; k < GAS_BRICK_CELLS; k++)
            gas->brick[i].now[k * GAS_CARRIED + GAS_SMOKE] = factor * smoke_of(place_of(i, k).x);
}

struct spread {
    double mean, deviation;
};

/* Returns the optical depths of the smoke in the middle of the picture. */
static struct spread depths_of(const float *picture)
{
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (int y = 24; y < 41; y++)
        for (int x = 24; x < 41; x++) {
            const double depth = -log(1.0 - (double)picture[4 * (y * SIZE + x) + 3]);
            sum += depth;
            squares += depth * depth;
            count += 1.0;
        }
    const double mean = sum / count;
    return (struct spread){mean, sqrt(squares / count - mean * mean)};
}

/* The lattice of noise has 21 cells along a ray, so the mean of rays changes by a few percent. */
static void detail_changes_gas_but_not_its_amount(void **state)
{
    (void)state;
    for (uint32_t detail = 1; detail <= 4; detail *= 2) {
        struct gas_view f;
        gas_view_open(&f);
        add_detailed(&f, detail);
        const struct spread found = depths_of(gas_view_draw(&f));
        assert_near(found.mean / 0.4, 1.0, 0.05);
        assert_near(found.deviation / found.mean, detail == 1 ? 0.0 : 0.1,
                    detail == 1 ? 1e-2 : 0.05);
        gas_view_close(&f);
    }
}

static void set_step(struct gas_view *f, uint32_t step)
{
    f->moment.view.clock_step.x = step;
}

/* 24 steps at 30 a second are a period. A group counts for nothing when it begins anew. */
static void ways_that_begin_anew_are_not_seen(void **state)
{
    (void)state;
    static float before[FLOATS];
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = add_detailed(&f, 2);
    for (uint32_t group = 0; group < 2; group++) {
        set_step(&f, group == 0 ? 24 : 12);
        set_ways(gas, 0, 0.0f);
        set_ways(gas, 1, 0.0f);
        memcpy(before, gas_view_draw(&f), sizeof before);
        set_ways(gas, group, 0.3f);
        const float *after = gas_view_draw(&f);
        double most = 0.0;
        for (int i = 0; i < FLOATS; i++)
            most = fmax(most, fabs((double)(after[i] - before[i])));
        assert_near(most, 0.0, 1e-5);
        set_ways(gas, 1 - group, 0.3f);
        after = gas_view_draw(&f);
        for (int i = 0; i < FLOATS; i++)
            most = fmax(most, fabs((double)(after[i] - before[i])));
        assert_true(most > 0.01);
    }
    gas_view_close(&f);
}

/* Gas that has moved by a length shows the noise of where it was. */
static void noise_moves_with_the_gas(void **state)
{
    (void)state;
    static float before[FLOATS];
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = add_detailed(&f, 2);
    memcpy(before, gas_view_draw(&f), sizeof before);
    /* a window of the domain one stride to the right, whose gas came from the left */
    gas->at.x = KILN_GAS_STRIDE;
    gas->shape.corner.x -= (float)KILN_GAS_STRIDE * gas->shape.cell;
    set_ways(gas, 0, -(float)KILN_GAS_STRIDE * gas->shape.cell);
    set_ways(gas, 1, -(float)KILN_GAS_STRIDE * gas->shape.cell);
    const float *after = gas_view_draw(&f);
    for (int i = 0; i < FLOATS; i++)
        assert_near((double)after[i], (double)before[i], 1e-3);
    gas_view_close(&f);
}

static float3 turned(float x, float y, float z)
{
    return (float3){-y - x, x - y, 0.0f * z};
}

static float3 sheared(float x, float y, float z)
{
    return (float3){4.0f * y, 0.0f * x, 0.0f * z};
}

static void sheared_gas_has_no_noise(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    struct kiln_gas *gas = add_detailed(&f, 2);
    set_ways_at(gas, turned);
    struct spread found = depths_of(gas_view_draw(&f));
    assert_near(found.deviation / found.mean, 0.1, 0.05);
    set_ways_at(gas, sheared);
    found = depths_of(gas_view_draw(&f));
    assert_near(found.deviation / found.mean, 0.0, 0.01);
    assert_near(found.mean / 0.4, 1.0, 0.01);
    gas_view_close(&f);
}

/* Both groups are seen alike at step 6. If one is sheared, the picture has the noise of the other.
 */
static void the_other_group_takes_the_part_of_a_sheared_one(void **state)
{
    (void)state;
    for (uint32_t group = 0; group < 2; group++) {
        struct gas_view f;
        gas_view_open(&f);
        struct kiln_gas *gas = add_detailed(&f, 2);
        set_step(&f, 6);
        set_ways_at(gas, sheared);
        set_ways(gas, group, 0.0f);
        const struct spread found = depths_of(gas_view_draw(&f));
        assert_near(found.deviation / found.mean, 0.1, 0.05);
        gas_view_close(&f);
    }
}

/* The amount grows from cell 30 on for 8 cells. */
static float ramp(float x)
{
    return x < 30.0f ? 0.0f : x < 38.0f ? (x - 30.0f) / 8.0f : 1.0f;
}

/* Pixels 31, 32, and 33 of a row see cells 0.2, 1.5, and 2.8 behind the edge. Sheared ways turn off
 * the noise. */
static void edges_are_as_steep_in_thin_smoke_as_in_dense_smoke(void **state)
{
    (void)state;
    enum { ROW = SIZE * (SIZE / 2) };
    for (float amount = 1.0f; amount > 0.2f; amount *= 0.3f) {
        double depth[2][3];
        for (uint32_t detail = 1; detail <= 2; detail++) {
            struct gas_view f;
            gas_view_open(&f);
            struct kiln_gas *gas = add_detailed(&f, detail);
            f.scene->gas[0].look.extinction = gas_view_value(5.0f);
            set_ways_at(gas, sheared);
            set_smoke(gas, ramp, amount);
            const float *picture = gas_view_draw(&f);
            for (int i = 0; i < 3; i++)
                depth[detail - 1][i] = -log(1.0 - (double)picture[4 * (ROW + 31 + i) + 3]);
            gas_view_close(&f);
        }
        assert_near(depth[1][0] / depth[0][0], 0.0, 0.01);
        assert_near(depth[1][1] / depth[0][1], 0.1, 0.1);
        assert_near(depth[1][2] / depth[0][2], 1.0, 0.02);
    }
}

static void detail_has_the_same_bits(void **state)
{
    (void)state;
    struct gas_view f;
    gas_view_open(&f);
    add_detailed(&f, 4);
    f.moment.sun.towards = FLOAT3(0.48f, 0.6f, 0.64f);
    f.light.sun_color = FLOAT4(3.0f, 3.0f, 3.0f, 0.0f);
    f.light.counts.y = 1;
    f.light.lights[0] = (struct kiln_draw_light){.position_radius2 = {1.5f, 1.0f, 1.0f, 0.01f},
                                                 .color = {1.0f, 2.0f, 3.0f, 0.1f}};
    gas_view_assert_bits(&f);
    gas_view_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(detail_changes_gas_but_not_its_amount),
        cmocka_unit_test(ways_that_begin_anew_are_not_seen),
        cmocka_unit_test(noise_moves_with_the_gas),
        cmocka_unit_test(sheared_gas_has_no_noise),
        cmocka_unit_test(the_other_group_takes_the_part_of_a_sheared_one),
        cmocka_unit_test(edges_are_as_steep_in_thin_smoke_as_in_dense_smoke),
        cmocka_unit_test(detail_has_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
