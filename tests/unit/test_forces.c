/* Forces and integrators by technique `cpu`, against closed forms in double precision; and of which
 * order of accuracy each integrator is. */
#include <complex.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/force_vortex.h"
#include "shared/stages.h"
#include "support/cmocka.h"
#include "support/scene_fixture.h"
#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

static void assert_near(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("%.9g instead of %.9g, allowed %g off", found, expected, allowed);
}

/* The fixture with one system that emits one particle at time 0 at (1, 0, 0), with a velocity along
 * y, at so many steps a second. */
static struct kiln_system *one_particle(uint32_t rate, float speed)
{
    fixture_init(&fixture);
    fixture.scene.fps = fixture.scene.rate = (struct kiln_rational){rate, 1};
    fixture.scene.dt_s = 1.0f / (float)rate;
    struct kiln_system *system = fixture_add_system(&fixture, "one", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {1, 1}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(20.0f, 20.0f);
    system->emit.speed = fixture_range(speed, speed);
    system->emit.origin = fixture_constant3(1.0f, 0.0f, 0.0f);
    return system;
}

struct motion {
    double x[3], v[3];
};

static struct motion motion_of(struct simulation *run)
{
    struct kiln_particle p = simulation_records(run)[0];
    assert_true(particle_is_alive(p));
    float3 x = particle_position(p), v = particle_velocity(p);
    return (struct motion){{(double)x.x, (double)x.y, (double)x.z},
                           {(double)v.x, (double)v.y, (double)v.z}};
}

static struct motion run_fixture(uint32_t steps)
{
    fixture_finish(&fixture, steps);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, steps);
    struct motion end = motion_of(&run);
    simulation_end(&run);
    return end;
}

/* ---- orders of accuracy ---------------------------------------------------------------------- */

/* A motion with a known end after one second. Each sets the fixture up for a number of steps. */
struct problem {
    const char *name;
    struct motion (*set_up)(uint32_t rate); /* returns the end */
};

/* A spring: x = cos(w t). */
static struct motion spring(uint32_t rate)
{
    const double w = 4;
    struct kiln_force *force = fixture_add_force(one_particle(rate, 0.0f), KILN_FORCE_ATTRACT);
    force->strength = fixture_constant((float)(w * w));
    force->falloff = KILN_FALLOFF_LINEAR;
    return (struct motion){{cos(w), 0, 0}, {-w * sin(w), 0, 0}};
}

/* A circular orbit around a mass that is softened within a radius, as every distance is. */
static struct motion orbit(uint32_t rate)
{
    const double strength = 9, radius = 0.1;
    const double w = sqrt(strength / pow(1 + radius * radius, 1.5));
    struct kiln_force *force = fixture_add_force(one_particle(rate, (float)w), KILN_FORCE_ATTRACT);
    force->strength = fixture_constant((float)strength);
    force->scale = fixture_constant((float)radius);
    return (struct motion){{cos(w), sin(w), 0}, {-w * sin(w), w * cos(w), 0}};
}

/* In the core of a vortex, around z, with a pull p towards air that turns at w: with the plane of
 * complex numbers, x'' = p (i w x - x'), which two exponentials solve. */
static struct motion whirl(uint32_t rate)
{
    const double p = 3, w = 4, speed = 2;
    struct kiln_force *force =
        fixture_add_force(one_particle(rate, (float)speed), KILN_FORCE_VORTEX);
    force->axis = fixture_constant3(0.0f, 0.0f, 2.0f);
    force->scale = fixture_constant(10.0f);
    force->strength = fixture_constant((float)(w * 10));
    force->pull = fixture_constant((float)p);
    const double complex root = csqrt(p * p + 4 * I * p * w);
    const double complex a = (-p + root) / 2, b = (-p - root) / 2;
    const double complex from_a = (I * speed - b) / (a - b), from_b = 1 - from_a;
    const double complex x = from_a * cexp(a) + from_b * cexp(b);
    const double complex v = from_a * a * cexp(a) + from_b * b * cexp(b);
    return (struct motion){{creal(x), cimag(x), 0}, {creal(v), cimag(v), 0}};
}

