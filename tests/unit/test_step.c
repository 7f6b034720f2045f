/* The step of a particle, by technique `cpu`: births, motion and death against closed forms. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/forces.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scene_fixture.h"
#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

static void assert_near(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("%.9g instead of %.9g, allowed %g off", found, expected, allowed);
}

/* The fixture with one system that emits one particle at time 0 with velocity (3, 4, 0). */
static struct kiln_system *one_particle(struct scene_fixture *f)
{
    fixture_init(f);
    struct kiln_system *system = fixture_add_system(f, "one", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {1, 1}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    system->emit.speed = fixture_range(5.0f, 5.0f);
    system->emit.direction = fixture_constant3(0.6f, 0.8f, 0.0f);
    return system;
}

static void run_fixture(struct simulation *run, uint32_t steps)
{
    fixture_finish(&fixture, steps);
    simulation_start(run, &fixture.scene, NULL, 1);
    simulation_run(run, steps);
}

static void constant_acceleration_gives_the_sums_of_each_order(void **state)
{
    (void)state;
    for (int order = 0; order < 2; order++) {
        struct kiln_system *system = one_particle(&fixture);
        fixture.scene.integration = (enum kiln_integration)order;
        fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
            fixture_constant3(0.0f, -9.81f, 0.0f);
        struct simulation run;
        run_fixture(&run, 120);
        struct kiln_particle p = simulation_records(&run)[0];
        double dt = 1.0 / 60.0, n = 120;
        /* velocity first: sum of k = 1 .. n; position first: of 0 .. n - 1 */
        double sum = order == KILN_INTEGRATE_SEMI_IMPLICIT ? n * (n + 1) / 2 : n * (n - 1) / 2;
        assert_near((double)particle_position(p).x, 6.0, 1e-4);
        assert_near((double)particle_position(p).y, 8.0 - 9.81 * dt * dt * sum, 1e-4);
        assert_near((double)particle_velocity(p).y, 4.0 - 9.81 * 2.0, 1e-4);
        simulation_end(&run);
    }
}

/* Drag is exact for any strength and step: v = v0 e^(-k t). */
static void drag_decays_exponentially(void **state)
{
    (void)state;
    static const float strengths[] = {0.01f, 1.0f, 14.0f, 16.0f, 100.0f, 5000.0f};
    for (size_t i = 0; i < sizeof strengths / sizeof *strengths; i++) {
        struct kiln_system *system = one_particle(&fixture);
        fixture_add_force(system, KILN_FORCE_DRAG)->pull = fixture_constant(strengths[i]);
        struct simulation run;
        run_fixture(&run, 30);
        struct kiln_particle p = simulation_records(&run)[0];
        double expected = 5.0 * exp(-(double)strengths[i] * 0.5);
        assert_near((double)float3_length(particle_velocity(p)), expected, 1e-5 * expected + 1e-12);
        simulation_end(&run);
    }
}

/* Gravity and wind together: v goes to air + g / k exponentially, without overshoot. */
static void wind_and_gravity_find_their_balance(void **state)
{
    (void)state;
    static const float pulls[] = {0.5f, 3.0f, 80.0f, 2000.0f};
    for (size_t i = 0; i < sizeof pulls / sizeof *pulls; i++) {
        struct kiln_system *system = one_particle(&fixture);
        fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
            fixture_constant3(0.0f, -9.81f, 0.0f);
        struct kiln_force *wind = fixture_add_force(system, KILN_FORCE_WIND);
        wind->vector = fixture_constant3(-2.0f, 1.0f, 7.0f);
        wind->pull = fixture_constant(pulls[i]);
        struct simulation run;
        run_fixture(&run, 60);
        float3 v = particle_velocity(simulation_records(&run)[0]);
        double k = (double)pulls[i], left = exp(-k);
        assert_near((double)v.x, -2.0 + 5.0 * left, 1e-4);
        assert_near((double)v.y, 1.0 - 9.81 / k + (3.0 + 9.81 / k) * left, 1e-4);
        assert_near((double)v.z, 7.0 - 7.0 * left, 1e-4);
        simulation_end(&run);
    }
}

/* The direction stays, the speed is no more than the limit of that age; of two, the lower. */
static void limits_take_what_is_above(void **state)
{
    (void)state;
    struct kiln_system *system = one_particle(&fixture);
    system->emit.life = fixture_range(1.0f, 1.0f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.6f, 0.8f, 0.0f);
    fixture_add_force(system, KILN_FORCE_LIMIT)->strength =
        fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0.0f, 10.0f, 1.0f, 0.0f);
    fixture_add_force(system, KILN_FORCE_LIMIT)->strength = fixture_constant(5.4f);
    fixture_finish(&fixture, 60);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    for (int step = 1; step < 60; step++) {
        simulation_run(&run, 1);
        double free_fall = 5.0 + step / 60.0, limit = 10.0 * (1.0 - (step - 1) / 60.0);
        double expected = fmin(fmin(free_fall, limit), 5.4);
        float3 v = particle_velocity(simulation_records(&run)[0]);
        assert_near((double)v.x, 0.6 * expected, 1e-4);
        assert_near((double)v.y, 0.8 * expected, 1e-4);
    }
    simulation_end(&run);
}

