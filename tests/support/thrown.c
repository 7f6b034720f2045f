/* Makes scenes of particles that fly at colliders, runs them, and checks positions and velocities,
 * for tests of collisions. */
#include "support/thrown.h"

#include <math.h>

#include "shared/exact.h"
#include "support/cmocka.h"
#include "support/simulation.h"

struct scene_fixture fixture;

void assert_near(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("%.9g instead of %.9g, allowed %g off", found, expected, allowed);
}

struct kiln_system *one_particle(float3 from, float3 velocity)
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "one", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {1, 1}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    float speed = float3_length(velocity);
    system->emit.speed = fixture_range(speed, speed);
    system->emit.origin = fixture_constant3(from.x, from.y, from.z);
    system->emit.direction = fixture_constant3(velocity.x, velocity.y, velocity.z);
    system->collide.enabled = true;
    return system;
}

struct kiln_particle after(uint32_t steps)
{
    fixture_finish(&fixture, steps);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, steps);
    struct kiln_particle p = simulation_records(&run)[0];
    assert_true(particle_is_alive(p));
    simulation_end(&run);
    return p;
}

struct kiln_system *throw_one(const double from[3], const double v[3])
{
    return one_particle(FLOAT3((float)from[0], (float)from[1], (float)from[2]),
                        FLOAT3((float)v[0], (float)v[1], (float)v[2]));
}

struct kiln_system *shoot(const double from[3], const double v[3])
{
    struct kiln_system *system = throw_one(from, v);
    system->collide.slowdown = fixture_constant(0.5f);
    return system;
}

struct kiln_system *rest_at(const double from[3])
{
    return one_particle(FLOAT3((float)from[0], (float)from[1], (float)from[2]),
                        FLOAT3(0, 0.0001f, 0));
}

void expect_mirror(const double from[3], const double v[3], const double normal[3], double time_s)
{
    struct kiln_particle p = after(30);
    float3 x = particle_position(p), u = particle_velocity(p);
    const double found_x[3] = {(double)x.x, (double)x.y, (double)x.z};
    const double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
    double across = v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2];
    for (int i = 0; i < 3; i++) {
        double mirrored = 0.5 * (v[i] - 2 * across * normal[i]);
        assert_near(found_v[i], mirrored, 2e-4);
        assert_near(found_x[i], from[i] + v[i] * time_s + mirrored * (0.5 - time_s), 5e-4);
    }
}

void a_crowd_around(uint32_t count, float speed, float gravity)
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "crowd", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {count, count}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    system->emit.shape = KILN_EMITTER_BOX;
    system->emit.origin = fixture_constant3(0.0f, 3.0f, 0.0f);
    system->emit.size = fixture_constant3(3.0f, 0.1f, 3.0f);
    system->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
    system->emit.angle = fixture_constant(0.7f);
    system->emit.speed = fixture_range(0.1f * speed, speed);
    system->collide.enabled = true;
    system->collide.randomness = fixture_constant(0.3f);
    system->collide.slowdown = fixture_constant(0.8f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -gravity, 0.0f);
    fixture_finish(&fixture, 60);
}

void no_bounce_makes_faster(float nearest)
{
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, 1);
    static float speeds[1000];
    uint32_t impacts = 0;
    for (int step = 0; step < 20; step++) {
        const struct kiln_particle *records = simulation_records(&run);
        assert_true(run.pool.slot_count <= 1000);
        for (uint32_t i = 0; i < run.pool.slot_count; i++) {
            const float speed = float3_length(particle_velocity(records[i]));
            assert_true(step == 0 || speed <= speeds[i] * 1.000001f);
            impacts += step > 0 && speed < 0.9f * speeds[i];
            speeds[i] = speed;
            assert_true(float3_length(particle_position(records[i])) > nearest);
        }
        simulation_run(&run, 1);
    }
    assert_true(impacts > 100);
    simulation_end(&run);
}

/* Returns the number of backdrop objects that contain a particle at a time, s. Returns 0 for a dead
 * particle. */
static uint32_t count_inside(const struct kiln_particle *p, float time_s, in_object *is_inside)
{
    const struct kiln_scene *scene = &fixture.scene;
    uint32_t count = 0;
    for (uint32_t j = 0; particle_is_alive(*p) && j < scene->backdrop.object_count; j++)
        count += is_inside(scene, &scene->backdrop.objects[j], particle_position(*p), time_s);
    return count;
}

void nobody_ends_inside(uint32_t steps, in_object *is_inside)
{
    const struct kiln_scene *scene = &fixture.scene;
    uint32_t met = 0;
    struct simulation run;
    simulation_start(&run, scene, NULL, 2);
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&run, 1);
        const float end_s = kiln_scene_time(scene, step);
        for (uint32_t i = 0; i < scene->system_count; i++) {
            const struct kiln_collide *collide = &scene->systems[i].collide;
            const struct kiln_pool_system *slots = &run.pool.systems[i];
            const bool swept = collide->enabled && collide->mode == KILN_COLLIDE_SWEPT;
            for (uint32_t k = slots->base; k < slots->base + slots->capacity; k++) {
                const uint32_t count = count_inside(&simulation_records(&run)[k], end_s, is_inside);
                assert_true(count == 0 || !swept);
                met += count;
            }
        }
    }
    assert_true(met > 100);
    simulation_end(&run);
}
