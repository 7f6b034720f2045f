/* Gravity among the particles of a system: sums in double, orbits, what is kept. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>

#include "sim/interact.h"
#include "support/balls.h"

static struct scene_fixture fixture; /* too large for a stack */

enum { BODIES = 300 /* no multiple of a block */, ROOM = 320 };

static struct kiln_interaction *init_stars(uint32_t count, float strength, float softening)
{
    balls_init(&fixture, count, 0.01f);
    struct kiln_interaction *gravity = &fixture.scene.systems[0].interactions[0];
    *gravity = (struct kiln_interaction){.kind = KILN_INTERACT_GRAVITY,
                                         .strength = fixture_constant(strength),
                                         .softening = fixture_constant(softening)};
    return gravity;
}

/* ---- sums ----------------------------------------------------------------------------------- */

static void fill_sources(float4 *sources)
{
    uint32_t seed = 17;
    for (uint32_t i = 0; i < ROOM; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        const float strength = i >= BODIES || i % 7 == 0 ? 0.0f : 0.6f + 0.5f * balls_random(&seed);
        sources[i] = i < BODIES ? FLOAT4(100.0f * x, y, 0.01f * z, strength)
                                : FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    }
}

static void sums_are_those_of_newton(void **state)
{
    (void)state;
    static float4 sources[ROOM];
    fill_sources(sources);
    const float square = 0.0004f;
    for (uint32_t i = 0; i < BODIES; i++) {
        const float3 at = FLOAT3(sources[i].x, sources[i].y, sources[i].z);
        float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
        double expected[3] = {0.0, 0.0, 0.0}, size = 0.0;
        for (uint32_t k = 0; k < BODIES; k++) {
            sum = gravity_add(sum, at, sources[k], square);
            const double x = (double)sources[k].x - (double)at.x;
            const double y = (double)sources[k].y - (double)at.y;
            const double z = (double)sources[k].z - (double)at.z;
            const double r2 = x * x + y * y + z * z + (double)square;
            const double pull = (double)sources[k].w / (r2 * sqrt(r2));
            expected[0] += x * pull;
            expected[1] += y * pull;
            expected[2] += z * pull;
            size += sqrt(x * x + y * y + z * z) * pull;
        }
        assert_true(fabs((double)sum.x - expected[0]) < 5e-6 * size);
        assert_true(fabs((double)sum.y - expected[1]) < 5e-6 * size);
        assert_true(fabs((double)sum.z - expected[2]) < 5e-6 * size);
    }
}

static void all_widths_give_the_same_bits(void **state)
{
    (void)state;
    static float4 sources[ROOM];
    static float3 expected[ROOM], found[ROOM];
    fill_sources(sources);
    struct kiln_gravity gravity = {
        .sources = sources, .count = BODIES, .softening_square = 0.01f, .accelerations = found};
    for (uint32_t i = 0; i < BODIES; i++) {
        const float3 at = FLOAT3(sources[i].x, sources[i].y, sources[i].z);
        expected[i] = FLOAT3(0.0f, 0.0f, 0.0f);
        for (uint32_t k = 0; k < BODIES; k++)
            expected[i] = gravity_add(expected[i], at, sources[k], gravity.softening_square);
    }
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        memset(found, 0, sizeof found);
        KILN_SIMD_PICK(kiln_gravity_loops, simd)->pull(&gravity, 0, 64, 0);
        KILN_SIMD_PICK(kiln_gravity_loops, simd)->pull(&gravity, 64, BODIES, 0);
        assert_memory_equal(found, expected, BODIES * sizeof *found);
    }
}

static void roots_are_as_exact_as_promised(void **state)
{
    (void)state;
    for (float x = 0x1p-30f; x < 0x1p60f; x *= 1.00037f) {
        const double expected = 1.0 / sqrt((double)x);
        assert_true(fabs((double)gravity_rsqrt(x) - expected) < 8e-7 * expected);
    }
}

/* ---- orbits --------------------------------------------------------------------------------- */

/* Of unit masses, softened as the pull is. */
static double energy(struct simulation *run, uint32_t count, double strength, double softening)
{
    const struct kiln_particle *records = simulation_records(run);
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const float3 v = particle_velocity(records[i]), p = particle_position(records[i]);
        sum += 0.5 *
               ((double)v.x * (double)v.x + (double)v.y * (double)v.y + (double)v.z * (double)v.z);
        for (uint32_t k = 0; k < i; k++) {
            const float3 q = particle_position(records[k]);
            const double x = (double)q.x - (double)p.x, y = (double)q.y - (double)p.y;
            const double z = (double)q.z - (double)p.z;
            sum -= strength / sqrt(x * x + y * y + z * z + softening * softening);
        }
    }
    return sum;
}

/* A circle about the middle of two: speed^2 / 0.5 m = strength / (1 m)^2. */
static void two_stars_stay_on_their_circle(void **state)
{
    (void)state;
    struct simulation run;
    init_stars(2, 1.0f, 0.001f);
    const float speed = (float)sqrt(0.5);
    simulation_start(&run, &fixture.scene, NULL, 1);
    balls_place(&run, 0, FLOAT3(-0.5f, 0.0f, 0.0f), FLOAT3(0.0f, 0.0f, speed));
    balls_place(&run, 1, FLOAT3(0.5f, 0.0f, 0.0f), FLOAT3(0.0f, 0.0f, -speed));
    const double before = energy(&run, 2, 1.0, 0.001);
    for (int turn = 0; turn < 10; turn++) {
        simulation_run(&run, 267); /* 60 steps a second, and a turn is 4.443 s */
        const float3 p = particle_position(simulation_records(&run)[0]);
        assert_true(fabsf(float3_length(p) - 0.5f) < 0.01f);
        assert_true(fabs(energy(&run, 2, 1.0, 0.001) - before) < 0.02 * fabs(before));
    }
    simulation_end(&run);
}

static void a_cluster_keeps_momentum_and_energy(void **state)
{
    (void)state;
    struct simulation run;
    for (int collide = 0; collide < 2; collide++) {
        init_stars(BODIES, 0.01f, 0.1f);
        if (collide)
            fixture_add_collisions(&fixture.scene.systems[0], 0.02f)->restitution =
                fixture_constant(1.0f);
        simulation_start(&run, &fixture.scene, NULL, 2);
        uint32_t seed = 23;
        for (uint32_t i = 0; i < BODIES; i++) {
            const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
            balls_place(&run, i, FLOAT3(x, y, z), FLOAT3(z, 0.2f * x, -x));
        }
        const struct balls_sums sums = balls_sum(&run, BODIES, NULL);
        const double before = energy(&run, BODIES, 0.01, 0.1);
        simulation_run(&run, 180);
        const struct balls_sums after = balls_sum(&run, BODIES, NULL);
        const double scale = sqrt(2.0 * sums.energy * sums.mass);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(after.momentum[k] - sums.momentum[k]) < 1e-5 * scale);
        const double drift = energy(&run, BODIES, 0.01, 0.1) / before - 1.0;
        print_message("%d stars, %s: energy drifts by %+.3f %% in 3 s\n", BODIES,
                      collide ? "colliding" : "alone", 100.0 * drift);
        assert_true(fabs(drift) < 0.02);
        simulation_end(&run);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_are_those_of_newton),
        cmocka_unit_test(all_widths_give_the_same_bits),
        cmocka_unit_test(roots_are_as_exact_as_promised),
        cmocka_unit_test(two_stars_stay_on_their_circle),
        cmocka_unit_test(a_cluster_keeps_momentum_and_energy),
    };
    return cmocka_run_group_tests_name("gravity", tests, NULL, NULL);
}