static void damping_is_the_closed_form(void **state)
{
    (void)state;
    assert_true(forces_damping(0.0f) == 1.0f);
    for (int i = 0; i < 2000; i++) {
        double z = 1e-6 * pow(1.01, i);
        double expected = -expm1(-(double)(float)z) / (double)(float)z;
        assert_near((double)forces_damping((float)z), expected, 4e-7 * expected);
    }
}

static void curl_noise_carries_at_its_speed(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "leaves", 3000.0f);
    system->emit.shape = KILN_EMITTER_BOX;
    system->emit.size = fixture_constant3(50.0f, 50.0f, 50.0f);
    system->emit.speed = fixture_range(0.0f, 0.0f);
    struct kiln_force *curl = fixture_add_force(system, KILN_FORCE_CURL);
    curl->strength = fixture_constant(3.0f);
    curl->pull = fixture_constant(1000.0f);
    curl->scale = fixture_constant(2.0f);
    struct simulation run;
    run_fixture(&run, 60);
    double square = 0;
    uint64_t alive = 0;
    simulation_hash(&run, &alive);
    assert_true(alive > 2000);
    for (uint32_t i = 0; i < run.pool.slot_count; i++) {
        float3 v = particle_velocity(simulation_records(&run)[i]);
        square += (double)float3_dot(v, v) / (double)alive;
    }
    assert_near(sqrt(square), 3.0, 0.2);
    simulation_end(&run);
}

/* Births lie where they would be had they happened at their own time: on one line, equally spaced.
 */
static void births_are_spread_inside_the_step(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "beam", 960.0f); /* 16 a step */
    system->emit.speed = fixture_range(6.0f, 6.0f);
    struct simulation run;
    run_fixture(&run, 30);
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t serial = 0; serial < 480; serial++) {
        float3 x = particle_position(records[serial]);
        assert_int_equal(records[serial].position_serial.w, serial);
        assert_near((double)x.y, 6.0 * (0.5 - serial / 960.0), 1e-4);
        assert_true(x.x == 0.0f && x.z == 0.0f);
    }
    simulation_end(&run);
}

/* A moving emitter leaves an even trail, and hands on its velocity. */
static void moving_emitters_trail_and_throw(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "trail", 960.0f);
    system->emit.speed = fixture_range(0.0f, 0.0f);
    system->emit.origin.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 1.0f, 30.0f);
    system->emit.inherit = fixture_constant(0.5f);
    struct simulation run;
    run_fixture(&run, 30);
    for (uint32_t serial = 0; serial < 480; serial++) {
        struct kiln_particle p = simulation_records(&run)[serial];
        double born_s = serial / 960.0;
        assert_near((double)particle_velocity(p).x, 15.0, 1e-4);
        assert_near((double)particle_position(p).x, 30.0 * born_s + 15.0 * (0.5 - born_s), 1e-3);
    }
    simulation_end(&run);
}

/* All parts of a disc that turns have the velocity of their place. */
static void turning_emitters_throw_sideways(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "disc", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {100, 100}};
    system->emit.burst_count = 1;
    system->emit.speed = fixture_range(0.0f, 0.0f);
    system->emit.shape = KILN_EMITTER_DISC;
    system->emit.radius = fixture_constant(2.0f);
    system->emit.origin = fixture_constant3(5.0f, 1.0f, 0.0f);
    system->emit.turn = fixture_constant(3.0f);
    struct simulation run;
    run_fixture(&run, 1);
    for (uint32_t serial = 0; serial < 100; serial++) {
        struct kiln_particle p = simulation_records(&run)[serial];
        const double vx = (double)particle_velocity(p).x, vz = (double)particle_velocity(p).z;
        const double x = (double)particle_position(p).x - 5.0 - vx / 60.0;
        const double z = (double)particle_position(p).z - vz / 60.0;
        assert_near(vx, 3.0 * z, 1e-5); /* about y, right-handed */
        assert_near(vz, -3.0 * x, 1e-5);
        assert_near((double)particle_velocity(p).y, 0.0, 0.0);
    }
    simulation_end(&run);
}

