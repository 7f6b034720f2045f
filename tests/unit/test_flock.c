/* Flocks: what each steers by, against sums over all pairs in double; averages; limits. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/simd.h"
#include "shared/interact_flock.h"
#include "support/balls.h"
#include "support/cmocka.h"

static struct scene_fixture fixture; /* too large for a stack */

enum { BIRDS = 400 };

struct vector {
    double x, y, z;
};

static struct kiln_flock *init_birds(uint32_t count)
{
    balls_init(&fixture, count, 0.01f);
    fixture.scene.systems[0].interaction_count = 0;
    return fixture_add_flock(&fixture.scene.systems[0], 0.5f);
}

static void place_cloud(struct simulation *run, uint32_t count, float size_m, float3 wind)
{
    uint32_t seed = 5;
    for (uint32_t i = 0; i < count; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        const float u = balls_random(&seed), v = balls_random(&seed), w = balls_random(&seed);
        balls_place(run, i, FLOAT3(size_m * x, size_m * y, size_m * z),
                    FLOAT3(wind.x + u, wind.y + v, wind.z + w));
    }
}

/* ---- all pairs, in double ------------------------------------------------------------------- */

static struct vector of(float3 v)
{
    return (struct vector){(double)v.x, (double)v.y, (double)v.z};
}

static struct vector add(struct vector a, struct vector b, double factor)
{
    return (struct vector){a.x + b.x * factor, a.y + b.y * factor, a.z + b.z * factor};
}

static double dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double at(const struct kiln_value *value)
{
    return (double)value->constant;
}

/* Away from a place, by how close it is. */
static struct vector away(struct vector from, double space)
{
    const double distance = sqrt(dot(from, from));
    const double closeness = fmax(0.0, 1.0 - distance / space);
    return add((struct vector){0.0, 0.0, 0.0}, from, -closeness / distance);
}

static bool sees(struct vector velocity, struct vector apart, double view)
{
    const double sizes = sqrt(dot(velocity, velocity) * dot(apart, apart));
    return view >= 6.28318 || dot(velocity, apart) >= cos(0.5 * view) * sizes;
}

/* The velocity of a bird after a step of dt. */
static struct vector steered(const struct kiln_particle *birds, uint32_t count, uint32_t self,
                             const struct kiln_flock *flock, double dt)
{
    const struct vector p = of(particle_position(birds[self]));
    const struct vector v = of(particle_velocity(birds[self]));
    struct vector middle = {0, 0, 0}, mean = {0, 0, 0}, near = {0, 0, 0}, same = {0, 0, 0};
    struct vector wish = {0, 0, 0};
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct vector apart = add(of(particle_position(birds[i])), p, -1.0);
        const struct vector parting = add(of(particle_velocity(birds[i])), v, -1.0);
        middle = add(middle, apart, 1.0 / count);
        mean = add(mean, parting, 1.0 / count);
        if (i == self || sqrt(dot(apart, apart)) >= at(&flock->radius) ||
            !sees(v, apart, at(&flock->view)))
            continue;
        seen++;
        near = add(near, apart, 1.0);
        same = add(same, parting, 1.0);
        wish = add(wish, away(apart, at(&flock->space)), at(&flock->separation));
        const double meet_s = -dot(apart, parting) / dot(parting, parting);
        if (meet_s > 0.0 && meet_s < at(&flock->horizon))
            wish = add(wish, away(add(apart, parting, meet_s), at(&flock->space)),
                       at(&flock->avoidance) * (1.0 - meet_s / at(&flock->horizon)));
    }
    wish = add(wish, near, seen ? at(&flock->cohesion) / seen : 0.0);
    wish = add(wish, same, seen ? at(&flock->alignment) / seen : 0.0);
    wish = add(add(wish, middle, at(&flock->all_cohesion)), mean, at(&flock->all_alignment));
    const double strength = sqrt(dot(wish, wish));
    const struct vector after =
        add(v, wish, dt * fmin(1.0, at(&flock->acceleration) / fmax(strength, 1e-9)));
    const double speed = sqrt(dot(after, after));
    const double held = fmin(fmax(speed, at(&flock->slowest)), at(&flock->fastest));
    return add((struct vector){0, 0, 0}, after, held / speed);
}

