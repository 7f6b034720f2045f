/* Sprites before, within and behind gas: a picture would show sprites through gas that hides them,
 * or gas through sprites before it. Whole pictures are compared with a reference that marches
 * through the gas from each sprite of a pixel to the next one. */
#include <stdint.h>
#include <stdlib.h>

#include "support/cmocka.h"
#include "support/gas_depth.h"

static int open_with(void **state, float extinction, bool by_fragment, bool half)
{
    struct gas_depth *f = malloc(sizeof *f);
    assert_non_null(f);
    gas_depth_open(f, &(struct gas_depth_setting){.technique = KILN_RASTER_CPU,
                                                  .extinction = extinction,
                                                  .by_fragment = by_fragment,
                                                  .half = half});
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
    gas_depth_close(*state);
    free(*state);
    return 0;
}

static void sprites_are_blended_with_gas(void **state)
{
    gas_depth_check(*state);
}

/* The reference would be no test if gas behind all sprites were as near to it. */
static void gas_behind_all_sprites_is_far_from_the_reference(void **state)
{
    static struct gas_depth_drawn found, expected;
    gas_depth_draw_reference(*state, &expected);
    gas_depth_draw(*state, true, &found);
    assert_true(gas_depth_difference(found.color, expected.color, true, 1e-3) > 0.5);
}

static void bits_are_the_same_at_all_levels(void **state)
{
    struct gas_depth *f = *state;
    static struct gas_depth_drawn first, other;
    for (int by_fragment = 0; by_fragment < 2; by_fragment++) {
        bool some = false;
        f->by_fragment = by_fragment;
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            assert_int_equal(setenv("KILN_SIMD", kiln_simd_name(simd), 1), 0);
            gas_depth_draw(f, false, some ? &other : &first);
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
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_thin_oit, close_all),
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_thick_oit, close_all),
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_half, close_all),
        cmocka_unit_test_setup_teardown(sprites_are_blended_with_gas, open_thick_half, close_all),
        cmocka_unit_test_setup_teardown(gas_behind_all_sprites_is_far_from_the_reference, open_thin,
                                        close_all),
        cmocka_unit_test_setup_teardown(bits_are_the_same_at_all_levels, open_thin_oit, close_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
