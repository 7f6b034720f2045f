/* Particles born of particles: where, when and how fast against closed forms; slots that are never
 * taken from the living. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/family.h"
#include "shared/random.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/family_fixture.h"
#include "support/simulation.h"

static struct scene_fixture fixture, roomy; /* too large for a stack */

static const double DT = 1.0 / 60.0;

static void assert_near(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("%.9g instead of %.9g, allowed %g off", found, expected, allowed);
}

static void run_fixture(struct simulation *run, uint32_t steps)
{
    fixture_finish(&fixture, steps);
    simulation_start(run, &fixture.scene, NULL, 1);
    simulation_run(run, steps);
}

static struct kiln_particle record_of(struct simulation *run, uint32_t system, uint32_t slot)
{
    assert_true(slot < run->pool.systems[system].capacity);
    return simulation_records(run)[run->pool.systems[system].base + slot];
}

/* Clip time of a birth, from the birth word. */
static double birth_s(struct kiln_particle p)
{
    return (particle_birth_step(p) - 1.0 + (double)particle_birth_fraction(p)) * DT;
}

/* The fixture with one particle, born at born_s with velocity (3, 4, 0), that lives for life_s. */
static struct kiln_system *one_parent(double born_s, float life_s)
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "parent", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = born_s, .count = {1, 1}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(life_s, life_s);
    system->emit.speed = fixture_range(5.0f, 5.0f);
    system->emit.direction = fixture_constant3(0.6f, 0.8f, 0.0f);
    return system;
}

/* A child that flies on as the parent did, without forces of its own. */
static struct kiln_system *resting_child(enum kiln_event event, uint32_t count)
{
    struct kiln_system *child = fixture_add_child(&fixture, "child", 0, event, count);
    child->emit.speed = fixture_range(0.0f, 0.0f);
    child->emit.life = fixture_range(10.0f, 10.0f);
    child->emit.inherit = fixture_constant(1.0f);
    return child;
}

/* Height after a time in the air, by velocity-first steps whose ends lie at multiples of DT. */
static double height_of_arc(double born_s, double end_s)
{
    double y = 0, t = born_s;
    while (t < end_s - 1e-9) {
        double next = fmin((floor(t / DT + 1e-6) + 1) * DT, end_s);
        y += (next - t) * (4.0 - 9.81 * (next - born_s));
        t = next;
    }
    return y;
}

/* Burst at the end of an arc: the place and the velocity of that moment, whatever part of a step it
 * is. Lives end at a 64th of a step, as births begin. */
static void bursts_are_where_the_arc_ends(void **state)
{
    (void)state;
    static const double births[] = {0.0, 0.1, 0.2083, 0.0133};
    static const float lives[] = {0.7123f, 0.5f, 0.009f, 0.25f, 0.001f};
    for (int i = 0; i < 20; i++) {
        double born_s = floor(births[i / 5] / DT * 64 + 0.5) / 64 * DT;
        float life_s = lives[i % 5];
        struct kiln_system *parent = one_parent(births[i / 5], life_s);
        fixture_add_force(parent, KILN_FORCE_GRAVITY)->vector =
            fixture_constant3(0.0f, -9.81f, 0.0f);
        resting_child(KILN_EVENT_DEATH, 5);
        struct simulation run;
        run_fixture(&run, 60);
        for (uint32_t j = 0; j < 5; j++) {
            struct kiln_particle p = record_of(&run, 1, j);
            assert_true(particle_is_alive(p));
            assert_int_equal(p.position_serial.w, j);
            double died_s = birth_s(p), on_s = 1.0 - died_s;
            assert_near(died_s, born_s + (double)life_s - DT / 128, DT / 128 + 1e-6);
            double vy = 4.0 - 9.81 * (died_s - born_s);
            assert_near((double)particle_velocity(p).x, 3.0, 1e-5);
            assert_near((double)particle_velocity(p).y, vy, 1e-4);
            assert_near((double)particle_position(p).x, 3.0 * (1.0 - born_s), 1e-4);
            assert_near((double)particle_position(p).y, height_of_arc(born_s, died_s) + vy * on_s,
                        1e-4);
        }
        assert_false(particle_is_alive(record_of(&run, 0, 0)));
        simulation_end(&run);
    }
}

/* A drop that falls on the floor, or against a wall from the side: the splash starts at the surface
 * at the time of the impact and flies along the normal. */