static void check_step(const struct kiln_flock *flock, float size_m)
{
    static struct kiln_particle before[BIRDS];
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 2);
    place_cloud(&run, BIRDS, size_m, FLOAT3(0.3f, 0.0f, 0.1f));
    memcpy(before, simulation_records(&run), sizeof before);
    simulation_run(&run, 1);
    const struct kiln_particle *after = simulation_records(&run);
    double largest = 0.0;
    for (uint32_t i = 0; i < BIRDS; i++) {
        const struct vector expected = steered(before, BIRDS, i, flock, (double)fixture.scene.dt_s);
        const struct vector error = add(of(particle_velocity(after[i])), expected, -1.0);
        const struct vector change = add(expected, of(particle_velocity(before[i])), -1.0);
        largest = fmax(largest, sqrt(dot(change, change)));
        if (!(sqrt(dot(error, error)) < 2e-5))
            fail_msg("bird %u is off by %g m/s", i, sqrt(dot(error, error)));
    }
    assert_true(largest > 1e-3);
    simulation_end(&run);
}

static void rule_off(struct kiln_value *value)
{
    *value = fixture_constant(0.0f);
}

/* All rules together, and each alone. */
static void birds_steer_as_in_double(void **state)
{
    (void)state;
    struct kiln_flock *flock = init_birds(BIRDS);
    check_step(flock, 1.0f);
    flock->acceleration = fixture_constant(2.0f);
    check_step(flock, 1.0f);
    for (int rule = 0; rule < 6; rule++) {
        flock = init_birds(BIRDS);
        flock->slowest = fixture_constant(0.0f);
        struct kiln_value *const rules[] = {&flock->separation,   &flock->avoidance,
                                            &flock->cohesion,     &flock->alignment,
                                            &flock->all_cohesion, &flock->all_alignment};
        for (int i = 0; i < 6; i++) {
            if (i != rule)
                rule_off(rules[i]);
        }
        check_step(flock, rule % 2 == 0 ? 1.0f : 0.4f);
    }
}

/* From none to all around, on both sides of a right angle. */
static void birds_see_what_their_angle_of_view_holds(void **state)
{
    (void)state;
    static const float views[] = {0.0f, 1.0f, 3.1f, 3.2f, 4.5f, 6.2831855f};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        struct kiln_flock *flock = init_birds(BIRDS);
        flock->view = fixture_constant(views[i]);
        check_step(flock, 1.0f);
    }
}

/* The table has 1024 cells, in which rows of cells meet: nobody counts twice, nobody is missed. */
static void far_from_the_origin_and_in_cells_that_share_places(void **state)
{
    (void)state;
    struct kiln_flock *flock = init_birds(BIRDS);
    flock->radius = fixture_constant(0.08f);
    flock->space = fixture_constant(0.05f);
    check_step(flock, 0.5f);
    for (uint32_t count = 2; count <= 40; count += 19) { /* tables of 64 and 128 */
        struct simulation run;
        flock = init_birds(count);
        rule_off(&flock->avoidance);
        rule_off(&flock->cohesion);
        rule_off(&flock->all_cohesion);
        rule_off(&flock->all_alignment);
        simulation_start(&run, &fixture.scene, NULL, 1);
        for (uint32_t i = 0; i < count; i++)
            balls_place(&run, i, FLOAT3(0.3f * (float)(i % 3), 0.3f * (float)(i / 9), 0.0f),
                        FLOAT3(1.0f, 0.01f * (float)i, 0.0f));
        struct kiln_particle before[40];
        memcpy(before, simulation_records(&run), count * sizeof *before);
        /* those of one place are pushed up and down, which steered() does not know */
        for (uint32_t i = 0; i < count; i++)
            balls_place(
                &run, i,
                FLOAT3(0.3f * (float)(i % 3), 0.3f * (float)(i / 9) + 0.001f * (float)i, 0.0f),
                particle_velocity(before[i]));
        memcpy(before, simulation_records(&run), count * sizeof *before);
        simulation_run(&run, 1);
        for (uint32_t i = 0; i < count; i++) {
            const struct vector expected =
                steered(before, count, i, flock, (double)fixture.scene.dt_s);
            const struct vector error =
                add(of(particle_velocity(simulation_records(&run)[i])), expected, -1.0);
            assert_true(sqrt(dot(error, error)) < 2e-5);
        }
        simulation_end(&run);
    }
}

