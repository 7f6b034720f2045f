/* Particles in the space of a node (shaders/shared/carry.h), against closed forms in the node's
 * frame. If this fails, particles are left behind by the node that they move with, or pass walls.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/motion.h"
#include "scene/scene.h"
#include "shared/derived.h"
#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

static const char *const integrations[] = {
    "simulation.integration=semi_implicit", "simulation.integration=position_first",
    "simulation.integration=trapezoid", "simulation.integration=rk4"};

/* Takes a vector from the world to the frame of a node, as one of 1 m. */
static void to_frame(const struct kiln_node_frame *frame, const double v[3], double y[3])
{
    const double *q = frame->turn;
    const double t[3] = {2 * (v[1] * q[2] - v[2] * q[1]), 2 * (v[2] * q[0] - v[0] * q[2]),
                         2 * (v[0] * q[1] - v[1] * q[0])};
    y[0] = v[0] + q[3] * t[0] + t[1] * q[2] - t[2] * q[1];
    y[1] = v[1] + q[3] * t[1] + t[2] * q[0] - t[0] * q[2];
    y[2] = v[2] + q[3] * t[2] + t[0] * q[1] - t[1] * q[0];
}

typedef void check_particle(const double place[3], const double velocity[3], double born_s,
                            double time_s);

/* Runs a scene of one system in the space of its first node, and calls a check with the place and
 * the velocity of each particle in that node's frame after each step. */
static void each_step(const char *text, const char *const *overrides, uint32_t steps,
                      check_particle *check)
{
    struct kiln_scene *scene = load_scene(text, overrides);
    struct simulation run;
    uint64_t alive = 0;
    simulation_start(&run, scene, NULL, 2);
    const struct kiln_derived_params derived = kiln_scene_derived(scene, 0);
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&run, 1);
        const float time_s = kiln_scene_time(scene, step);
        const struct kiln_node_frame frame = kiln_node_frame_at(scene, 0, time_s, time_s);
        const struct kiln_particle *records = simulation_records(&run);
        for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++) {
            if (!particle_is_alive(records[i]))
                continue;
            const float3 p = particle_position(records[i]), v = particle_velocity(records[i]);
            const double way[3] = {(double)p.x - frame.at[0], (double)p.y - frame.at[1],
                                   (double)p.z - frame.at[2]};
            const double speed[3] = {(double)v.x, (double)v.y, (double)v.z};
            double place[3], velocity[3];
            to_frame(&frame, way, place);
            to_frame(&frame, speed, velocity);
            check(place, velocity, (double)particle_birth_time(derived, records[i]),
                  (double)time_s);
        }
    }
    simulation_hash(&run, &alive);
    assert_true(alive > 100);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

static void expect_near(const char *what, double time_s, const double found[3], double x, double y,
                        double z, double limit)
{
    const double off = hypot(hypot(found[0] - x, found[1] - y), found[2] - z);
    if (!(off <= limit))
        fail_msg("%s at %g s: [%.9g, %.9g, %.9g], not [%.9g, %.9g, %.9g]", what, time_s, found[0],
                 found[1], found[2], x, y, z);
}

/* A node that turns about two axes while it flies along a path. */
#define FLYING                                                                                     \
    "kiln: 1\noutput: {frames: 600, fps: 60}\n"                                                    \
    "nodes:\n"                                                                                     \
    "  ship: {rotation: {keys: {0 s: [0, 0, 0], 10 s: [400 deg, 3600 deg, 0]}},\n"                 \
    "         position: {path: {points: [[0, 1, 0], [4, 2, 1], [6, 0.5, 0], [2, 1, -4]], over: "   \
    "[0 s, 10 s], ease: smooth}}}\n"

static void check_rest(const double place[3], const double velocity[3], double born_s,
                       double time_s)
{
    (void)born_s;
    expect_near("place", time_s, place, 1, 0.5, -0.25, 5e-5);
    assert_true(velocity[0] == 0 && velocity[1] == 0 && velocity[2] == 0);
}

static void what_rests_stays_at_its_place_in_the_node(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
        each_step(FLYING
                  "systems: {a: {space: ship, emit: {attach: ship, rate: 40, speed: 0, life: "
                  "9 s, from: {point: {origin: [1, 0.5, -0.25]}}}, forces: [drag: 3]}}\n",
                  (const char *const[]){integrations[i], NULL}, i == 0 ? 600 : 240, check_rest);
}

static void check_wheel(const double place[3], const double velocity[3], double born_s,
                        double time_s)
{
    (void)born_s;
    expect_near("place", time_s, place, 0.7, 0.5, -0.25, 1e-5);
    assert_true(velocity[0] == 0 && velocity[1] == 0 && velocity[2] == 0);
}

/* Ten turns about two axes, in 600 steps. */
static void what_rests_in_a_wheel_turns_with_it(void **state)
{
    (void)state;
    each_step("kiln: 1\noutput: {frames: 600, fps: 60}\n"
              "nodes: {wheel: {rotation: {keys: {0 s: [0, 0, 0], 10 s: [400 deg, 3600 deg, 0]}}}}\n"
              "systems: {a: {space: wheel, emit: {attach: wheel, rate: 40, speed: 0, life: 10 s,\n"
              "  from: {point: {origin: [0.7, 0.5, -0.25]}}}}}\n",
              NULL, 600, check_wheel);
}