static void splashes_leave_the_surface(void **state)
{
    (void)state;
    for (int wall = 0; wall < 2; wall++) {
        struct kiln_system *drop = one_parent(0.0, 10.0f);
        drop->emit.direction =
            wall ? fixture_constant3(1.0f, 0.0f, 0.0f) : fixture_constant3(0.0f, -1.0f, 0.0f);
        drop->collide.enabled = drop->collide.dies = true;
        fixture_add_box(&fixture, 3.0f, 0.0f, 0.0f, 2.0f, 2.0f, 2.0f);  /* from x = 2 */
        fixture_add_box(&fixture, 0.0f, -2.5f, 0.0f, 2.0f, 1.0f, 2.0f); /* to y = -2 */
        struct kiln_system *splash = resting_child(KILN_EVENT_BOUNCE, 3);
        splash->emit.parent.align = KILN_ALIGN_NORMAL;
        splash->emit.speed = fixture_range(2.0f, 2.0f);
        splash->emit.inherit = fixture_constant(0.0f);
        struct simulation run;
        run_fixture(&run, 60);
        assert_false(particle_is_alive(record_of(&run, 0, 0))); /* it died of it */
        for (uint32_t j = 0; j < 3; j++) {
            struct kiln_particle p = record_of(&run, 1, j);
            assert_true(particle_is_alive(p));
            assert_near(birth_s(p), 2.0 / 5.0 - DT / 128, DT / 128 + 1e-6);
            double away = 2.0 * (1.0 - birth_s(p));
            assert_near((double)particle_position(p).x, wall ? 2.0 - away : 0.0, 2e-4);
            assert_near((double)particle_position(p).y, wall ? 0.0 : -2.0 + away, 2e-4);
            assert_near((double)particle_velocity(p).x, wall ? -2.0 : 0.0, 1e-5);
            assert_near((double)particle_velocity(p).y, wall ? 0.0 : 2.0, 1e-5);
        }
        simulation_end(&run);
    }
}

/* Between two plates a ball bounces for ever, but splashes once, with the velocity after the
 * impact. */
static void only_the_first_bounce_counts(void **state)
{
    (void)state;
    struct kiln_system *ball = one_parent(0.0, 10.0f);
    ball->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
    ball->collide.enabled = true;
    ball->collide.slowdown = fixture_constant(0.8f);
    fixture_add_box(&fixture, 0.0f, -2.5f, 0.0f, 2.0f, 1.0f, 2.0f);
    fixture_add_box(&fixture, 0.0f, 0.75f, 0.0f, 2.0f, 1.0f, 2.0f);
    resting_child(KILN_EVENT_BOUNCE, 1)->emit.life = fixture_range(0.2f, 0.2f);
    fixture_finish(&fixture, 200);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    uint32_t births = 0;
    for (uint32_t step = 1; step <= 200; step++) {
        simulation_run(&run, 1);
        struct kiln_particle p = record_of(&run, 1, 0);
        if (!particle_is_alive(p) || particle_birth_step(p) != step)
            continue;
        births++;
        assert_near((double)particle_velocity(p).y, 4.0, 1e-4); /* 5 * 0.8, upwards */
    }
    assert_int_equal(births, 1);
    assert_true(particle_is_alive(record_of(&run, 0, 0)));
    simulation_end(&run);
}

/* At an even speed, what is left behind at an even rate lies evenly: j / rate after the birth, to a
 * 64th of a step, or to two in the step in which the life ends. */
static void trails_are_even(void **state)
{
    (void)state;
    static const float rates[] = {7.0f, 60.0f, 480.0f, 1234.5f};
    for (int i = 0; i < 4; i++) {
        one_parent(0.105, 0.7f);
        double rate = (double)rates[i], born_s = floor(0.105 / DT * 64 + 0.5) / 64 * DT;
        struct kiln_system *trail = resting_child(KILN_EVENT_TRAIL, 0);
        trail->emit.parent.rate = fixture_constant(rates[i]);
        trail->emit.inherit = fixture_constant(0.0f);
        struct simulation run;
        run_fixture(&run, 60);
        uint32_t expected = (uint32_t)ceil(0.7 * rate - 1e-4);
        assert_true(run.pool.systems[1].capacity <= expected + 1);
        for (uint32_t j = 0; j < run.pool.systems[1].capacity; j++) {
            struct kiln_particle p = record_of(&run, 1, j);
            assert_int_equal(particle_is_alive(p), j < expected);
            if (!particle_is_alive(p))
                continue;
            assert_near(birth_s(p), born_s + j / rate - DT / 64, DT / 64 + 2e-6);
            assert_near((double)particle_position(p).x, 3.0 * (birth_s(p) - born_s), 1e-4);
            assert_near((double)particle_position(p).y, 4.0 * (birth_s(p) - born_s), 1e-4);
        }
        simulation_end(&run);
    }
}

