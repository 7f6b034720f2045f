/* lib/asset: blackbody colours and procedural flipbooks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/blackbody.h"
#include "asset/builtin.h"

enum { EDGE = 32, CELL_FLOATS = EDGE * EDGE * 4 };

static float luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

/* Planck's locus passes close to D65 near 6500 K, and a candle (1850 K) is about (1, 0.3, 0). */
static void hot_things_have_the_right_hue(void **state)
{
    (void)state;
    float rgb[3];
    kiln_blackbody_color(6500.0f, rgb);
    assert_true(fabsf(rgb[1] / rgb[0] - 0.95f) < 0.06f);
    assert_true(fabsf(rgb[2] / rgb[0] - 0.97f) < 0.10f);

    kiln_blackbody_color(1850.0f, rgb);
    assert_true(rgb[1] / rgb[0] > 0.22f && rgb[1] / rgb[0] < 0.36f);
    assert_true(rgb[2] / rgb[0] < 0.01f);

    float before = 0.0f;
    for (float kelvin = 800.0f; kelvin < 10000.0f; kelvin += 100.0f) {
        kiln_blackbody_color(kelvin, rgb);
        float green = rgb[1] / rgb[0];
        assert_true(green >= before);
        before = green;
    }
}

static void hot_things_shine_with_the_fourth_power(void **state)
{
    (void)state;
    float low[3], high[3], none[3];
    kiln_blackbody_color(1900.0f, low);
    assert_true(fabsf(luminance(low) - 1.0f) < 0.02f);
    kiln_blackbody_color(3800.0f, high);
    assert_true(fabsf(luminance(high) / luminance(low) - 16.0f) < 0.4f);
    kiln_blackbody_color(399.0f, none);
    assert_true(none[0] == 0.0f && none[1] == 0.0f && none[2] == 0.0f);
    kiln_blackbody_color(NAN, none);
    assert_true(none[0] == 0.0f);
}

static float *generate(const char *name, uint32_t threads)
{
    struct kiln_threads *pool = kiln_threads_create(threads);
    float *cells = calloc(KILN_BUILTIN_CELLS, CELL_FLOATS * sizeof(float));
    assert_non_null(pool);
    assert_non_null(cells);
    kiln_builtin_generate(name, EDGE, cells, pool);
    kiln_threads_destroy(&pool);
    return cells;
}

static float mean_density(const float *cell)
{
    float sum = 0.0f;
    for (int i = 0; i < EDGE * EDGE; i++)
        sum += cell[4 * i + 3];
    return sum / (EDGE * EDGE);
}

/* Each value is in its range, and nothing touches the cell's border: a quad's edge must not show.
 */
static void cells_are_sound(void **state)
{
    (void)state;
    for (size_t n = 0; kiln_builtin_name(n); n++) {
        float *cells = generate(kiln_builtin_name(n), 2);
        for (size_t i = 0; i < (size_t)KILN_BUILTIN_CELLS * EDGE * EDGE; i++) {
            const float *p = cells + 4 * i;
            assert_true(p[0] * p[0] + p[1] * p[1] < 1.0f);
            assert_true(p[2] >= 0.0f && p[2] <= 1.0f && p[3] >= 0.0f && p[3] <= 1.0f);
            size_t x = i % EDGE, y = i / EDGE % EDGE;
            if (x == 0 || y == 0 || x == EDGE - 1 || y == EDGE - 1)
                assert_true(p[3] < 0.01f);
        }
        free(cells);
    }
}

static void fire_erodes_and_smoke_stays(void **state)
{
    (void)state;
    float *fire = generate("fire", 2), *smoke = generate("smoke", 2);
    float young = mean_density(fire), old = mean_density(fire + 60 * CELL_FLOATS);
    assert_true(young > 0.25f);
    assert_true(old < 0.15f * young);
    for (int cell = 1; cell < KILN_BUILTIN_CELLS; cell++) {
        float here = mean_density(smoke + cell * CELL_FLOATS);
        float before = mean_density(smoke + (cell - 1) * CELL_FLOATS);
        assert_true(here > 0.2f);
        assert_true(fabsf(here - before) < 0.02f); /* no jump between cells */
    }
    free(fire);
    free(smoke);
}

static void cells_do_not_depend_on_threads(void **state)
{
    (void)state;
    float *one = generate("smoke", 1), *eight = generate("smoke", 8);
    assert_memory_equal(one, eight, KILN_BUILTIN_CELLS * CELL_FLOATS * sizeof(float));
    free(one);
    free(eight);
}

static void names_are_known(void **state)
{
    (void)state;
    assert_true(kiln_builtin_exists("fire"));
    assert_true(kiln_builtin_exists("spark"));
    assert_false(kiln_builtin_exists("water"));
    assert_false(kiln_builtin_exists(""));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(hot_things_have_the_right_hue),
        cmocka_unit_test(hot_things_shine_with_the_fourth_power),
        cmocka_unit_test(cells_are_sound),
        cmocka_unit_test(fire_erodes_and_smoke_stays),
        cmocka_unit_test(cells_do_not_depend_on_threads),
        cmocka_unit_test(names_are_known),
    };
    return cmocka_run_group_tests_name("atlas", tests, NULL, NULL);
}
