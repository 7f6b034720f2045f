/* shaders/shared/exact.h against double-precision closed forms. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/lanes.h"
#include "shared/exact.h"
#include "shared/random.h"
#include "support/cmocka.h"

enum { SAMPLES = 1000000 };

/* The distance in units in the last place of the expected number. */
static double ulps(float found, double expected)
{
    int exponent;
    frexp(expected, &exponent);
    return fabs((double)found - expected) / ldexp(1.0, exponent - 24);
}

static float random_float(uint32_t i, uint32_t low_exponent, uint32_t high_exponent)
{
    uint32_t bits = random_mix(i);
    uint32_t exponent = low_exponent + random_mix(bits) % (high_exponent - low_exponent);
    return BITS_FLOAT((bits & 0x807fffffu) | exponent << 23);
}

static float random_in(uint32_t i, float low, float high)
{
    return low + (high - low) * random_to_unit(random_mix(i));
}

static void assert_at_most(const char *what, double found, double allowed)
{
    if (!(found <= allowed))
        fail_msg("%s: off by %g, allowed %g", what, found, allowed);
}

static void reciprocals_and_roots_are_near_the_closed_form(void **state)
{
    (void)state;
    double rcp = 0, div = 0, sqrts = 0, rsqrt = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = random_float(i, 27, 227); /* 2^-100 .. 2^100 */
        float y = random_float(i + SAMPLES, 100, 150);
        rcp = fmax(rcp, ulps(exact_rcp(x), 1.0 / (double)x));
        float d = random_float(i + 2 * SAMPLES, 100, 150);
        div = fmax(div, ulps(exact_div(y, d), (double)y / (double)d));
        float s = exact_abs(x);
        sqrts = fmax(sqrts, ulps(exact_sqrt(s), sqrt((double)s)));
        rsqrt = fmax(rsqrt, ulps(exact_rsqrt(s), 1.0 / sqrt((double)s)));
    }
    /* one binade at full density, where the first guess is best and worst */
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = BITS_FLOAT(0x3f800000u + i * 16u); /* 1 .. 4 */
        rcp = fmax(rcp, ulps(exact_rcp(x), 1.0 / (double)x));
        rsqrt = fmax(rsqrt, ulps(exact_rsqrt(x), 1.0 / sqrt((double)x)));
    }
    print_message("ulp: rcp %.2f div %.2f sqrt %.2f rsqrt %.2f\n", rcp, div, sqrts, rsqrt);
    assert_at_most("rcp", rcp, 1.5);
    assert_at_most("div", div, 2.0);
    assert_at_most("sqrt", sqrts, 2.0);
    assert_at_most("rsqrt", rsqrt, 1.5);
}

static void sine_and_cosine_are_near_the_closed_form(void **state)
{
    (void)state;
    double worst = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = i < SAMPLES / 2 ? random_in(i, -8192.0f, 8192.0f) : random_in(i, -7.0f, 7.0f);
        struct exact_angle a = exact_sincos(x);
        worst = fmax(worst, fabs((double)a.sine - sin((double)x)));
        worst = fmax(worst, fabs((double)a.cosine - cos((double)x)));
    }
    print_message("sine and cosine: %.3g\n", worst);
    assert_at_most("sincos", worst, 1e-7);
    struct exact_angle zero = exact_sincos(0.0f), far = exact_sincos(8193.0f);
    assert_true(zero.sine == 0.0f && zero.cosine == 1.0f);
    assert_true(far.sine == 0.0f && far.cosine == 1.0f);
}

static void exponentials_are_near_the_closed_form(void **state)
{
    (void)state;
    double worst = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = i < SAMPLES / 2 ? random_in(i, -69.0f, 69.0f) : random_in(i, -2.0f, 2.0f);
        double expected = exp((double)x);
        worst = fmax(worst, fabs((double)exact_exp(x) - expected) / expected);
    }
    print_message("exp: %.3g of its size\n", worst);
    assert_at_most("exp", worst, 1e-7);
    assert_true(exact_exp(0.0f) == 1.0f);
    assert_true(exact_exp(-70.0f) == 0.0f);
    assert_true(exact_exp(1000.0f) == exact_exp(69.0f));
}

static void powers_and_logarithms_are_near_the_closed_form(void **state)
{
    (void)state;
    double logs = 0, powers = 0, roots = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = i % 2 ? exact_abs(random_float(i, 27, 227)) : random_in(i, 0.5f, 2.0f);
        double log = log2((double)x);
        logs = fmax(logs, fabs((double)exact_log2(x) - log) / fmax(1.0, fabs(log)));
        float y = i % 2 ? random_in(i, -100.0f, 100.0f) : random_in(i, -2.0f, 2.0f);
        double power = exp2((double)y);
        powers = fmax(powers, fabs((double)exact_exp2(y) - power) / power);
        float base = random_in(i, 0.003f, 1.0f); /* what sRGB takes roots of */
        double root = pow((double)base, 1.0 / 2.4);
        roots = fmax(roots, fabs((double)exact_pow(base, 1.0f / 2.4f) - root) / root);
    }
    print_message("log2: %.3g, exp2: %.3g, pow: %.3g\n", logs, powers, roots);
    assert_at_most("log2", logs, 2e-7);
    assert_at_most("exp2", powers, 2e-7);
    assert_at_most("pow", roots, 7e-7);
    for (int n = -100; n <= 100; n++) {
        float power = ldexpf(1.0f, n);
        assert_true(exact_log2(power) == (float)n && exact_exp2((float)n) == power);
    }
}

