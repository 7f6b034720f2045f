/* What holds for every kind of collider: a bounce has restitution, friction, randomness and
 * slowdown; what moves pushes and drags; no bounce adds energy; and nothing tunnels at ten times
 * the speeds of scenes. Each has its top at the origin; test_collide*.c, test_terrain.c,
 * test_field.c and test_depth_maps.c have what is special about one kind.
 */
#include <stddef.h>
#include <stdint.h>

#include "shared/exact.h"
#include "support/cmocka.h"
#include "support/folders.h"
#include "support/simulation.h"
#include "support/surfaces.h"
#include "support/thrown.h"

/* With factors of its own. */
static struct kiln_object *add_rubbing(size_t kind, double restitution, double friction)
{
    struct kiln_object *object = surfaces[kind].add();
    struct kiln_backdrop *backdrop = &fixture.scene.backdrop;
    *(object ? &object->restitution : &backdrop->floor_restitution) =
        fixture_constant((float)restitution);
    *(object ? &object->friction : &backdrop->floor_friction) = fixture_constant((float)friction);
    return object;
}

static void assert_speed(size_t kind, const char *what, float found, double expected,
                         double allowed)
{
    if (!(fabs((double)found - expected) <= allowed))
        fail_msg("%s: %s %.9g instead of %.9g", surfaces[kind].name, what, (double)found, expected);
}

/* Onto the top, with 2 m/s down and 3 m/s along. */
static void they_give_back_rub_and_slow_down(void **state)
{
    (void)state;
    static const double cases[][3] = {{1, 0, 1},   {0.5, 0, 1}, {0.5, 0.25, 1},
                                      {0.8, 5, 1}, {0, 0.5, 1}, {0.6, 0.3, 0.5}};
    for (size_t kind = 0; kind < SURFACES; kind++) {
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            const double e = cases[i][0], mu = cases[i][1], slow = cases[i][2];
            struct kiln_system *system = one_particle(FLOAT3(-0.75f, 0.5f, 0), FLOAT3(3, -2, 0));
            system->collide.restitution = fixture_constant((float)sqrt(e));
            system->collide.friction = fixture_constant((float)(mu * 2));
            system->collide.slowdown = fixture_constant((float)slow);
            add_rubbing(kind, sqrt(e), 0.5); /* factors multiply */
            const float3 v = particle_velocity(after(17));
            assert_speed(kind, "up", v.y, slow * 2 * e, 1e-3);
            assert_speed(kind, "along", v.x, slow * fmax(3 - mu * (1 + e) * 2, 0), 1e-3);
            assert_speed(kind, "across", v.z, 0, 1e-3);
        }
    }
}

/* A crowd that starts a metre above the top, each straight towards it. */
static struct kiln_system *a_crowd(uint32_t count)
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "crowd", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {count, count}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    system->emit.origin = fixture_constant3(0.0f, 1.0f, 0.0f);
    system->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
    system->collide.enabled = true;
    return system;
}

static void they_scatter_over_the_hemisphere(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    for (size_t kind = 0; kind < SURFACES; kind++) {
        struct kiln_system *system = a_crowd(COUNT);
        system->emit.speed = fixture_range(10.0f, 10.0f);
        system->collide.randomness = fixture_constant(1.0f);
        system->collide.slowdown = fixture_constant(0.5f);
        add_rubbing(kind, 1, 1);
        fixture_finish(&fixture, 7);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        simulation_run(&run, 7);
        double up = 0, along = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            const float3 v = particle_velocity(simulation_records(&run)[i]);
            assert_speed(kind, "length", float3_length(v), 5, 1e-3);
            assert_true(v.y >= 0.0f);
            up += (double)v.y / 5 / COUNT;
            along += (double)v.x / 5 / COUNT;
        }
        assert_speed(kind, "mean height", (float)up, 0.5, 0.02);
        assert_speed(kind, "mean place", (float)along, 0, 0.03);
        simulation_end(&run);
    }
}

/* What comes at 10 m/s throws by that and what it gives back; with friction, a surface takes along
 * what falls onto it. */