static void check_flight(const double place[3], const double velocity[3], double born_s,
                         double time_s)
{
    expect_near("place", time_s, place, 0, 0.5, 2 * (time_s - born_s), 1e-4);
    expect_near("velocity", time_s, velocity, 0, 0, 2, 1e-4);
}

static void what_flies_goes_straight_on_in_the_node(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
        each_step(FLYING
                  "systems: {a: {space: ship, emit: {attach: ship, rate: 80, speed: 2, life: "
                  "4 s, from: {point: {origin: [0, 0.5, 0], direction: [0, 0, 1]}}}}}\n",
                  (const char *const[]){integrations[i], NULL}, 240, check_flight);
}

/* Drag slows what moves within the node, and not what moves with it. */
static void check_drag(const double place[3], const double velocity[3], double born_s,
                       double time_s)
{
    const double age_s = time_s - born_s;
    expect_near("velocity", time_s, velocity, 2 * exp(-0.5 * age_s), 0, 0, 2e-2);
    expect_near("place", time_s, place, 4 * (1 - exp(-0.5 * age_s)), 0, 0, 4e-2);
}

static void drag_is_that_within_the_node(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
        each_step(FLYING
                  "systems: {a: {space: ship, emit: {attach: ship, rate: 80, speed: 2, life: "
                  "4 s, from: {point: {direction: [1, 0, 0]}}}, forces: [drag: 0.5]}}\n",
                  (const char *const[]){integrations[i], NULL}, 240, check_drag);
}

static void check_jump(const double place[3], const double velocity[3], double born_s,
                       double time_s)
{
    (void)velocity;
    (void)born_s;
    expect_near("place", time_s, place, 0, 1, 0, 2e-5);
}

static void a_node_that_jumps_takes_its_particles_along(void **state)
{
    (void)state;
    each_step(
        "kiln: 1\noutput: {frames: 60, fps: 60}\n"
        "nodes: {a: {position: {keys: {0 s: [0, 0, 0], 0.505 s: [6, 1, 0]}, ease: step},\n"
        "            rotation: {keys: {0 s: [0, 0, 0], 0.505 s: [0, 0, 90 deg]}, ease: step}}}\n"
        "systems: {s: {space: a, emit: {attach: a, rate: 900, speed: 0, life: 9 s, from: "
        "{point: {origin: [0, 1, 0]}}}}}\n",
        NULL, 60, check_jump);
}

/* ---- walls ----------------------------------------------------------------------------------- */

/* The node comes at 3 m/s to a wall at x = 2 that does not move. What hits it bounces as at 3 m/s,
 * and then moves on in the world. */
static void check_wall(const double place[3], const double velocity[3], double born_s,
                       double time_s)
{
    const double x = 3 * time_s + place[0], hit_s = 2.0 / 3;
    (void)born_s;
    assert_true(x <= 2.0001);
    if (time_s < hit_s - 0.02) {
        expect_near("before", time_s, place, 0, 0, 0, 1e-5);
    } else if (time_s > hit_s + 0.04) {
        expect_near("velocity", time_s, velocity, -4.5, 0, 0, 1e-4);
        if (!(fabs(x - (2 - 1.5 * (time_s - hit_s))) < 2e-3))
            fail_msg("at %g s at %g m", time_s, x);
    }
}

static void a_wall_that_stands_is_met_on_the_way(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\noutput: {frames: 60, fps: 60}\n"
        "nodes: {car: {position: {keys: {0 s: [0, 0, 0], 2 s: [6, 0, 0]}}}}\n"
        "backdrop: {floor: none, objects: [{box: {center: [3, 0, 0], size: [2, 4, 4], collide: "
        "true}}]}\n"
        "systems: {s: {space: car, emit: {attach: car, bursts: {0 s: 200}, speed: 0, life: 9 s},\n"
        "  collide: {restitution: 0.5, slowdown: 1, randomness: 0}}}\n";
    for (int i = 0; i < 4; i++) {
        each_step(text, (const char *const[]){integrations[i], NULL}, 58, check_wall);
        each_step(text,
                  (const char *const[]){integrations[i], "systems.s.collide.then=bounce", NULL}, 50,
                  check_wall);
    }
}

/* The node turns by 1 rad/s about z and takes what rests at [1, 0, 0] up to a wall at y = 0.5 that
 * stands. There it comes with the velocity of the circle, of which y bounces by a half; then it
 * moves straight on in the node. */