/* A fall from rest through air that resists by the square of the speed. */
static struct motion fall(uint32_t rate)
{
    const double g = 9.81, k = 0.4, most = sqrt(g / k);
    struct kiln_system *system = one_particle(rate, 0.0f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -9.81f, 0.0f);
    struct kiln_force *drag = fixture_add_force(system, KILN_FORCE_DRAG);
    drag->quadratic = fixture_constant((float)k);
    const double fallen = most * most / g * log(cosh(g / most));
    return (struct motion){{1, -fallen, 0}, {0, -most * tanh(g / most), 0}};
}

static double error_of(const struct problem *problem, enum kiln_integration integration,
                       uint32_t rate)
{
    struct motion expected = problem->set_up(rate);
    fixture.scene.integration = integration;
    struct motion found = run_fixture(rate);
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += pow(found.x[i] - expected.x[i], 2) + pow(found.v[i] - expected.v[i], 2);
    return sqrt(square);
}

/* Halving the step divides the error by 2^order. */
static void integrators_have_their_orders(void **state)
{
    (void)state;
    static const struct problem problems[] = {
        {"spring", spring},
        {"orbit", orbit},
        {"whirl", whirl},
        {"fall", fall},
    };
    static const struct {
        enum kiln_integration integration;
        int order;
        uint32_t rate; /* coarse enough for floats, fine enough for the order to show */
    } integrators[] = {
        {KILN_INTEGRATE_SEMI_IMPLICIT, 1, 256},
        {KILN_INTEGRATE_POSITION_FIRST, 1, 256},
        {KILN_INTEGRATE_TRAPEZOID, 2, 64},
        {KILN_INTEGRATE_RK4, 4, 16},
    };
    for (size_t k = 0; k < sizeof integrators / sizeof *integrators; k++) {
        for (size_t i = 0; i < sizeof problems / sizeof *problems; i++) {
            const uint32_t rate = integrators[k].rate;
            double coarse = error_of(&problems[i], integrators[k].integration, rate);
            double fine = error_of(&problems[i], integrators[k].integration, 2 * rate);
            double order = log2(coarse / fine);
            if (!(fabs(order - integrators[k].order) < 0.45))
                fail_msg("%s with integrator %d: errors %g and %g are of order %.2f, not %d",
                         problems[i].name, (int)integrators[k].integration, coarse, fine, order,
                         integrators[k].order);
        }
    }
}

/* What is keyed over time is taken in the middle of the step: exact for straight lines. */
static void ramps_over_time_are_taken_halfway(void **state)
{
    (void)state;
    for (int i = KILN_INTEGRATE_TRAPEZOID; i <= KILN_INTEGRATE_RK4; i++) {
        struct kiln_system *system = one_particle(10, 0.0f);
        fixture.scene.integration = (enum kiln_integration)i;
        struct kiln_force *force = fixture_add_force(system, KILN_FORCE_GRAVITY);
        force->vector = fixture_constant3(0.0f, 0.0f, 0.0f);
        force->vector.z = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 2.0f, 6.0f);
        assert_near(run_fixture(20).v[2], 6.0, 1e-5);
    }
}

/* ---- drag ------------------------------------------------------------------------------------ */

/* Nothing but drag by the square of the speed: 1 / v grows by k a second. */
static void quadratic_drag_is_the_closed_form(void **state)
{
    (void)state;
    for (int i = KILN_INTEGRATE_TRAPEZOID; i <= KILN_INTEGRATE_RK4; i++) {
        struct kiln_force *drag = fixture_add_force(one_particle(60, 20.0f), KILN_FORCE_DRAG);
        drag->quadratic = fixture_constant(0.5f);
        fixture.scene.integration = (enum kiln_integration)i;
        struct motion end = run_fixture(60);
        assert_near(end.v[1], 20.0 / (1 + 0.5 * 20.0), i == KILN_INTEGRATE_RK4 ? 1e-4 : 5e-3);
        assert_near(end.x[1], log(1 + 0.5 * 20.0) / 0.5, i == KILN_INTEGRATE_RK4 ? 5e-4 : 0.02);
    }
}