static void what_moves_pushes_and_drags(void **state)
{
    (void)state;
    for (size_t kind = 0; kind < SURFACES; kind++) {
        if (!surfaces[kind].moves)
            continue;
        one_particle(FLOAT3(0, 2, 0), FLOAT3(0, -0.0001f, 0));
        struct kiln_object *object = add_rubbing(kind, 0.5, 1);
        const float y = object->center.y.constant;
        object->center.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, y, 1, y + 10);
        assert_speed(kind, "thrown up", particle_velocity(after(20)).y, 15, 0.02);

        struct kiln_system *system = one_particle(FLOAT3(0, 0.1f, 0), FLOAT3(0, -1, 0));
        system->collide.restitution = fixture_constant(0.0f);
        system->collide.friction = fixture_constant(9.0f);
        object = add_rubbing(kind, 1, 1);
        object->center.z = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 0.5f);
        if (surfaces[kind].form != SURFACE_ROUND) /* whose top is elsewhere by then */
            assert_speed(kind, "carried", particle_velocity(after(10)).z, 0.5, 1e-3);
    }
}

/* m: how far outside of its upper side. */
static double outside_of(size_t kind, float3 p)
{
    const double x = (double)p.x, y = (double)p.y, z = (double)p.z;
    if (surfaces[kind].form == SURFACE_FLAT)
        return fabs(x) < 10 && fabs(z) < 10 ? y : 0;
    if (surfaces[kind].form == SURFACE_ROUND)
        return sqrt(x * x + (y + 5) * (y + 5) + z * z) - 5;
    return fabs(z) < 10 ? sqrt(x * x + (y + 5) * (y + 5)) - 5 : 0;
}

/* Falls on and on, at up to 600 m/s; between impacts without gravity no speed grows. */
static void rain(size_t kind, float gravity)
{
    enum { COUNT = 300, STEPS = 40 };
    static double before[COUNT];
    struct kiln_system *system = a_crowd(COUNT);
    system->emit.speed = fixture_range(5.0f, 600.0f);
    system->emit.angle = fixture_constant(1.2f);
    system->collide.randomness = fixture_constant(0.3f);
    system->collide.slowdown = fixture_constant(0.95f);
    system->collide.restitution = fixture_constant(0.9f);
    system->collide.friction = fixture_constant(0.2f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0, -gravity, 0);
    add_rubbing(kind, 1, 1);
    fixture_finish(&fixture, STEPS);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    uint32_t slowed = 0;
    for (int step = 0; step < STEPS; step++) {
        simulation_run(&run, 1);
        for (uint32_t i = 0; i < COUNT; i++) {
            const struct kiln_particle p = simulation_records(&run)[i];
            const double speed = (double)float3_length(particle_velocity(p));
            const double out = outside_of(kind, particle_position(p));
            if (out < -1e-5)
                fail_msg("%s: %g m inside in step %d", surfaces[kind].name, -out, step);
            if (step > 0 && gravity == 0.0f && speed > before[i] * (1 + 2e-6))
                fail_msg("%s: %.9g m/s after %.9g", surfaces[kind].name, speed, before[i]);
            slowed += step == 0 ? particle_velocity(p).y > 0 : speed < 0.99 * before[i];
            before[i] = speed;
        }
    }
    if (slowed < COUNT / 2)
        fail_msg("%s: %u impacts", surfaces[kind].name, slowed);
    simulation_end(&run);
}

static void nothing_tunnels_and_no_energy_grows(void **state)
{
    (void)state;
    for (size_t kind = 0; kind < SURFACES; kind++) {
        rain(kind, 0.0f);
        rain(kind, 200.0f);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_give_back_rub_and_slow_down),
        cmocka_unit_test(they_scatter_over_the_hemisphere),
        cmocka_unit_test(what_moves_pushes_and_drags),
        cmocka_unit_test(nothing_tunnels_and_no_energy_grows),
    };
    return cmocka_run_group_tests_name("boundaries", tests, test_enter_folder, test_leave_folder);
}
