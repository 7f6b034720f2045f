/* lib/output/half.h: floats as halves. If this fails, exported gas has other values on some
 * machine, or values that are off by more than half a step. */
#include <math.h>
#include <stdint.h>

#include "output/half.h"
#include "support/cmocka.h"

/* Rows that a reader can check by hand: a half has 11 bits, and its least step is 2^-24. */
static void halves_are_rounded_to_the_nearest_even(void **state)
{
    (void)state;
    static const struct {
        float x;
        uint16_t half;
    } rows[] = {
        {0.0f, 0},
        {-0.0f, 0x8000},
        {1.0f, 0x3c00},
        {-2.0f, 0xc000},
        {0.1f, 0x2e66},
        {1.0f / 3.0f, 0x3555},
        {0x1.002p0f, 0x3c00},      /* in the middle of 1 and the next half: even */
        {0x1.002002p0f, 0x3c01},   /* a bit above it */
        {0x1.006p0f, 0x3c02},      /* the middle of two others, of which the upper is even */
        {0x1.005ffep0f, 0x3c01},   /* a bit below it */
        {0x1.ffep-15f, 0x0400},    /* between the denormal and the normal ones */
        {0x1p-14f, 0x0400},        /* the least normal one */
        {0x1p-24f, 0x0001},        /* the least one */
        {0x1p-25f, 0x0000},        /* its half: even */
        {0x1.000002p-25f, 0x0001}, /* a bit above it */
        {0x1.8p-24f, 0x0002},      /* in the middle of 1 and 2 steps: even */
        {-0x1.4p-23f, 0x8002},     /* in the middle of 2 and 3 */
        {1e-40f, 0},               /* a denormal float */
        {65504.0f, 0x7bff},        /* the largest */
        {65519.0f, 0x7bff},
        {65536.0f, 0x7bff}, /* kept finite */
        {-INFINITY, 0xfbff},
        {NAN, 0x7e00},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_int_equal(kiln_half(rows[i].x), rows[i].half);
}

static float float_of_half(uint32_t half)
{
    const uint32_t exponent = half >> 10, part = half & 1023;
    return exponent ? ldexpf((float)(1024 + part), (int)exponent - 25) : ldexpf((float)part, -24);
}

/* All of them, and what lies between two neighbours. */
static void every_half_is_its_own(void **state)
{
    (void)state;
    for (uint32_t half = 0; half < 0x7bff; half++) {
        const float below = float_of_half(half), above = float_of_half(half + 1);
        const float middle = below + 0.5f * (above - below);
        assert_int_equal(kiln_half(below), half);
        assert_int_equal(kiln_half(-below), half | 0x8000);
        assert_int_equal(kiln_half(middle), half % 2 ? half + 1 : half);
        assert_int_equal(kiln_half(nextafterf(middle, INFINITY)), half + 1);
        assert_int_equal(kiln_half(nextafterf(middle, 0)), half);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(halves_are_rounded_to_the_nearest_even),
        cmocka_unit_test(every_half_is_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
