/* Collisions that are foreseen (`interact: collide: fastest`): balls on a spring, the warnings
 * about speeds beyond what is foreseen, and the default.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "option/values.h"
#include "shared/exact.h"
#include "shared/interact_speeds.h"
#include "support/balls.h"
#include "support/cmocka.h"

static struct scene_fixture fixture; /* too large for a stack */

/* m: how far two balls of half a metre go into each other in 4 s between springs at the origin,
 * from 3 m to each side. */
static double overlap_on_a_spring(float fastest)
{
    struct simulation run;
    balls_init(&fixture, 2, 0.5f)->fastest = fixture_constant(fastest);
    struct kiln_force *spring = fixture_add_force(&fixture.scene.systems[0], KILN_FORCE_ATTRACT);
    spring->strength = fixture_constant(9.0f);
    spring->falloff = KILN_FALLOFF_LINEAR;
    simulation_start(&run, &fixture.scene, NULL, 1);
    balls_place(&run, 0, FLOAT3(-3, 0, 0), FLOAT3(0, 0, 0));
    balls_place(&run, 1, FLOAT3(3, 0, 0), FLOAT3(0, 0, 0));
    double deepest = 0;
    for (int step = 0; step < 240; step++) {
        simulation_run(&run, 1);
        const struct kiln_particle *balls = simulation_records(&run);
        const double apart = (double)float3_length(
            float3_sub(particle_position(balls[0]), particle_position(balls[1])));
        deepest = fmax(deepest, 1 - apart);
    }
    simulation_end(&run);
    return deepest;
}

static void balls_on_a_spring_stay_apart(void **state)
{
    (void)state;
    const double unseen = overlap_on_a_spring(0.0f);
    const double seen = overlap_on_a_spring(KILN_VALUE_BY_WORD);
    print_message("they overlap by %.3g m, foreseen by %.3g m\n", unseen, seen);
    assert_true(unseen > 0.06);
    assert_true(seen < 0.01);
}

/* The warning of a step in which two balls, 5 cm in radius, fly past each other at a speed. */
static const char *warning_at(struct simulation *run, float fastest, float speed)
{
    balls_init(&fixture, 2, 0.05f)->fastest = fixture_constant(fastest);
    simulation_start(run, &fixture.scene, NULL, 1);
    balls_place(run, 0, FLOAT3(0, 0, 0), FLOAT3(0.5f * speed, 0, 0));
    balls_place(run, 1, FLOAT3(1, 3, 0), FLOAT3(-0.5f * speed, 0, 0));
    simulation_run(run, 1);
    return kiln_simulate_warning(run->simulate);
}

static void what_is_too_fast_to_be_foreseen_is_said_once(void **state)
{
    (void)state;
    static const struct {
        float fastest, speed;
        const char *says; /* NULL: nothing */
    } cases[] = {
        {2, 9,
         "systems.balls.interact: collide.fastest: step 2: velocities differ by up to 9.1 m/s, but "
         "fastest is 2 m/s, so particles may pass through each other; set fastest: auto or 9.1 "
         "m/s"},
        {0, 9,
         "systems.balls.interact: collide.fastest: step 2: velocities differ by up to 9.1 m/s, but "
         "fastest is 0 m/s, so particles may pass through each other; set fastest: auto or 9.1 "
         "m/s"},
        {2, 50,
         "systems.balls.interact: collide.fastest: step 2: velocities differ by up to 50.1 m/s, "
         "but fastest is 2 m/s, so particles may pass through each other; set fastest: 50.1 m/s"},
        {100.1f, 100, NULL},
        {9.1f, 9, NULL},
        {0, 0.5f, NULL}, /* 8 mm in a step */
        {KILN_VALUE_BY_WORD, 11, NULL},
        {KILN_VALUE_BY_WORD, 100,
         "systems.balls.interact: collide.fastest: step 2: velocities differ by up to 100.1 m/s, "
         "but auto looks ahead for only 12.0 m/s, so particles may pass through each other; use a "
         "higher simulation.rate, or fastest: 100.1 m/s, which takes longer"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct simulation run;
        const char *warning = warning_at(&run, cases[i].fastest, cases[i].speed);
        if (cases[i].says)
            assert_string_equal(warning, cases[i].says);
        else
            assert_null(warning);
        simulation_run(&run, 1);
        assert_null(kiln_simulate_warning(run.simulate));
        simulation_end(&run);
    }
}

/* Keys of velocities are in the order of the numbers, and give them back. */
static void keys_are_in_order(void **state)
{
    (void)state;
    static const float numbers[] = {-1e6f, -2, -1e-30f, -0.0f, 0, 1e-30f, 3, 1e6f};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        assert_true(speeds_value(speeds_key(numbers[i])) == numbers[i]);
        assert_true(speeds_key(numbers[i]) > (i ? speeds_key(numbers[i - 1]) : 0u));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_on_a_spring_stay_apart),
        cmocka_unit_test(what_is_too_fast_to_be_foreseen_is_said_once),
        cmocka_unit_test(keys_are_in_order),
    };
    return cmocka_run_group_tests_name("foreseen", tests, NULL, NULL);
}
