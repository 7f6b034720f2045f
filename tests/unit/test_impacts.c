/* Checks what an impact does to a particle: `collide.then` and its chance. If this fails, particles
 * stop at another place than where they hit, move on, or more or fewer of them stop than the scene
 * says. */
#include <math.h>
#include <string.h>

#include "shared/heading.h"
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

/* Checks that a vector is a particle's heading. Faces of impacts have normals of three times ten
 * bits, so it is right to 2e-3. */
static void expect_heading(struct kiln_particle p, float3 expected)
{
    const float3 heading = particle_heading(p);
    const float3 off = float3_sub(heading, expected);
    assert_true(particle_has_stopped(p));
    if (!(float3_length(off) < 2e-3f))
        fail_msg("heading %g, %g, %g instead of %g, %g, %g", (double)heading.x, (double)heading.y,
                 (double)heading.z, (double)expected.x, (double)expected.y, (double)expected.z);
}

/* Particles that are drawn on surfaces keep the normal of theirs instead of how they flew: that of
 * a ball, of which they cover the upper half, and of the floor. Their state is else as without. */
static void what_lies_keeps_its_normal(void **state)
{
    static const char ball_there[] =
        "backdrop.objects=[sphere: {center: [0.5, 0.3, 0], radius: 0.2 m}]";
    static const char *const as_they_fly[] = {ball_there, NULL};
    static const char *const lying[] = {ball_there, "systems.a.look.facing=surface", NULL};
    (void)state;
    struct kiln_particle before[COUNT];
    for (int lies = 0; lies < 2; lies++) {
        struct kiln_scene *scene = load_scene(SCENE, lies ? lying : as_they_fly);
        struct simulation run;
        simulation_start(&run, scene, NULL, 2);
        simulation_run(&run, 40);
        const struct kiln_particle *records = simulation_records(&run);
        int on_ball = 0;
        for (int i = 0; i < COUNT; i++) {
            const float3 place = particle_position(records[i]);
            const float3 out = float3_sub(place, FLOAT3(0.5f, 0.3f, 0.0f));
            const bool ball = float3_length(out) < 0.21f;
            on_ball += ball;
            if (lies) {
                expect_heading(records[i], ball ? float3_normalize(out, out) : FLOAT3(0, 1, 0));
                assert_memory_equal(&before[i].position_serial, &records[i].position_serial, 16);
                assert_int_equal(before[i].velocity_birth.x, records[i].velocity_birth.x);
            }
        }
        assert_in_range(on_ball, 100, COUNT - 100);
        memcpy(before, records, sizeof before);
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

/* Children of impacts without a speed rest on what their parent has met, whatever the forces are;
 * those with a speed fly, and so do all of those that are not drawn there. */
static void children_of_impacts_rest_from_birth(void **state)
{
    static const char *const children[] = {
        "systems.b={emit: {parent: {system: a, on: {bounce: 1}}, life: 9 s, speed: 0, inherit: 0}, "
        "forces: [gravity: [0, -8, 0]], look: {facing: surface}}",
        "systems.b={emit: {parent: {system: a, on: {bounce: 1}}, life: 9 s, speed: 1}, "
        "forces: [gravity: [0, -8, 0]], look: {facing: surface}}",
        "systems.b={emit: {parent: {system: a, on: {bounce: 1}}, life: 9 s, speed: 0, inherit: 0}, "
        "forces: [gravity: [0, -8, 0]]}"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct kiln_scene *scene;
        struct kiln_particle at_rest[COUNT];
        struct simulation run = start(children[i], &scene);
        simulation_run(&run, 33);
        const struct kiln_particle *records = simulation_records(&run) + COUNT;
        for (int k = 0; k < COUNT; k++) {
            assert_true(particle_is_alive(records[k]));
            assert_true(particle_has_stopped(records[k]) == (i == 0));
            if (i > 0)
                continue;
            expect_heading(records[k], FLOAT3(0, 1, 0));
            const float3 place = particle_position(records[k]);
            assert_true(place.y >= 0.0f && place.y < 0.002f);
            assert_true(particle_turned_s(records[k], 0.5f, 1.0f / 60) == 0.0f);
        }
        memcpy(at_rest, records, sizeof at_rest);
        simulation_run(&run, 10);
        records = simulation_records(&run) + COUNT;
        assert_true((memcmp(at_rest, records, sizeof at_rest) == 0) == (i == 0));
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_stop_where_they_hit),
        cmocka_unit_test(a_chance_is_that_of_an_impact),
        cmocka_unit_test(numbers_of_children_are_drawn),
        cmocka_unit_test(deaths_at_impacts_may_count),
        cmocka_unit_test(dies_is_another_way_to_write_it),
        cmocka_unit_test(what_lies_keeps_its_normal),
        cmocka_unit_test(children_of_impacts_rest_from_birth),
    };
    return cmocka_run_group_tests_name("impacts", tests, NULL, NULL);
}
