/* lib/draw/volume/volume_between.h: where only every second pixel has a ray, gas would be blurred
 * over the edges of objects and flames, would be blocks of pixels, or would depend on threads. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_fixture.h"
#include "support/gas_view.h"

enum { SIZE = GAS_VIEW_SIZE, FLOATS = GAS_VIEW_FLOATS, CELLS = 16 };

/* Opens a ball of smoke with flames in its middle, in the light of the sky, whose cells are three
 * pixels wide. */
static void open_ball(struct gas_view *f, float extinction)
{
    gas_view_open(f);
    const struct kiln_gas_look look = {.extinction = gas_view_value(extinction),
                                       .albedo = gas_view_value3(0.4f, 0.5f, 0.6f),
                                       .intensity = gas_view_value(6.0f),
                                       .absorption = gas_view_value(1.0f),
                                       .lights = true};
    struct kiln_gas *gas = gas_view_add(f, look);
    gas_fixture_ball(gas, CELLS, 2.0f / CELLS, 0.42f, 1.0f, 1.0f);
    f->light.sky_top = f->light.sky_horizon = FLOAT4(0.5f, 0.8f, 1.2f, 0.0f);
}

/* Draws the picture by all rays, and then by half of them in each direction. Returns the latter. */
static const float *draw_both(struct gas_view *f, float full[FLOATS])
{
    f->scene->gas[0].look.resolution = KILN_GAS_FULL;
    memcpy(full, gas_view_draw(f), FLOATS * sizeof *full);
    f->scene->gas[0].look.resolution = KILN_GAS_HALF;
    return gas_view_draw(f);
}

static bool is_same(const float *a, const float *b, int x, int y)
{
    const size_t at = 4 * ((size_t)y * SIZE + (size_t)x);
    return memcmp(a + at, b + at, 4 * sizeof *a) == 0;
}

static void pixels_between_rays_take_their_light(void **state)
{
    (void)state;
    static float full[FLOATS];
    for (int thick = 0; thick < 2; thick++) {
        struct gas_view f;
        open_ball(&f, thick ? 12.0f : 0.8f);
        const float *half = draw_both(&f, full);
        int other = 0, seen = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            if (i % SIZE % 2 == 0 && i / SIZE % 2 == 0)
                assert_true(is_same(half, full, i % SIZE, i / SIZE));
            seen += full[4 * i + 3] > 0.0f;
            other += !is_same(half, full, i % SIZE, i / SIZE);
            for (int c = 0; c < 4; c++) {
                const double light = (double)full[4 * i + c];
                if (fabs((double)half[4 * i + c] - light) > light / 32.0 + 1.0 / 128.0)
                    fail_msg("pixel %d, %d has %g instead of %g", i % SIZE, i / SIZE,
                             (double)half[4 * i + c], light);
            }
        }
        print_message("%d of %d pixels with gas have no ray\n", other, seen);
        assert_true(other > seen / 5);
        gas_view_close(&f);
    }
}

/* An object covers the pixels from an odd column on, in the middle of the gas. Pixels between rays
 * on both sides of the edge, or next to such, have rays of their own. */
static void edges_of_the_scene_are_kept(void **state)
{
    (void)state;
    static float full[FLOATS];
    struct gas_view f;
    struct kiln_error error = {0};
    open_ball(&f, 3.0f);
    float *depth = kiln_image_host(&f.depth, KILN_READ_WRITE, &error);
    for (int i = 0; i < SIZE * SIZE; i++)
        depth[i] = i % SIZE >= 33 ? 9.8f : 1e9f;
    const float *half = draw_both(&f, full);
    int other = 0;
    for (int y = 0; y < SIZE; y++) {
        for (int x = 31; x <= 35; x += 2)
            if (!is_same(half, full, x, y))
                fail_msg("pixel %d, %d beside the edge has no ray of its own", x, y);
        for (int x = 0; x < SIZE; x++)
            other += !is_same(half, full, x, y);
    }
    assert_true(other > 100);
    gas_view_close(&f);
}

/* A floor that runs through the gas has no edge, though each pixel of it has another depth. */
static void a_plane_needs_no_more_rays(void **state)
{
    (void)state;
    static float full[FLOATS];
    struct gas_view f;
    struct kiln_error error = {0};
    open_ball(&f, 0.5f);
    float *depth = kiln_image_host(&f.depth, KILN_READ_WRITE, &error);
    for (int i = 0; i < SIZE * SIZE; i++)
        depth[i] = 1.0f / (0.1f + 2e-4f * (float)(i / SIZE - 32) + 1e-4f * (float)(i % SIZE - 32));
    const float *half = draw_both(&f, full);
    int other = 0, seen = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        seen += full[4 * i + 3] > 0.0f;
        other += !is_same(half, full, i % SIZE, i / SIZE);
        assert_true(fabs((double)half[4 * i + 3] - (double)full[4 * i + 3]) < 1.0 / 64.0);
    }
    print_message("%d of %d pixels with gas have no ray\n", other, seen);
    assert_true(other > seen / 5);
    gas_view_close(&f);
}

/* The layer of the depth of half opacity has no pixels with the mean of gas and of nothing. */
static void depths_of_half_opacity_have_edges(void **state)
{
    (void)state;
    static float full[SIZE * SIZE];
    struct gas_view f;
    struct kiln_error error = {0};
    open_ball(&f, 3.0f);
    f.layers = true;
    f.scene->gas[0].look.resolution = KILN_GAS_FULL;
    gas_view_draw(&f);
    memcpy(full, kiln_image_host(&f.halfway, KILN_READ, &error), sizeof full);
    f.scene->gas[0].look.resolution = KILN_GAS_HALF;
    gas_view_draw(&f);
    const float *half = kiln_image_host(&f.halfway, KILN_READ, &error);
    int opaque = 0, other = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        if ((half[i] < 1e9f) != (full[i] < 1e9f))
            fail_msg("pixel %d, %d has %g instead of %g", i % SIZE, i / SIZE, (double)half[i],
                     (double)full[i]);
        opaque += full[i] < 1e9f;
        other += half[i] != full[i];
        assert_true(full[i] == 1e9f || fabs((double)half[i] - (double)full[i]) < 0.5 * 2.0 / CELLS);
    }
    assert_true(other > opaque / 10);
    gas_view_close(&f);
}

static void bits_do_not_depend_on_levels_or_threads(void **state)
{
    (void)state;
    struct gas_view f;
    open_ball(&f, 3.0f);
    f.scene->gas[0].look.resolution = KILN_GAS_HALF;
    gas_view_assert_bits(&f);
    gas_view_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_between_rays_take_their_light),
        cmocka_unit_test(edges_of_the_scene_are_kept),
        cmocka_unit_test(a_plane_needs_no_more_rays),
        cmocka_unit_test(depths_of_half_opacity_have_edges),
        cmocka_unit_test(bits_do_not_depend_on_levels_or_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
