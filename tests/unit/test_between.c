/* Particles at a time within a step (shaders/shared/between.h), against closed forms in double. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/between.h"
#include "support/cmocka.h"

static const double DT_S = 1.0 / 60, G = 9.81;

/* A life of 1 s for all particles. */
static struct kiln_derived_params derived(void)
{
    return (struct kiln_derived_params){
        .dt_s = (float)DT_S, .life = {.min = {.constant = 1.0f}, .max = {.constant = 1.0f}}};
}

/* A particle that is born 64ths / 64 of a step after the start of step `born`. */
static struct kiln_particle particle(double x, double y, double vx, double vy, uint32_t born,
                                     uint32_t sixty_fourths)
{
    return (struct kiln_particle){{FLOAT_BITS((float)x), FLOAT_BITS((float)y), 0, 7},
                                  {FLOAT_BITS((float)vx), FLOAT_BITS((float)vy), 0,
                                   born << KILN_BIRTH_STEP_SHIFT |
                                       sixty_fourths << KILN_BIRTH_FRACTION_SHIFT |
                                       KILN_PARTICLE_ALIVE}};
}

static struct kiln_particle at(struct kiln_particle before, struct kiln_particle after,
                               uint32_t step, double back)
{
    return particle_between(NULL, derived(), before, after, step, (float)back);
}

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%.9g instead of %.9g", found, expected);
}

/* The chord of a parabola leaves it by a dt^2 / 8 in the middle of a step, and by no more. */
static void a_fall_is_followed(void **state)
{
    (void)state;
    double most = 0;
    for (int i = 0; i <= 16; i++) {
        const double back = i / 16.0, t = (1 - back) * DT_S;
        const double end = -0.5 * G * DT_S * DT_S;
        struct kiln_particle p = at(particle(1, 2, 3, 0, 1, 0),
                                    particle(1 + 3 * DT_S, 2 + end, 3, -G * DT_S, 1, 0), 2, back);
        assert_true(particle_is_alive(p));
        assert_int_equal(p.position_serial.w, 7);
        assert_near((double)particle_position(p).x, 1 + 3 * t, 1e-6);
        assert_near((double)particle_velocity(p).y, -G * t, 1e-6);
        most = fmax(most, fabs((double)particle_position(p).y - (2 - 0.5 * G * t * t)));
    }
    assert_near(most, G * DT_S * DT_S / 8, 1e-6); /* 0.34 mm */
}

/* A ball that bounces off the floor at y = 0 is never below it. */
static void a_bounce_stays_above_the_floor(void **state)
{
    (void)state;
    for (int i = 0; i <= 16; i++) {
        struct kiln_particle p =
            at(particle(0, 0.02, 0, -6, 1, 0), particle(0, 0.08, 0, 6, 1, 0), 2, i / 16.0);
        assert_near((double)particle_position(p).y, 0.08 - 0.06 * i / 16, 1e-7);
    }
}

static void births_and_deaths_have_their_times(void **state)
{
    (void)state;
    const struct kiln_particle none = {.position_serial = {0}, .velocity_birth = {0}};
    /* Born a quarter of step 5 after its start at x = 1, with 4 m/s. */
    const struct kiln_particle born = particle(1 + 0.75 * DT_S * 4, 0, 4, 0, 5, 16);
    assert_false(particle_is_alive(at(none, born, 5, 0.76)));
    struct kiln_particle p = at(none, born, 5, 0.75);
    assert_true(particle_is_alive(p));
    assert_near((double)particle_position(p).x, 1, 1e-6);
    p = at(none, born, 5, 0.25);
    assert_near((double)particle_position(p).x, 1 + 0.5 * DT_S * 4, 1e-6);

    /* Born at the start of step 1, it dies a second later, at the end of step 60. One born half a
     * step later dies in the middle of step 61. */
    const struct kiln_particle old = particle(0, 1, 0, -2, 1, 32);
    p = at(old, none, 61, 0.75);
    assert_true(particle_is_alive(p));
    assert_near((double)particle_position(p).y, 1 - 2 * 0.25 * DT_S, 1e-6);
    assert_false(particle_is_alive(at(old, none, 61, 0.45)));
    assert_false(particle_is_alive(at(none, none, 61, 0.45)));

    /* A particle that dies early, of a collision, is drawn to the end of that step. */
    assert_true(particle_is_alive(at(old, none, 30, 1.0 / 64)));
}

/* A slot whose particle died and gave way to another shows the new one alone. */
static void a_slot_changes_hands(void **state)
{
    (void)state;
    struct kiln_particle after = particle(8, 0, 0, 0, 5, 32);
    after.position_serial.w = 9;
    assert_false(particle_is_alive(at(particle(0, 0, 1, 0, 1, 0), after, 5, 0.9)));
    const struct kiln_particle p = at(particle(0, 0, 1, 0, 1, 0), after, 5, 0.1);
    assert_int_equal(p.position_serial.w, 9);
    assert_near((double)particle_position(p).x, 8, 1e-6);
}

/* A ball turns evenly from the pose before the step to the pose after it. */
static void spins_are_followed(void **state)
{
    (void)state;
    const float3 rate = {0.0f, 0.0f, 40.0f};
    const struct kiln_spin before = {spin_words_of(rate),
                                     spin_pose_words((float4){0.0f, 0.0f, 0.0f, 1.0f})};
    const struct kiln_particle alive = particle(0, 0, 0, 0, 1, 0), dead = {.velocity_birth = {0}};
    struct kiln_spin after = before;
    after.pose = spin_pose_words(spin_integrate(spin_pose(before.pose), rate, (float)DT_S));
    for (int i = 0; i <= 4; i++) {
        const double back = i / 4.0, angle = 40 * DT_S * (1 - back);
        const struct kiln_spin found[] = {
            spin_between(alive, before, after, (float)DT_S, (float)back),
            spin_between(dead, before, (struct kiln_spin){.rate = {0}}, (float)DT_S, (float)back)};
        for (int k = 0; k < 2; k++) {
            const float4 pose = spin_pose(found[k].pose);
            assert_near((double)pose.z, sin(0.5 * angle), 1e-6);
            assert_near((double)pose.w, cos(0.5 * angle), 1e-6);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fall_is_followed),
        cmocka_unit_test(a_bounce_stays_above_the_floor),
        cmocka_unit_test(births_and_deaths_have_their_times),
        cmocka_unit_test(a_slot_changes_hands),
        cmocka_unit_test(spins_are_followed),
    };
    return cmocka_run_group_tests_name("between", tests, NULL, NULL);
}