/* Every bird of clouds that are sparse and dense, by each width. */
static void all_widths_see_the_same(void **state)
{
    (void)state;
    static struct kiln_particle expected[BIRDS];
    for (int dense = 0; dense < 2; dense++) {
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            struct simulation run;
            init_birds(BIRDS);
            assert_int_equal(setenv("KILN_SIMD", kiln_simd_name(simd), 1), 0);
            simulation_start(&run, &fixture.scene, NULL, 2);
            unsetenv("KILN_SIMD");
            place_cloud(&run, BIRDS, dense ? 0.3f : 1.0f, FLOAT3(0.3f, 0.0f, 0.1f));
            simulation_run(&run, 4);
            if (simd == kiln_simd_narrowest())
                memcpy(expected, simulation_records(&run), sizeof expected);
            assert_memory_equal(simulation_records(&run), expected, sizeof expected);
            simulation_end(&run);
        }
    }
}

/* ---- averages ------------------------------------------------------------------------------- */

static double wide_number(struct flock_wide w)
{
    return (double)(int64_t)((uint64_t)w.high << 32 | w.low);
}

static void averages_are_those_in_double(void **state)
{
    (void)state;
    static const float sizes[] = {1e-6f, 1.0f, 1000.0f, 1048576.0f};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        uint32_t seed = 3;
        double expected = 0.0, largest = 0.0;
        struct flock_wide sum = flock_wide_zero();
        enum { COUNT = 100001 };
        for (uint32_t i = 0; i < COUNT; i++) {
            const float x = sizes[k] * (balls_random(&seed) + (i % 2 ? 0.3f : -0.35f)) * 0.7f;
            const struct flock_wide wide = flock_wide_of(x);
            largest = fmax(largest, fabs(wide_number(wide) * 0x1p-22 - (double)x));
            sum = flock_wide_add(sum, wide);
            expected += (double)x / COUNT;
        }
        assert_true(largest <= 0x1p-22);
        assert_true(fabs((double)flock_wide_mean(sum, COUNT) - expected) <=
                    0x1p-22 + fabs(expected) * 0x1p-20);
    }
}

/* As many as a flock may have, as far out and as fast as any may be. */
static void sums_hold_the_largest_flock(void **state)
{
    (void)state;
    for (int side = 0; side < 2; side++) {
        const float far = side ? -1048576.0f : 1048576.0f;
        struct flock_wide sum = flock_wide_of(far);
        uint32_t count = 1;
        for (; count < KILN_MAX_FLOCK; count *= 2)
            sum = flock_wide_add(sum, sum);
        assert_int_equal(count, KILN_MAX_FLOCK);
        assert_true(flock_wide_mean(sum, count) == far);
    }
    assert_true(flock_wide_mean(flock_wide_of(NAN), 1) == -1048576.0f);
    assert_true(flock_wide_mean(flock_wide_of(-1e-12f), 1) < 0.0f);
    assert_true(flock_wide_mean(flock_wide_zero(), 7) == 0.0f);
}

/* ---- what a flock does ---------------------------------------------------------------------- */

static double disorder(struct simulation *run, uint32_t count)
{
    struct vector sum = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        const struct vector v = of(particle_velocity(simulation_records(run)[i]));
        sum = add(sum, v, 1.0 / sqrt(dot(v, v)) / count);
    }
    return 1.0 - sqrt(dot(sum, sum));
}

static double closest(struct simulation *run, uint32_t count)
{
    const struct kiln_particle *birds = simulation_records(run);
    double least = 1e9;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            const struct vector apart =
                add(of(particle_position(birds[i])), of(particle_position(birds[k])), -1.0);
            least = fmin(least, sqrt(dot(apart, apart)));
        }
    }
    return least;
}

