/* shaders/shared/random.h: uniform, independent, and where it should be. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/random.h"
#include "support/cmocka.h"

enum { SAMPLES = 200000 };

/* A sum of squared deviations over bins, for 63 degrees of freedom: above 130 once in a million. */
static void assert_uniform(const uint32_t bins[64], uint32_t total)
{
    double expected = total / 64.0, chi = 0;
    for (int i = 0; i < 64; i++)
        chi += (bins[i] - expected) * (bins[i] - expected) / expected;
    if (!(chi < 130.0))
        fail_msg("chi square %g over 64 bins", chi);
}

static void numbers_are_uniform_for_every_argument(void **state)
{
    (void)state;
    uint32_t serials[64] = {0}, purposes[64] = {0}, systems[64] = {0}, pairs[64] = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t stream = random_stream(random_key(7, 3), i);
        serials[(int)(random_unit(stream, RANDOM_LIFE) * 64.0f)]++;
        purposes[(int)(random_unit(random_stream(random_key(7, 3), 5), i) * 64.0f)]++;
        systems[(int)(random_unit(random_stream(random_key(i, i & 15), 5), 1) * 64.0f)]++;
        /* one particle's numbers say nothing about its next ones */
        int a = (int)(random_unit(stream, RANDOM_PLACE) * 8.0f);
        int b = (int)(random_unit(stream, RANDOM_PLACE + 1) * 8.0f);
        pairs[a * 8 + b]++;
    }
    assert_uniform(serials, SAMPLES);
    assert_uniform(purposes, SAMPLES);
    assert_uniform(systems, SAMPLES);
    assert_uniform(pairs, SAMPLES);
}

static void the_mix_changes_half_of_the_bits(void **state)
{
    (void)state;
    for (uint32_t bit = 0; bit < 32; bit++) {
        uint64_t changed = 0;
        for (uint32_t i = 0; i < 10000; i++) {
            uint32_t x = i * 2654435761u;
            changed += (uint64_t)__builtin_popcount(random_mix(x) ^ random_mix(x ^ 1u << bit));
        }
        double share = (double)changed / (10000.0 * 32.0);
        assert_true(share > 0.48 && share < 0.52);
    }
}

/* The numbers of states of 0.1: a noise with the number 16, and systems before it. Later systems
 * have other numbers than the noise. */
static void systems_and_the_noise_have_their_own_keys(void **state)
{
    (void)state;
    uint32_t keys[65] = {random_noise_key(7)};
    assert_int_equal(keys[0], random_key(7, 16));
    for (uint32_t i = 0; i < 64; i++) {
        keys[i + 1] = random_system_key(7, i);
        assert_int_equal(keys[i + 1], random_key(7, i < 16 ? i : i + 1));
        for (uint32_t k = 0; k <= i; k++)
            assert_int_not_equal(keys[k], keys[i + 1]);
    }
}

static void units_lie_in_0_to_1(void **state)
{
    (void)state;
    assert_true(random_to_unit(0) == 0.0f);
    assert_true(random_to_unit(UINT32_MAX) < 1.0f);
    assert_true(random_to_unit(0x80000000u) == 0.5f);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = random_between(i, RANDOM_SPEED, -2.0f, 5.0f);
        assert_true(x >= -2.0f && x <= 5.0f);
    }
}

static void directions_fill_their_cone_evenly(void **state)
{
    (void)state;
    static const float angles[] = {0.0f, 0.1f, 1.0f, 1.57079633f, 3.0f, 3.14159274f};
    const float3 axes[] = {
        {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6f, -0.8f, 0}, {0.48f, 0.6f, -0.64f}};
    for (size_t n = 0; n < sizeof angles / sizeof *angles; n++)
        for (size_t k = 0; k < sizeof axes / sizeof *axes; k++) {
            float cosine = exact_sincos(angles[n]).cosine;
            double mean = 0, sideways = 0;
            const uint32_t count = 20000;
            for (uint32_t i = 0; i < count; i++) {
                float3 d = random_direction(random_stream(9, i), RANDOM_DIRECTION, axes[k], cosine);
                assert_true(fabsf(float3_dot(d, d) - 1.0f) < 2e-6f);
                float along = float3_dot(d, axes[k]);
                assert_true(along > cosine - 2e-6f);
                mean += (double)along / count;
                struct random_frame frame = random_frame_about(axes[k]);
                sideways += (double)float3_dot(d, frame.u) / count;
            }
            /* uniform on a cap: the height over the axis is uniform */
            assert_true(fabs(mean - (1.0 + (double)cosine) / 2) < 0.02);
            assert_true(fabs(sideways) < 0.02);
        }
}

static void frames_are_orthonormal(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float3 up = FLOAT3(0, 1, 0);
        float3 w = random_direction(i, RANDOM_DIRECTION, up, -1.0f);
        struct random_frame f = random_frame_about(w);
        assert_true(fabsf(float3_dot(f.u, f.u) - 1.0f) < 2e-6f);
        assert_true(fabsf(float3_dot(f.v, f.v) - 1.0f) < 2e-6f);
        assert_true(fabsf(float3_dot(f.u, f.v)) < 1e-6f);
        assert_true(fabsf(float3_dot(f.u, w)) < 1e-6f);
        assert_true(fabsf(float3_dot(f.v, w)) < 1e-6f);
    }
}

static void balls_are_filled_evenly(void **state)
{
    (void)state;
    uint32_t shells[64] = {0}, heights[64] = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t stream = random_stream(1, i);
        float3 p = random_in_ball(stream, RANDOM_PLACE, false);
        double r = (double)float3_length(p);
        assert_true(r < 1.000001);
        shells[(int)fmin(r * r * r * 64.0, 63.0)]++; /* equal volumes */
        float3 s = random_in_ball(stream, RANDOM_PLACE, true);
        assert_true(fabsf(float3_length(s) - 1.0f) < 1e-6f);
        heights[(int)fmin(((double)s.z + 1.0) * 32.0, 63.0)]++; /* equal areas (Archimedes) */
    }
    assert_uniform(shells, SAMPLES);
    assert_uniform(heights, SAMPLES);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_uniform_for_every_argument),
        cmocka_unit_test(the_mix_changes_half_of_the_bits),
        cmocka_unit_test(systems_and_the_noise_have_their_own_keys),
        cmocka_unit_test(units_lie_in_0_to_1),
        cmocka_unit_test(directions_fill_their_cone_evenly),
        cmocka_unit_test(frames_are_orthonormal),
        cmocka_unit_test(balls_are_filled_evenly),
    };
    return cmocka_run_group_tests_name("random", tests, NULL, NULL);
}
