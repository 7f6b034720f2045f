/* Checks what an impact does to a particle: `collide.then` and its chance. If this fails, particles
 * stop at another place than where they hit, move on, or more or fewer of them stop than the scene
 * says. */
#include <math.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* 900 particles that fall from 1 m onto a floor, each with its own speed along it, and a child each
 * that is born when they die. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {fps: 60, frames: 200}\n"
    "backdrop: {floor: {height: 0 m}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {bursts: {0 s: 900}, life: 1.5 s, speed: [0.5, 2], from: {point: {origin: [0, 1, "
    "0],\n"
    "           direction: [1, 0, 0]}}}\n"
    "    forces: [gravity: [0, -8, 0]]\n"
    "    collide: {then: stop, slowdown: 1}\n"
    "  b:\n"
    "    emit: {parent: {system: a, on: {death: 1}}, life: 9 s, speed: 0}\n";

enum { COUNT = 900 };

static struct simulation start(const char *override, struct kiln_scene **scene)
{
    const char *const overrides[] = {override, NULL};
    struct simulation run;
    *scene = load_scene(SCENE, override ? overrides : NULL);
    simulation_start(&run, *scene, NULL, 2);
    return run;
}

static uint32_t count_stopped(struct simulation *run)
{
    uint32_t stopped = 0;
    for (int i = 0; i < COUNT; i++)
        stopped += (simulation_records(run)[i].velocity_birth.w & KILN_PARTICLE_STOPPED) != 0;
    return stopped;
}

/* The fall from 1 m takes half a second, so all lie on the floor at half their speed. */
static void they_stop_where_they_hit(void **state)
{
    static const char *const orders[] = {"simulation.integration=semi_implicit",
                                         "simulation.integration=rk4"};
    (void)state;
    for (int order = 0; order < 2; order++) {
        struct kiln_scene *scene;
        struct kiln_particle before[COUNT], at_rest[COUNT];
        struct simulation run = start(orders[order], &scene);
        simulation_run(&run, 28);
        memcpy(before, simulation_records(&run), sizeof before);
        assert_int_equal(count_stopped(&run), 0);
        simulation_run(&run, 5);
        memcpy(at_rest, simulation_records(&run), sizeof at_rest);
        assert_int_equal(count_stopped(&run), COUNT);
        for (int i = 0; i < COUNT; i++) {
            const float3 place = particle_position(at_rest[i]), v = particle_velocity(at_rest[i]);
            const double speed = (double)particle_velocity(before[i]).x;
            assert_true(v.x == 0.0f && v.y == 0.0f && v.z == 0.0f);
            assert_true(place.y >= 0.0f && place.y < 0.002f);
            /* semi-implicit steps fall a little faster: 1 m is 8/2 (t^2 + t dt) */
            const double fall_s = order == 1 ? 0.5 : sqrt(0.25 + 1.0 / 120 / 120) - 1.0 / 120;
            assert_true(fabs((double)place.x - speed * fall_s) < 0.002 * speed + 1e-4);
        }
        simulation_run(&run, 50); /* they stay there, to the bit */
        assert_memory_equal(at_rest, simulation_records(&run), sizeof at_rest);
        simulation_run(&run, 10); /* and die at 1.5 s, where their children are born */
        const struct kiln_particle *children = simulation_records(&run) + COUNT;
        assert_int_equal(count_stopped(&run), 0);
        for (int i = 0; i < COUNT; i++) {
            assert_true(particle_is_alive(children[i]));
            assert_true(particle_position(children[i]).x == particle_position(at_rest[i]).x);
        }
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

/* A share of particles stops at the first impact; the others bounce to 1 m and stop later. */
static void a_chance_is_that_of_an_impact(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    struct simulation run = start("systems.a.collide.chance=0.3", &scene);
    simulation_run(&run, 40);
    /* 270, with a standard deviation of 14 */
    assert_in_range(count_stopped(&run), 220, 320);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    run = start("systems.a.collide.chance=0", &scene);
    simulation_run(&run, 80);
    assert_int_equal(count_stopped(&run), 0);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* `then: die` is what `dies: true` does. */
static void dies_is_another_way_to_write_it(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    struct simulation run = start("systems.a.collide={then: die, slowdown: 1}", &scene);
    const struct kiln_state_hash then = simulation_run_hashed(&run, 40);
    uint64_t alive;
    simulation_hash(&run, &alive);
    assert_int_equal(alive, 0);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    run = start("systems.a.collide={dies: true, slowdown: 1}", &scene);
    const struct kiln_state_hash dies = simulation_run_hashed(&run, 40);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    assert_true(then.lane[0] == dies.lane[0] && then.lane[1] == dies.lane[1]);
}

/* Deaths at impacts have children where the impact was, if the scene says so. */
static void deaths_at_impacts_may_count(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    uint64_t alive;
    struct simulation run = start("systems.a.collide={then: die, slowdown: 1}", &scene);
    simulation_run(&run, 40);
    simulation_hash(&run, &alive);
    assert_int_equal(alive, 0);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    run =
        start("systems={a: {emit: {bursts: {0 s: 900}, life: 1.5 s, speed: [0.5, 2], from: {point: "
              "{origin: [0, 1, 0], direction: [1, 0, 0]}}}, forces: [gravity: [0, -8, 0]], "
              "collide: {then: die, slowdown: 1}}, b: {emit: {parent: {system: a, on: {death: "
              "{count: 1, impact: true}}}, life: 9 s, speed: 0}}}",
              &scene);
    simulation_run(&run, 40);
    simulation_hash(&run, &alive);
    assert_int_equal(alive, COUNT);
    for (int i = 0; i < COUNT; i++) {
        const float3 place = particle_position(simulation_records(&run)[COUNT + i]);
        assert_true(place.y >= 0.0f && place.y < 0.002f && place.x > 0.24f);
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* Each parent draws how many children it has; a second system draws others. */
static void numbers_of_children_are_drawn(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    uint32_t seen[4] = {0};
    struct simulation run = start("systems.b.emit.parent.on={death: [2, 5]}", &scene);
    simulation_run(&run, 100);
    const struct kiln_particle *children = simulation_records(&run) + COUNT;
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t count = 0;
        while (count < 5 && particle_is_alive(children[i * 5 + count]))
            count++;
        for (uint32_t k = count; k < 5; k++)
            assert_false(particle_is_alive(children[i * 5 + k]));
        assert_in_range(count, 2, 5);
        seen[count - 2]++;
    }
    for (int i = 0; i < 4; i++)
        assert_in_range(seen[i], 225 - 50, 225 + 50); /* four standard deviations are 52 */
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_stop_where_they_hit),
        cmocka_unit_test(a_chance_is_that_of_an_impact),
        cmocka_unit_test(numbers_of_children_are_drawn),
        cmocka_unit_test(deaths_at_impacts_may_count),
        cmocka_unit_test(dies_is_another_way_to_write_it),
    };
    return cmocka_run_group_tests_name("impacts", tests, NULL, NULL);
}