static void they_come_to_fly_the_same_way_and_keep_apart(void **state)
{
    (void)state;
    struct simulation run;
    struct kiln_flock *flock = init_birds(BIRDS);
    flock->all_cohesion = fixture_constant(1.0f);
    simulation_start(&run, &fixture.scene, NULL, 2);
    place_cloud(&run, BIRDS, 1.0f, FLOAT3(0.2f, 0.0f, 0.0f));
    const double order_before = disorder(&run, BIRDS), near_before = closest(&run, BIRDS);
    simulation_run(&run, 300);
    assert_true(disorder(&run, BIRDS) < 0.1 * order_before);
    assert_true(closest(&run, BIRDS) > 2.0 * near_before);
    for (uint32_t i = 0; i < BIRDS; i++) {
        const struct vector v = of(particle_velocity(simulation_records(&run)[i]));
        const double speed = sqrt(dot(v, v));
        assert_true(speed > 0.4999 && speed < 6.0001);
    }
    simulation_end(&run);
}

/* What no bird should meet: all in one place, at rest, out of range, not a number. */
static void absurd_flocks_stay_defined(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    for (int what = 0; what < 3; what++) {
        struct simulation runs[2];
        init_birds(BIRDS);
        for (int k = 0; k < 2; k++) {
            simulation_start(&runs[k], &fixture.scene, NULL, k ? 3 : 1);
            for (uint32_t i = 0; i < BIRDS; i++)
                balls_place(&runs[k], i, FLOAT3(what == 1 ? 1e6f : 0.0f, 0.0f, 0.0f),
                            FLOAT3(what == 1 ? -1e6f : 0.0f, 0.0f, 0.0f));
            struct kiln_particle *records =
                kiln_buffer_host(&runs[k].pool.records, KILN_READ_WRITE, &error);
            if (what == 2) {
                records[3].position_serial.x = FLOAT_BITS(NAN);
                records[4].velocity_birth.y = FLOAT_BITS(INFINITY);
            }
            simulation_run(&runs[k], 5);
        }
        assert_memory_equal(simulation_records(&runs[0]), simulation_records(&runs[1]),
                            BIRDS * sizeof(struct kiln_particle));
        for (uint32_t i = 0; i < BIRDS; i++) {
            const struct kiln_particle p = simulation_records(&runs[0])[i];
            assert_true(!particle_is_alive(p) || isfinite(particle_position(p).x));
        }
        simulation_end(&runs[0]);
        simulation_end(&runs[1]);
    }
}

/* More around one than are looked at: nobody is, so that none of them steers. */
static void too_many_in_one_place_are_left_alone(void **state)
{
    (void)state;
    enum { TOO_MANY = FLOCK_MOST + 1 };
    struct simulation run;
    struct kiln_flock *flock = init_birds(TOO_MANY);
    rule_off(&flock->slowest);
    rule_off(&flock->all_cohesion);
    rule_off(&flock->all_alignment);
    simulation_start(&run, &fixture.scene, NULL, 2);
    for (uint32_t i = 0; i < TOO_MANY; i++)
        balls_place(&run, i, FLOAT3(0.1f, 0.1f, 0.1f), FLOAT3(0.0f, 0.0f, 0.0f));
    simulation_run(&run, 1);
    for (uint32_t i = 0; i < TOO_MANY; i++)
        assert_true(float3_length(particle_velocity(simulation_records(&run)[i])) == 0.0f);
    simulation_end(&run);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(birds_steer_as_in_double),
        cmocka_unit_test(birds_see_what_their_angle_of_view_holds),
        cmocka_unit_test(far_from_the_origin_and_in_cells_that_share_places),
        cmocka_unit_test(all_widths_see_the_same),
        cmocka_unit_test(averages_are_those_in_double),
        cmocka_unit_test(sums_hold_the_largest_flock),
        cmocka_unit_test(they_come_to_fly_the_same_way_and_keep_apart),
        cmocka_unit_test(absurd_flocks_stay_defined),
        cmocka_unit_test(too_many_in_one_place_are_left_alone),
    };
    return cmocka_run_group_tests_name("flock", tests, NULL, NULL);
}