/* Each lives for its own time, drawn again here, and is gone at the end of the step that passes it;
 * after some rounds of the slots every living serial lies where it should. */
static void lives_end_on_time_and_slots_are_reborn(void **state)
{
    (void)state;
    fixture_init(&fixture);
    fixture.scene.warmup_steps = 20;
    struct kiln_system *system = fixture_add_system(&fixture, "short", 500.0f);
    system->emit.life = fixture_range(0.1f, 0.4f);
    fixture_finish(&fixture, 200);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    const uint32_t capacity = system->capacity;
    assert_true(capacity < 300);
    const float dt_s = fixture.scene.dt_s;
    uint32_t key = random_key(fixture.scene.seed, 0);
    for (uint32_t step = 1; step <= 200; step++) {
        simulation_run(&run, 1);
        const struct kiln_particle *records = simulation_records(&run);
        uint32_t born = (uint32_t)run.pool.systems[0].next_serial;
        for (uint32_t serial = born > capacity ? born - capacity : 0; serial < born; serial++) {
            struct kiln_particle p = records[serial % capacity];
            double life_s =
                (double)random_between(random_stream(key, serial), RANDOM_LIFE, 0.1f, 0.4f);
            double age_s = step / 60.0 - serial / 500.0;
            if (fabs(age_s - life_s) < (double)dt_s / 32)
                continue; /* births are rounded to 64ths of a step */
            assert_int_equal(particle_is_alive(p), age_s < life_s);
            if (particle_is_alive(p))
                assert_int_equal(p.position_serial.w, serial);
        }
    }
    simulation_end(&run);
}

static void demitters_bounds_and_absurdity_kill(void **state)
{
    (void)state;
    uint64_t alive;
    for (int kind = 0; kind < 4; kind++) {
        struct kiln_system *system = one_particle(&fixture); /* passes (1.5, 2, 0) at 0.5 s */
        if (kind == 0) {
            system->demitter_count = 2;
            system->demitters[0] = (struct kiln_demitter){.box = {true, {9, 9, 9}, {10, 10, 10}}};
            system->demitters[1] = (struct kiln_demitter){.box = {true, {1.5f, 1, -1}, {4, 4, 1}}};
        } else if (kind == 1) {
            system->bounds = (struct kiln_bounds){true, {-1, -1, -1}, {9, 2, 1}};
        } else if (kind == 2) { /* 2 * 500000 m/s^2 * t passes 2^20 m/s soon after 0.5 s */
            fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
                fixture_constant3(0, 2 * 1048576.0f, 0);
        } else {
            struct kiln_force *force = fixture_add_force(system, KILN_FORCE_GRAVITY);
            force->vector = fixture_constant3(0, 0, 0);
            force->vector.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.5f, 0, 0.51f, INFINITY);
        }
        fixture_finish(&fixture, 60);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        simulation_run(&run, 28);
        simulation_hash(&run, &alive);
        assert_int_equal(alive, 1);
        simulation_run(&run, 6);
        struct kiln_state_hash hash = simulation_hash(&run, &alive);
        assert_int_equal(alive, 0);
        assert_int_equal(hash.lane[0], 0);
        assert_int_equal(hash.lane[1], 0);
        simulation_end(&run);
    }
}

/* Where births lie and where they go, for each shape; speed 0 keeps them where they were born. */
static void check_shape(enum kiln_emitter_shape shape, bool surface,
                        void (*check)(float3 at, bool surface))
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "shape", 3000.0f);
    system->emit.shape = shape;
    system->emit.surface = surface;
    system->emit.speed = fixture_range(0.0f, 0.0f);
    system->emit.origin = fixture_constant3(1.0f, 2.0f, 3.0f);
    system->emit.direction = fixture_constant3(0.0f, 0.0f, 5.0f);
    system->emit.radius = fixture_constant(2.0f);
    system->emit.size = fixture_constant3(2.0f, 4.0f, 6.0f);
    system->emit.angle = fixture_constant(0.5f);
    struct simulation run;
    run_fixture(&run, 30);
    double x = 0, y = 0, z = 0;
    for (uint32_t i = 0; i < 1500; i++) {
        float3 p = particle_position(simulation_records(&run)[i]);
        float3 origin = FLOAT3(1.0f, 2.0f, 3.0f);
        check(float3_sub(p, origin), surface);
        x += ((double)p.x - 1) / 1500;
        y += ((double)p.y - 2) / 1500;
        z += ((double)p.z - 3) / 1500;
    }
    assert_near(x, 0, 0.2);
    assert_near(y, 0, 0.2);
    assert_near(z, 0, 0.2);
    simulation_end(&run);
}

