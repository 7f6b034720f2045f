/* Gravity among the particles of a system: sums in double, orbits, what is kept. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "sim/crowd/interact.h"
#include "support/balls.h"
#include "support/cmocka.h"

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
    struct kiln_gravity gravity = {.sources = sources,
                                   .count = BODIES,
                                   .places = sources,
                                   .softening_square = 0.01f,
                                   .accelerations = found};
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

/* Of unit masses, softened as the pull is. A step kicks, then drifts: velocities are half a step
 * (half_step_s) behind, or taken as they are with 0. */
static double energy_at(struct simulation *run, uint32_t count, double strength, double softening,
                        double half_step_s)
{
    const struct kiln_particle *records = simulation_records(run);
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const float3 v = particle_velocity(records[i]), p = particle_position(records[i]);
        double at[3] = {(double)v.x, (double)v.y, (double)v.z};
        for (uint32_t k = 0; k < count; k++) {
            const float3 q = particle_position(records[k]);
            const double x = (double)q.x - (double)p.x, y = (double)q.y - (double)p.y;
            const double z = (double)q.z - (double)p.z;
            const double square = x * x + y * y + z * z + softening * softening;
            const double pull = k == i ? 0.0 : strength / (square * sqrt(square));
            sum -= 0.5 * pull * square;
            at[0] += half_step_s * pull * x;
            at[1] += half_step_s * pull * y;
            at[2] += half_step_s * pull * z;
        }
        sum += 0.5 * (at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
    }
    return sum;
}

static double energy(struct simulation *run, uint32_t count, double strength, double softening)
{
    return energy_at(run, count, strength, softening, 0.0);
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

/* Those who only follow do not pull, neither each other nor what they follow: 40 on circles of
 * their own about one that rests, speed^2 = strength / radius. */
static void followers_circle_what_they_follow(void **state)
{
    (void)state;
    enum { FOLLOWERS = 40 };
    struct simulation run;
    balls_init(&fixture, 1, 0.01f);
    fixture.scene.systems[0].interaction_count = 0;
    struct kiln_system *followers = fixture_add_system(&fixture, "followers", 0.0f);
    followers->emit.life = fixture_range(1000.0f, 1000.0f);
    followers->capacity = FOLLOWERS;
    struct kiln_interaction *gravity = fixture_add_gravity(followers, 4.0f);
    gravity->softening = fixture_constant(0.001f);
    gravity->of_other = true;
    gravity->source = 0;
    simulation_start(&run, &fixture.scene, NULL, 1);
    balls_place(&run, 0, FLOAT3(1.0f, 0.0f, 0.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    for (uint32_t i = 0; i < FOLLOWERS; i++) {
        const float radius = 1.0f + 0.1f * (float)i;
        balls_place(&run, 1 + i, FLOAT3(1.0f + radius, 0.0f, 0.0f),
                    FLOAT3(0.0f, 2.0f / sqrtf(radius), 0.0f));
    }
    run.pool.systems[0].next_serial = 1;
    run.pool.systems[1].next_serial = FOLLOWERS;
    simulation_run(&run, 600);
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < FOLLOWERS; i++) {
        const float3 p = particle_position(records[1 + i]);
        const double radius = 1.0 + 0.1 * i, x = (double)p.x - 1.0, y = (double)p.y;
        assert_true(fabs(sqrt(x * x + y * y) - radius) < 0.02 * radius);
        const double phase = 10.0 * 2.0 / (radius * sqrt(radius));
        assert_true(fabs(sin(0.5 * (atan2(y, x) - phase))) < 0.04);
    }
    assert_true(particle_position(records[0]).x == 1.0f);
    simulation_end(&run);
}

struct ellipse {
    double early, late; /* the most that the energy is off in the first and the last fifth */
    double turning;     /* and, in all, the angular momentum; both as parts */
};

/* Two that come as near as a third of how far they go, 30 times about each other. */
static struct ellipse fly_ellipse(uint32_t steps_per_second)
{
    enum { SECONDS = 72 };
    struct ellipse e = {0};
    struct simulation run;
    init_stars(2, 1.0f, 0.001f);
    fixture.scene.rate = (struct kiln_rational){steps_per_second, 1};
    fixture.scene.dt_s = 1.0f / (float)steps_per_second;
    simulation_start(&run, &fixture.scene, NULL, 1);
    balls_place(&run, 0, FLOAT3(-0.5f, 0.0f, 0.0f), FLOAT3(0.0f, 0.0f, 0.5f));
    balls_place(&run, 1, FLOAT3(0.5f, 0.0f, 0.0f), FLOAT3(0.0f, 0.0f, -0.5f));
    const double half_step_s = 0.5 / steps_per_second;
    const double before = energy_at(&run, 2, 1.0, 0.001, half_step_s);
    const uint32_t looks = SECONDS * 20;
    for (uint32_t look = 0; look < looks; look++) {
        simulation_run(&run, steps_per_second / 20);
        const struct kiln_particle *records = simulation_records(&run);
        const double off = fabs(energy_at(&run, 2, 1.0, 0.001, half_step_s) / before - 1.0);
        double turning = 0.0;
        for (int i = 0; i < 2; i++) {
            const float3 p = particle_position(records[i]), v = particle_velocity(records[i]);
            turning += (double)p.z * (double)v.x - (double)p.x * (double)v.z;
        }
        if (look < looks / 5)
            e.early = fmax(e.early, off);
        if (look >= looks - looks / 5)
            e.late = fmax(e.late, off);
        e.turning = fmax(e.turning, fabs(turning / 0.5 - 1.0));
    }
    simulation_end(&run);
    return e;
}

/* The leapfrog's energy swings by the square of the step and does not drift; kicks along the line
 * between them turn nothing. */
static void energy_swings_and_does_not_drift(void **state)
{
    (void)state;
    const struct ellipse coarse = fly_ellipse(60), fine = fly_ellipse(120);
    print_message("an ellipse: energy off by %.2g, at last %.2g; with half the step %.2g, %.2g; "
                  "angular momentum by %.2g\n",
                  coarse.early, coarse.late, fine.early, fine.late, coarse.turning);
    assert_true(coarse.early < 0.01 && coarse.late < 1.2 * coarse.early);
    assert_true(fine.late < 1.2 * fine.early);
    assert_true(fine.early < 0.3 * coarse.early && fine.early > 0.2 * coarse.early);
    assert_true(coarse.turning < 2e-5 && fine.turning < 2e-5);
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
        const double half_step_s = 0.5 / 60.0;
        const double before = energy_at(&run, BODIES, 0.01, 0.1, half_step_s);
        simulation_run(&run, 180);
        const struct balls_sums after = balls_sum(&run, BODIES, NULL);
        const double scale = sqrt(2.0 * sums.energy * sums.mass);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(after.momentum[k] - sums.momentum[k]) < 1e-5 * scale);
        const double drift = energy_at(&run, BODIES, 0.01, 0.1, half_step_s) / before - 1.0;
        print_message("%d stars, %s: energy drifts by %+.3f %% in 3 s\n", BODIES,
                      collide ? "colliding" : "alone", 100.0 * drift);
        assert_true(fabs(drift) < (collide ? 0.02 : 0.001));
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
        cmocka_unit_test(followers_circle_what_they_follow),
        cmocka_unit_test(energy_swings_and_does_not_drift),
        cmocka_unit_test(a_cluster_keeps_momentum_and_energy),
    };
    return cmocka_run_group_tests_name("gravity", tests, NULL, NULL);
}