static void every_argument_has_an_answer(void **state)
{
    (void)state;
    const float tiny = BITS_FLOAT(0x0d7fffffu), least = BITS_FLOAT(0x0d800000u);
    const float denormal = BITS_FLOAT(1u), vast = BITS_FLOAT(0x71800001u);
    const float zeros[] = {0.0f, -0.0f, tiny, -tiny, denormal, -denormal};
    for (size_t i = 0; i < sizeof zeros / sizeof *zeros; i++) {
        assert_int_equal(FLOAT_BITS(exact_canon(zeros[i])), 0);
        assert_int_equal(FLOAT_BITS(exact_rcp(zeros[i])), 0);
        assert_int_equal(FLOAT_BITS(exact_rsqrt(zeros[i])), 0);
        assert_int_equal(FLOAT_BITS(exact_sqrt(zeros[i])), 0);
    }
    const float outside[] = {vast, -vast, INFINITY, -INFINITY, NAN};
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
        assert_true(exact_rcp(outside[i]) == 0.0f);
        assert_true(exact_rsqrt(outside[i]) == 0.0f);
        assert_true(exact_sqrt(outside[i]) == 0.0f);
    }
    assert_true(exact_canon(least) == least && exact_canon(-least) == -least);
    assert_true(exact_sqrt(-1.0f) == 0.0f && exact_rsqrt(-1.0f) == 0.0f);
    assert_true(exact_sincos(NAN).cosine == 1.0f);
    assert_true(exact_exp(NAN) == 1.0f);
    assert_true(exact_exp2(NAN) == 1.0f && exact_exp2(-INFINITY) == 0.0f);
    assert_true(exact_exp2(INFINITY) == 0x1p100f && exact_exp2(-101.0f) == 0.0f);
    const float lowest[] = {0.0f, -0.0f, tiny, denormal, -1.0f, -INFINITY, NAN, -NAN};
    for (size_t i = 0; i < sizeof lowest / sizeof *lowest; i++)
        assert_true(exact_log2(lowest[i]) == -100.0f);
    assert_true(exact_log2(INFINITY) == 100.0f && exact_pow(0.0f, 2.2f) == 0.0f);
}

static void between_stays_between(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float a = random_float(i, 100, 150), b = random_float(i + SAMPLES, 100, 150);
        float y = exact_lerp(a, b, random_to_unit(random_mix(i)));
        assert_true(y >= fminf(a, b) && y <= fmaxf(a, b));
    }
    assert_true(exact_lerp(2.0f, 6.0f, 0.25f) == 3.0f);
    assert_true(exact_clamp(5.0f, 0.0f, 1.0f) == 1.0f && exact_clamp(-5.0f, 0.0f, 1.0f) == 0.0f);
}

static void vectors_follow_their_definitions(void **state)
{
    (void)state;
    double length = 0, across = 0;
    for (uint32_t i = 0; i < 100000; i++) {
        float3 a = FLOAT3(random_in(3 * i, -5, 5), random_in(3 * i + 1, -5, 5),
                          random_in(3 * i + 2, -5, 5));
        float3 b = FLOAT3(a.y - 1.0f, a.z + 2.0f, a.x);
        float3 c = float3_cross(a, b), n = float3_normalize(a, b);
        length = fmax(length, fabs((double)float3_dot(n, n) - 1.0));
        across = fmax(across, fabs((double)float3_dot(a, c)));
        double square = (double)a.x * a.x + (double)a.y * a.y + (double)a.z * a.z;
        assert_true(ulps(float3_length(a), sqrt(square)) < 4.0);
    }
    assert_at_most("length of a normalised vector", length, 4e-7);
    assert_at_most("a . (a x b)", across, 1e-4);
    float3 fallback = FLOAT3(0.0f, 1.0f, 0.0f);
    float3 none = float3_normalize(FLOAT3(0.0f, -0.0f, BITS_FLOAT(1u)), fallback);
    assert_true(none.x == 0.0f && none.y == 1.0f && none.z == 0.0f);
}

/* Every float has an integer, the same for single numbers and for vectors. */
static void integers_of_all_floats(void **state)
{
    (void)state;
    const float below = nextafterf(0x1p31f, 0.0f);
    assert_int_equal(exact_int(below), 2147483520);
    assert_int_equal(exact_int(-below), -2147483520);
    assert_int_equal(exact_int(-1.999f), -1);
    assert_int_equal(exact_int(-0.0f), 0);
    const float beyond[] = {0x1p31f, -0x1p31f, 1e30f, -1e30f, INFINITY, -INFINITY, NAN, -NAN};
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++)
        assert_int_equal(exact_int(beyond[i]), INT32_MIN);

    assert_int_equal(exact_uint(nextafterf(0x1p32f, 0.0f)), 4294967040u);
    assert_int_equal(exact_uint(2.999f), 2);
    assert_int_equal(exact_uint(-0.999f), 0);
    const float none[] = {0x1p32f, -1.0f, 1e30f, -1e30f, INFINITY, -INFINITY, NAN, -NAN};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        assert_int_equal(exact_uint(none[i]), 0);

    for (uint32_t i = 0; i < SAMPLES; i++) {
        const float x = BITS_FLOAT(random_mix(i));
        const vi vector = vi_of(vf_all(x));
        if (vector[0] != exact_int(x))
            fail_msg("%g: %d and %d", (double)x, vector[0], exact_int(x));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers_of_all_floats),
        cmocka_unit_test(reciprocals_and_roots_are_near_the_closed_form),
        cmocka_unit_test(sine_and_cosine_are_near_the_closed_form),
        cmocka_unit_test(exponentials_are_near_the_closed_form),
        cmocka_unit_test(powers_and_logarithms_are_near_the_closed_form),
        cmocka_unit_test(every_argument_has_an_answer),
        cmocka_unit_test(between_stays_between),
        cmocka_unit_test(vectors_follow_their_definitions),
    };
    return cmocka_run_group_tests_name("exact", tests, NULL, NULL);
}