static void on_point(float3 at, bool surface)
{
    (void)surface;
    assert_true(float3_length(at) == 0.0f);
}

static void on_sphere(float3 at, bool surface)
{
    double r = (double)float3_length(at);
    assert_true(r <= 2.0001 && (!surface || r > 1.9999));
}

static void on_box(float3 at, bool surface)
{
    assert_true(fabsf(at.x) <= 1.0001f && fabsf(at.y) <= 2.0001f && fabsf(at.z) <= 3.0001f);
    if (surface)
        assert_true(fabsf(at.x) > 0.9999f || fabsf(at.y) > 1.9999f || fabsf(at.z) > 2.9999f);
}

static void on_disc(float3 at, bool surface)
{
    double r = hypot((double)at.x, (double)at.y);
    assert_true(fabsf(at.z) < 1e-5f && r <= 2.0001 && (!surface || r > 1.9999));
}

static void on_ring(float3 at, bool surface)
{
    (void)surface;
    on_disc(at, true);
}

static void on_line(float3 at, bool surface)
{
    (void)surface;
    const float part = at.x / 2.0f;
    assert_true(fabsf(part) <= 0.5001f && fabsf(at.y - 4.0f * part) < 1e-5f &&
                fabsf(at.z - 6.0f * part) < 1e-5f);
}

static void emitters_keep_to_their_shapes(void **state)
{
    (void)state;
    check_shape(KILN_EMITTER_POINT, false, on_point);
    check_shape(KILN_EMITTER_SPHERE, false, on_sphere);
    check_shape(KILN_EMITTER_SPHERE, true, on_sphere);
    check_shape(KILN_EMITTER_BOX, false, on_box);
    check_shape(KILN_EMITTER_BOX, true, on_box);
    check_shape(KILN_EMITTER_DISC, false, on_disc);
    check_shape(KILN_EMITTER_DISC, true, on_disc);
    check_shape(KILN_EMITTER_LINE, false, on_line);
    check_shape(KILN_EMITTER_RING, false, on_ring);
}

/* Serial after serial, from the first end to the last and again: in the middles of equal parts. */
static void nozzles_take_turns(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "rake", 960.0f);
    system->emit.shape = KILN_EMITTER_LINE;
    system->emit.nozzles = 7;
    system->emit.speed = fixture_range(0.0f, 0.0f);
    system->emit.origin = fixture_constant3(1.0f, 2.0f, 3.0f);
    system->emit.size = fixture_constant3(0.0f, -14.0f, 0.0f);
    struct simulation run;
    run_fixture(&run, 10);
    for (uint32_t serial = 0; serial < 160; serial++) {
        const float3 at = particle_position(simulation_records(&run)[serial]);
        assert_true(at.x == 1.0f && at.z == 3.0f);
        assert_near((double)at.y, 8.0 - 2.0 * (serial % 7), 1e-5);
    }
    simulation_end(&run);
}

/* A cone widens evenly: seen from the point behind, every direction is that of the place. With the
 * angle at 0 it is a parallel beam as wide as the radius. */
static void cones_widen_from_their_nozzle(void **state)
{
    (void)state;
    static const float angles[] = {0.0f, 0.3f};
    for (int k = 0; k < 2; k++) {
        fixture_init(&fixture);
        struct kiln_system *system = fixture_add_system(&fixture, "cone", 3000.0f);
        system->emit.shape = KILN_EMITTER_CONE;
        system->emit.direction = fixture_constant3(0.0f, 0.0f, 1.0f);
        system->emit.radius = fixture_constant(0.5f);
        system->emit.angle = fixture_constant(angles[k]);
        struct simulation run;
        run_fixture(&run, 1);
        double farthest = 0;
        for (uint32_t i = 0; i < 50; i++) {
            struct kiln_particle p = simulation_records(&run)[i];
            float3 v = particle_velocity(p), x = particle_position(p);
            double age_s = (double)particle_age(p, 1, fixture.scene.dt_s);
            float speed = float3_length(v);
            assert_true(speed > 0.9999f && speed < 2.0001f);
            double px = (double)x.x - (double)v.x * age_s, py = (double)x.y - (double)v.y * age_s;
            double r = hypot(px, py), across = hypot((double)v.x, (double)v.y);
            farthest = fmax(farthest, r);
            assert_true(r <= 0.5001 && (double)x.z >= 0);
            double angle = acos(fmin(1.0, (double)v.z / (double)speed));
            assert_true(angle <= (double)angles[k] + 1e-3);
            if (k == 1) {
                double part = (1 - cos(angle)) / (1 - cos((double)angles[k]));
                assert_near(r, 0.5 * sqrt(part), 2e-3);
                assert_near(px * (double)v.y, py * (double)v.x, 1e-4);
            } else {
                assert_near(across, 0, 1e-5);
            }
        }
        assert_true(farthest > 0.4);
        simulation_end(&run);
    }
}