/* Falling particles near the speed at which drag and weight are equal, from above and below, and
 * never pass it, however strong the drag and long the step; on the way they never turn. */
static void drag_never_overshoots(void **state)
{
    (void)state;
    static const float drags[] = {0.02f, 1.0f, 30.0f, 1000.0f}, starts[] = {-300.0f, -0.001f};
    for (int n = 0; n < 4 * 4 * 2; n++) {
        const double k = (double)drags[n / 2 % 4], balance = sqrt(9.81 / k);
        struct kiln_system *system = one_particle(20, -starts[n % 2]);
        system->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
        fixture.scene.integration = (enum kiln_integration)(n / 8);
        fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
            fixture_constant3(0.0f, -9.81f, 0.0f);
        fixture_add_force(system, KILN_FORCE_DRAG)->quadratic = fixture_constant(drags[n / 2 % 4]);
        fixture_finish(&fixture, 380);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        double before = (double)-starts[n % 2];
        const bool above = before > balance;
        for (int step = 0; step < 380; step++) {
            simulation_run(&run, 1);
            double speed = -motion_of(&run).v[1], least = 3e-5 * balance;
            bool good = above ? speed <= before + least && speed >= balance - least
                              : speed >= before - least && speed <= balance + least;
            if (!good)
                fail_msg("integrator %d, drag %g: %g after %g, balance %g", n / 8, k, speed, before,
                         balance);
            before = speed;
        }
        assert_near(before, balance, 2e-3 * balance);
        simulation_end(&run);
    }
}

/* Pulls are as exact in stages as in one: any strength, any step. */
static void pulls_stay_exact_in_stages(void **state)
{
    (void)state;
    static const float pulls[] = {0.01f, 0.9f, 9.9f, 10.1f, 500.0f};
    for (int n = 0; n < 2 * 5; n++) {
        struct kiln_system *system = one_particle(10, 5.0f);
        fixture.scene.integration = (enum kiln_integration)(KILN_INTEGRATE_TRAPEZOID + n / 5);
        fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
            fixture_constant3(0.0f, -9.81f, 0.0f);
        struct kiln_force *wind = fixture_add_force(system, KILN_FORCE_WIND);
        wind->vector = fixture_constant3(3.0f, 0.0f, 0.0f);
        wind->pull = fixture_constant(pulls[n % 5]);
        struct motion end = run_fixture(5);
        const double k = (double)pulls[n % 5], left = exp(-0.5 * k);
        assert_near(end.v[0], 3 * (1 - left), 1e-5);
        assert_near(end.v[1], -9.81 / k + (5 + 9.81 / k) * left, 1e-4);
    }
}

/* ---- attraction and vortices ----------------------------------------------------------------- */

/* At 1 m without a radius to speak of, each acceleration is the strength; at 2 m it is by the
 * falloff; at the point itself there is none; and a negative strength flees. */
static void attraction_falls_off_as_it_says(void **state)
{
    (void)state;
    static const double at_two[] = {0.25, 0.5, 1, 2};
    for (uint32_t falloff = 0; falloff < 4; falloff++) {
        struct force_input f = {
            .at = {.vector = {2.0f, 0.0f, 0.0f}, .strength = 3.0f, .scale = 0.001f}};
        f.profile = falloff;
        f.position = FLOAT3(2.0f, -1.0f, 0.0f);
        assert_near((double)force_attract(f).acceleration.y, 3.0, 1e-5);
        f.position = FLOAT3(2.0f, 0.0f, 2.0f);
        assert_near((double)force_attract(f).acceleration.z, -3.0 * at_two[falloff], 1e-5);
        f.at.strength = -3.0f;
        assert_near((double)force_attract(f).acceleration.z, 3.0 * at_two[falloff], 1e-5);
        f.position = f.at.vector;
        assert_true(float3_length(force_attract(f).acceleration) == 0.0f);
    }
}