/* A rate that falls from r to 0 over a life L: r (t - t^2 / 2L) have been born after t. */
static void trails_follow_their_curve(void **state)
{
    (void)state;
    const double r = 300.0, L = 0.8;
    one_parent(0.0, 0.8f);
    struct kiln_system *trail = resting_child(KILN_EVENT_TRAIL, 0);
    trail->emit.parent.rate = fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0.0f, 300.0f, 1.0f, 0.0f);
    struct simulation run;
    run_fixture(&run, 60);
    uint32_t alive = 0;
    for (uint32_t j = 0; j < run.pool.systems[1].capacity; j++) {
        struct kiln_particle p = record_of(&run, 1, j);
        alive += particle_is_alive(p);
        if (!particle_is_alive(p) || j > 115)
            continue;
        double t = L * (1.0 - sqrt(1.0 - 2.0 * j / (r * L)));
        assert_near(birth_s(p), t, DT / 20); /* within a step the rate counts as even */
    }
    assert_in_range(alive, 119, 121); /* r L / 2 */
    simulation_end(&run);
}

/* Over the bounce of a step the trail goes to the surface and away from it, never through. */
static void trails_turn_at_surfaces(void **state)
{
    (void)state;
    struct kiln_system *ball = one_parent(0.0, 0.8f);
    ball->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
    ball->emit.speed = fixture_range(90.0f, 90.0f);
    ball->collide.enabled = true;
    fixture_add_box(&fixture, 0.0f, -3.0f, 0.0f, 2.0f, 2.0f, 2.0f); /* to y = -2 */
    struct kiln_system *trail = resting_child(KILN_EVENT_TRAIL, 0);
    trail->emit.parent.rate = fixture_constant(1000.0f);
    trail->emit.inherit = fixture_constant(0.0f);
    struct simulation run;
    run_fixture(&run, 12);
    for (uint32_t j = 0; j < 100; j++) {
        struct kiln_particle p = record_of(&run, 1, j);
        assert_true(particle_is_alive(p));
        double t = birth_s(p), down = -90.0 * t, up = 90.0 * (t - 2.0 / 90.0) - 2.0;
        assert_near((double)particle_position(p).y, t < 2.0 / 90.0 ? down : up, 1e-3);
    }
    simulation_end(&run);
}

/* ---- slots ---------------------------------------------------------------------------------- */

static void assert_same_hash(struct simulation *a, struct simulation *b, uint32_t step)
{
    uint64_t alive_a, alive_b;
    struct kiln_state_hash hash_a = simulation_hash(a, &alive_a);
    struct kiln_state_hash hash_b = simulation_hash(b, &alive_b);
    if (alive_a != alive_b || memcmp(&hash_a, &hash_b, sizeof hash_a) != 0)
        fail_msg("step %u: %u alive instead of %u", step, (unsigned)alive_a, (unsigned)alive_b);
}

/* As many slots as there are births in the run: nothing is ever reused. */
static void give_every_serial_a_slot(struct kiln_scene *scene, uint32_t births)
{
    uint32_t order[KILN_MAX_SYSTEMS];
    kiln_family_order(scene, order);
    for (uint32_t k = 0; k < scene->system_count; k++) {
        struct kiln_system *system = &scene->systems[order[k]];
        const struct kiln_parent *parent = &system->emit.parent;
        system->capacity =
            parent->enabled ? scene->systems[parent->system].capacity * parent->slots : births;
    }
}

/* The state does not depend on the layout, so a run that reuses slots must have the states of one
 * that never does: nothing born too early over the living, no event lost. */
static void slots_are_free_when_their_turn_comes(void **state)
{
    (void)state;
    enum { STEPS = 240 };
    for (uint32_t seed = 0; seed < 8; seed += 2) {
        fixture_family(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT);
        fixture.scene.seed = seed;
        float shortest = 0.002f + 0.03f * (float)seed;
        for (uint32_t i = 0; i < fixture.scene.system_count; i++) {
            float longest = 0.05f + 0.4f * random_unit(random_stream(seed, i), 99);
            fixture.scene.systems[i].emit.life =
                fixture_range(shortest < longest ? shortest : longest, longest);
        }
        fixture_finish(&fixture, STEPS);
        roomy = fixture;
        roomy.scene.keys = roomy.keys;
        give_every_serial_a_slot(&roomy.scene, 900);
        assert_true(roomy.scene.systems[FAMILY_RAIN].capacity >
                    2 * fixture.scene.systems[FAMILY_RAIN].capacity);
        struct simulation tight, wide;
        simulation_start(&tight, &fixture.scene, NULL, 2);
        simulation_start(&wide, &roomy.scene, NULL, 2);
        for (uint32_t step = 1; step <= STEPS; step++) {
            simulation_run(&tight, 1);
            simulation_run(&wide, 1);
            assert_same_hash(&tight, &wide, step);
        }
        simulation_end(&tight);
        simulation_end(&wide);
    }
}