static void outward_spheres_throw_from_the_middle(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "burst", 3000.0f);
    system->emit.shape = KILN_EMITTER_SPHERE;
    system->emit.outward = true;
    system->emit.radius = fixture_constant(1.0f);
    struct simulation run;
    run_fixture(&run, 30);
    for (uint32_t i = 0; i < 1500; i++) {
        struct kiln_particle p = simulation_records(&run)[i];
        float3 x = particle_position(p), v = particle_velocity(p);
        float along = float3_dot(x, v);
        assert_near((double)along, (double)(float3_length(x) * float3_length(v)), 1e-4);
    }
    simulation_end(&run);
}

static void a_run_that_does_not_fit_is_refused(void **state)
{
    (void)state;
    fixture_init(&fixture);
    fixture_add_system(&fixture, "flood", 6000.0f);
    fixture_finish(&fixture, 60);
    fixture.scene.systems[0].capacity = 99; /* 100 births a step */
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    struct kiln_error error = {0};
    assert_false(kiln_simulate_step(run.simulate, &run.pool, 1, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "fixture: systems.flood: 100 births in step 1, but only 99 slots");
    simulation_end(&run);

    fixture.scene.systems[0].capacity = 1000;
    simulation_start(&run, &fixture.scene, NULL, 1);
    run.pool.systems[0].next_serial = UINT32_MAX - 50;
    assert_false(kiln_simulate_step(run.simulate, &run.pool, 1, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "fixture: systems.flood: more than 2^32 births by step 1");
    assert_false(kiln_simulate_step(run.simulate, &run.pool, 0, &error));
    assert_false(kiln_simulate_step(run.simulate, &run.pool, KILN_MAX_STEPS + 1, &error));
    simulation_end(&run);
}

/* The states of all steps of one small scene with everything in it, as they were when this was
 * written. Whoever changes the simulation on purpose writes the new numbers here and says so in the
 * change log; a change that was not meant to show must leave them as they are. */
static void the_states_are_what_they_always_were(void **state)
{
    (void)state;
    static const struct kiln_state_hash golden[2] = {{{0xeb317edbu, 0xc55fa891u}},
                                                     {{0x50bf869du, 0xad51acf3u}}};
    static const uint32_t threads[] = {1, 2, 8};
    for (int order = 0; order < 2; order++)
        for (int t = 0; t < 3; t++) {
            fixture_zoo(&fixture, (enum kiln_integration)order, 300);
            struct simulation run;
            simulation_start(&run, &fixture.scene, NULL, threads[t]);
            struct kiln_state_hash all = simulation_run_hashed(&run, 300);
            if (all.lane[0] != golden[order].lane[0] || all.lane[1] != golden[order].lane[1])
                fail_msg("{{0x%08xu, 0x%08xu}} with order %d and %u threads", all.lane[0],
                         all.lane[1], order, threads[t]);
            simulation_end(&run);
        }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_acceleration_gives_the_sums_of_each_order),
        cmocka_unit_test(drag_decays_exponentially),
        cmocka_unit_test(wind_and_gravity_find_their_balance),
        cmocka_unit_test(limits_take_what_is_above),
        cmocka_unit_test(damping_is_the_closed_form),
        cmocka_unit_test(curl_noise_carries_at_its_speed),
        cmocka_unit_test(births_are_spread_inside_the_step),
        cmocka_unit_test(moving_emitters_trail_and_throw),
        cmocka_unit_test(turning_emitters_throw_sideways),
        cmocka_unit_test(lives_end_on_time_and_slots_are_reborn),
        cmocka_unit_test(demitters_bounds_and_absurdity_kill),
        cmocka_unit_test(emitters_keep_to_their_shapes),
        cmocka_unit_test(cones_widen_from_their_nozzle),
        cmocka_unit_test(nozzles_take_turns),
        cmocka_unit_test(outward_spheres_throw_from_the_middle),
        cmocka_unit_test(a_run_that_does_not_fit_is_refused),
        cmocka_unit_test(the_states_are_what_they_always_were),
    };
    return cmocka_run_group_tests_name("step", tests, NULL, NULL);
}