static void vortices_turn_as_their_profiles_say(void **state)
{
    (void)state;
    const double a = (double)VORTEX_OSEEN;
    assert_near(exp(a), 1 + 2 * a, 1e-6);
    for (double s = 0.001; s < 1000; s *= 1.07) {
        const float square = (float)(s * s);
        double rankine = s <= 1 ? 1 : 1 / (s * s);
        double oseen = (1 + 0.5 / a) * -expm1(-a * s * s) / (s * s);
        assert_near((double)force_vortex_turn(square, VORTEX_RANKINE), rankine, 1e-6 * rankine);
        assert_near((double)force_vortex_turn(square, VORTEX_LAMB_OSEEN), oseen, 2e-6 * oseen);
    }
    struct force_input f = {.position = {0.0f, 5.0f, 2.0f},
                            .at = {.vector = {0.0f, -1.0f, 0.0f},
                                   .second = {0.0f, 3.0f, 0.0f},
                                   .strength = 4.0f,
                                   .pull = 10.0f,
                                   .scale = 2.0f},
                            .inward = 1.5f,
                            .lift = 6.0f};
    for (f.profile = 0; f.profile < 2; f.profile++) {
        struct force_effect e = force_vortex(f); /* at the core's edge */
        assert_near((double)e.acceleration.x, 40.0, 1e-4);
        assert_near((double)e.acceleration.y, 30.0, 1e-4);
        assert_near((double)e.acceleration.z, -15.0, 1e-4);
        assert_true(e.pull == 10.0f);
    }
}

/* What follows the air of a vortex goes around its axis, on a circle while nothing draws it in. */
static void particles_follow_a_vortex(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        struct kiln_force *force = fixture_add_force(one_particle(240, 3.0f), KILN_FORCE_VORTEX);
        fixture.scene.integration = KILN_INTEGRATE_RK4;
        force->axis = fixture_constant3(0.0f, 0.0f, 1.0f);
        force->scale = fixture_constant(1.0f);
        force->strength = fixture_constant(3.0f);
        force->pull = fixture_constant(1000.0f);
        force->profile = (enum kiln_vortex_profile)profile;
        struct motion end = run_fixture(240);
        assert_near(hypot(end.x[0], end.x[1]), 1.0, 0.012); /* v^2 / r / pull outwards */
        assert_near(atan2(end.x[1], end.x[0]), 3.0, 0.03);
    }
}

/* UberFlow's equation (1) adds the wind in each step, whatever the step. */
static void winds_may_be_added(void **state)
{
    (void)state;
    for (int order = 0; order < 4; order++) {
        for (uint32_t rate = 10; rate <= 90; rate += 40) {
            struct kiln_system *system = one_particle(rate, 0.0f);
            fixture.scene.integration = (enum kiln_integration)order;
            struct kiln_force *wind = fixture_add_force(system, KILN_FORCE_WIND);
            wind->vector = fixture_constant3(0.0f, 0.0f, 0.25f);
            wind->pull = fixture_constant(7.0f);
            wind->mode = KILN_WIND_ADD;
            struct kiln_force *vortex = fixture_add_force(system, KILN_FORCE_VORTEX);
            vortex->center = fixture_constant3(1.0f, 0.0f, 0.0f);
            vortex->axis = fixture_constant3(0.0f, 0.0f, 1.0f);
            vortex->radius = fixture_constant(1.0f);
            vortex->lift = fixture_constant(0.5f);
            vortex->pull = fixture_constant(7.0f);
            vortex->mode = KILN_WIND_ADD;
            assert_near(run_fixture(40).v[2], 40 * 0.75, 1e-4);
        }
    }
}

/* ---- arithmetic ------------------------------------------------------------------------------ */