/* The test above can fail: with slots for the parents' own lives alone, children are lost. */
static void slots_for_a_parents_own_life_are_too_few(void **state)
{
    (void)state;
    fixture_family(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT);
    fixture_finish(&fixture, 200);
    roomy = fixture;
    roomy.scene.keys = roomy.keys;
    uint32_t alone = 0;
    for (uint32_t i = 0; i < fixture.scene.system_count; i++)
        fixture.scene.systems[i].enabled = i == FAMILY_ROCKET;
    fixture_finish(&fixture, 200);
    alone = fixture.scene.systems[FAMILY_ROCKET].capacity;
    fixture = roomy;
    fixture.scene.keys = fixture.keys;
    give_every_serial_a_slot(&fixture.scene, alone);
    fixture.scene.systems[FAMILY_RAIN].capacity = roomy.scene.systems[FAMILY_RAIN].capacity;
    for (uint32_t i = FAMILY_RAIN; i < fixture.scene.system_count; i++)
        fixture.scene.systems[i].capacity = roomy.scene.systems[i].capacity;
    struct simulation few, enough;
    simulation_start(&few, &fixture.scene, NULL, 1);
    simulation_start(&enough, &roomy.scene, NULL, 1);
    simulation_run(&few, 150);
    simulation_run(&enough, 150);
    uint64_t few_alive, enough_alive;
    simulation_hash(&few, &few_alive);
    simulation_hash(&enough, &enough_alive);
    assert_true(few_alive < enough_alive);
    simulation_end(&few);
    simulation_end(&enough);
}

/* As test_step.c has it for all other systems. */
static void the_states_are_what_they_always_were(void **state)
{
    (void)state;
    static const struct kiln_state_hash golden[2] = {{{0x09756257u, 0x669d39cau}},
                                                     {{0x67e31a54u, 0xd266ffc2u}}};
    for (int order = 0; order < 2; order++)
        for (uint32_t threads = 1; threads <= 4; threads++) {
            fixture_family(&fixture, (enum kiln_integration)order);
            fixture_finish(&fixture, 200);
            struct simulation run;
            simulation_start(&run, &fixture.scene, NULL, threads);
            struct kiln_state_hash all = {{0, 0}};
            uint64_t alive = 0;
            for (int step = 0; step < 200; step++) {
                simulation_run(&run, 1);
                struct kiln_state_hash hash = simulation_hash(&run, &alive);
                all.lane[0] = random_mix(all.lane[0] + hash.lane[0]);
                all.lane[1] = random_mix(all.lane[1] + hash.lane[1]);
            }
            if (memcmp(&all, &golden[order], sizeof all) != 0)
                fail_msg("{{0x%08xu, 0x%08xu}} with order %d and %u threads, %u alive", all.lane[0],
                         all.lane[1], order, threads, (unsigned)alive);
            simulation_end(&run);
        }
}

/* What the loader makes impossible is refused by a step, too. */
static void a_run_that_does_not_fit_is_refused(void **state)
{
    (void)state;
    one_parent(0.0, 1.0f);
    resting_child(KILN_EVENT_DEATH, 5);
    fixture_finish(&fixture, 60);
    fixture.scene.systems[1].capacity = 4;
    struct simulation run;
    struct kiln_error error = {0};
    simulation_start(&run, &fixture.scene, NULL, 1);
    assert_false(kiln_simulate_step(run.simulate, &run.pool, 1, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "fixture: systems.child: 4 slots, but 1 parents with 5 children each");
    simulation_end(&run);

    fixture.scene.systems[1].capacity = 5;
    simulation_start(&run, &fixture.scene, NULL, 1);
    run.pool.systems[0].next_serial = UINT32_MAX / 5;
    assert_false(kiln_simulate_step(run.simulate, &run.pool, 1, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "fixture: systems.child: more than 2^32 births by step 1");
    simulation_end(&run);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(bursts_are_where_the_arc_ends),
        cmocka_unit_test(splashes_leave_the_surface),
        cmocka_unit_test(only_the_first_bounce_counts),
        cmocka_unit_test(trails_are_even),
        cmocka_unit_test(trails_follow_their_curve),
        cmocka_unit_test(trails_turn_at_surfaces),
        cmocka_unit_test(slots_are_free_when_their_turn_comes),
        cmocka_unit_test(slots_for_a_parents_own_life_are_too_few),
        cmocka_unit_test(the_states_are_what_they_always_were),
        cmocka_unit_test(a_run_that_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests_name("family", tests, NULL, NULL);
}