static void check_turned_wall(const double place[3], const double velocity[3], double born_s,
                              double time_s)
{
    const double hit = acos(-1) / 6, left_s = time_s - hit;
    const double world_y = place[0] * sin(time_s) + place[1] * cos(time_s);
    const double lost = 1.5 * cos(hit), x = -lost * sin(hit), y = -lost * cos(hit);
    (void)born_s;
    assert_true(world_y <= 0.50001);
    if (left_s < -0.001) {
        expect_near("before", time_s, place, 1, 0, 0, 1e-5);
    } else if (left_s > 0.02) {
        expect_near("velocity", time_s, velocity, x, y, 0, 0.02);
        expect_near("after", time_s, place, 1 + left_s * x, left_s * y, 0, 1e-3 + 0.02 * left_s);
    }
}

static void a_node_that_turns_takes_particles_against_a_wall(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
        each_step(
            "kiln: 1\noutput: {frames: 60, fps: 60}\n"
            "nodes: {wheel: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 0, 57.29577951308232 "
            "deg]}}}}\n"
            "backdrop: {floor: none, objects: [{box: {center: [0, 1, 0], size: [4, 1, 4], "
            "collide: true}}]}\n"
            "systems: {s: {space: wheel, emit: {attach: wheel, bursts: {0 s: 200}, speed: 0,\n"
            "  life: 9 s, from: {point: {origin: [1, 0, 0]}}}, collide: {restitution: "
            "0.5, slowdown: 1, randomness: 0}}}\n",
            (const char *const[]){integrations[i], NULL}, 56, check_turned_wall);
}

/* What is thrown at a wall of the node itself bounces as if nothing moved. */
static void check_inside(const double place[3], const double velocity[3], double born_s,
                         double time_s)
{
    const double age_s = time_s - born_s, hit_s = 0.5;
    if (age_s < hit_s - 0.02) {
        expect_near("before", time_s, place, 0, 0, 2 * age_s, 1e-3);
    } else if (age_s > hit_s + 0.02) {
        expect_near("velocity", time_s, velocity, 0, 0, -1, 0.15);
        expect_near("after", time_s, place, 0, 0, 1 - (age_s - hit_s), 0.05);
    }
}

static void a_wall_of_the_node_is_met_as_at_rest(void **state)
{
    (void)state;
    each_step("kiln: 1\noutput: {frames: 120, fps: 60}\n"
              "nodes: {car: {position: {keys: {0 s: [0, 0, 0], 2 s: [8, 2, 0]}},\n"
              "             rotation: {keys: {0 s: [0, 0, 0], 2 s: [0, 90 deg, 0]}}}}\n"
              "backdrop: {floor: none, objects: [{box: {attach: car, center: [0, 0, 1.5], size: "
              "[4, 4, 1], collide: true}}]}\n"
              "systems: {s: {space: car, emit: {attach: car, rate: 200, speed: 2, life: 1.2 s,\n"
              "  from: {point: {direction: [0, 0, 1]}}}, collide: {restitution: 0.5, slowdown: 1, "
              "randomness: 0}}}\n",
              NULL, 110, check_inside);
}

/* ---- scenes ---------------------------------------------------------------------------------- */

static void a_space_belongs_to_the_motion(void **state)
{
    (void)state;
    static const char text[] = "kiln: 1\nnodes: {a: {}, b: {parent: a}}\n"
                               "systems: {s: {space: b, emit: {rate: 1}}}\n";
    static const char *const changes[] = {NULL, "systems.s.space=none", "systems.s.space=a",
                                          "nodes.a.position=[1, 0, 0]"};
    char hashes[4][65];
    for (int i = 0; i < 4; i++) {
        struct kiln_error error = {0};
        struct kiln_scene *scene = load_scene(text, (const char *const[]){changes[i], NULL});
        assert_true(kiln_scene_part_hash(scene, KILN_PART_MOTION, hashes[i], &error));
        char *printed = print_scene(scene);
        struct kiln_scene *again = load_scene(printed, NULL);
        assert_string_equal(scene->hash, again->hash);
        free(printed);
        kiln_scene_destroy(&again);
        kiln_scene_destroy(&scene);
        for (int k = 0; k < i; k++)
            assert_string_not_equal(hashes[k], hashes[i]);
    }
}

static const struct bad spaces[] = {
    {"kiln: 1\n"
     "nodes: {car: {}}\n"
     "systems: {s: {space: cart}}\n",
     ":3:22: systems.s.space: unknown node 'cart' (did you mean 'car'?)"},
};

BAD_TEST(spaces)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_rests_stays_at_its_place_in_the_node),
        cmocka_unit_test(what_rests_in_a_wheel_turns_with_it),
        cmocka_unit_test(what_flies_goes_straight_on_in_the_node),
        cmocka_unit_test(drag_is_that_within_the_node),
        cmocka_unit_test(a_node_that_jumps_takes_its_particles_along),
        cmocka_unit_test(a_wall_that_stands_is_met_on_the_way),
        cmocka_unit_test(a_node_that_turns_takes_particles_against_a_wall),
        cmocka_unit_test(a_wall_of_the_node_is_met_as_at_rest),
        cmocka_unit_test(a_space_belongs_to_the_motion),
        cmocka_unit_test(bad_spaces),
    };
    return cmocka_run_group_tests_name("space", tests, NULL, NULL);
}