static void weights_are_the_closed_forms(void **state)
{
    (void)state;
    assert_true(stages_weigh(0.0f).one == 1.0f && stages_weigh(0.0f).two == 0.5f);
    for (int i = 0; i < 2000; i++) {
        const float z = (float)(1e-3 * pow(1.006, i));
        const double x = (double)z, one = -expm1(-x) / x;
        struct stages_weights w = stages_weigh(z);
        double two = x < 1e-2 ? 0.5 - x / 6 + x * x / 24 - x * x * x / 120 : (1 - one) / x;
        double three = x < 1e-2 ? 1.0 / 6 - x / 24 + x * x / 120 : (0.5 - two) / x;
        assert_near((double)w.one, one, 4e-7 * one);
        assert_near((double)w.two, two, 2e-6 * two);
        assert_near((double)w.three, three, 2e-6 * three);
    }
}

static void what_is_no_number_is_not_trusted(void **state)
{
    (void)state;
    const float3 a = {1.0f, 2.0f, 3.0f}, b = {NAN, INFINITY, 5.0f};
    assert_true(stages_trust(0.0f) == 1.0f && stages_trust(1.0f) == 0.0f);
    assert_true(stages_trust(NAN) == 0.0f && stages_trust(INFINITY) == 0.0f);
    float3 y = stages_mix(a, b, stages_trust(NAN));
    assert_memory_equal(&y, &a, sizeof y);
}

static struct kiln_state_hash hash_of_fixture(uint32_t steps)
{
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 2);
    struct kiln_state_hash all = simulation_run_hashed(&run, steps);
    simulation_end(&run);
    return all;
}

/* A force that shared/forces.h has no row of would do nothing. */
static void every_kind_of_force_moves(void **state)
{
    (void)state;
    enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS];
    const uint32_t count = fixture_force_kinds(kinds);
    for (uint32_t i = 0; i < count; i++) {
        fixture_alone(&fixture, kinds[i], 20);
        const struct kiln_state_hash with = hash_of_fixture(20);
        fixture.scene.systems[0].force_count = 0;
        const struct kiln_state_hash without = hash_of_fixture(20);
        if (with.lane[0] == without.lane[0] && with.lane[1] == without.lane[1])
            fail_msg("force kind %d changes no state", (int)kinds[i]);
    }
}

/* The states of all steps of a scene with all forces, by integrator, as they were when this was
 * written: see test_step.c. */
static void the_states_are_what_they_always_were(void **state)
{
    (void)state;
    static const struct kiln_state_hash golden[4] = {{{0xdd934f30u, 0x251c48c5u}},
                                                     {{0x94100db3u, 0x99f80f98u}},
                                                     {{0xf3cd2836u, 0xad39b5b7u}},
                                                     {{0xaca407b2u, 0x98c4395eu}}};
    unsigned changed = 0;
    for (int order = 0; order < 4; order++) {
        fixture_zoo(&fixture, (enum kiln_integration)order, 0);
        fixture_add_whirls(&fixture);
        fixture_finish(&fixture, 120);
        const struct kiln_state_hash all = hash_of_fixture(120);
        if (all.lane[0] == golden[order].lane[0] && all.lane[1] == golden[order].lane[1])
            continue;
        print_error("{{0x%08xu, 0x%08xu}} with integrator %d\n", all.lane[0], all.lane[1], order);
        changed++;
    }
    assert_int_equal(changed, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(integrators_have_their_orders),
        cmocka_unit_test(ramps_over_time_are_taken_halfway),
        cmocka_unit_test(quadratic_drag_is_the_closed_form),
        cmocka_unit_test(drag_never_overshoots),
        cmocka_unit_test(pulls_stay_exact_in_stages),
        cmocka_unit_test(attraction_falls_off_as_it_says),
        cmocka_unit_test(vortices_turn_as_their_profiles_say),
        cmocka_unit_test(particles_follow_a_vortex),
        cmocka_unit_test(winds_may_be_added),
        cmocka_unit_test(weights_are_the_closed_forms),
        cmocka_unit_test(what_is_no_number_is_not_trusted),
        cmocka_unit_test(every_kind_of_force_moves),
        cmocka_unit_test(the_states_are_what_they_always_were),
    };
    return cmocka_run_group_tests_name("forces", tests, NULL, NULL);
}
