/* Births of emitters whose nodes jump, or turn more than half a turn in a step, are compared with
 * closed forms. If this fails, particles are thrown by a jump that no node has flown. */
#include <math.h>
#include <string.h>

#include "scene/scene.h"
#include "shared/derived.h"
#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

static const double PI = 3.14159265358979324;

/* A birth: place, velocity, and when, s. */
struct birth {
    double at[3], velocity[3], born_s;
};

/* Runs a scene of nodes at 60 steps a second and calls a check with each birth of an emitter with
 * some keys. */
static void each_birth(const char *nodes, const char *emit,
                       void (*check)(const struct birth *birth))
{
    char text[2048];
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\nnodes:\n%s"
             "systems: {s: {emit: {rate: 6000, life: 9 s, speed: 0, %s}}}\n",
             nodes, emit);
    struct kiln_scene *scene = load_scene(text, NULL);
    struct simulation run;
    simulation_start(&run, scene, NULL, 2);
    simulation_run(&run, 40);
    const struct kiln_particle *records = simulation_records(&run);
    const struct kiln_derived_params derived = kiln_scene_derived(scene, 0);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++) {
        if (!particle_is_alive(records[i]))
            continue;
        const double born_s = (double)particle_birth_time(derived, records[i]);
        const float3 v = particle_velocity(records[i]);
        const float3 p =
            float3_add_scaled(particle_position(records[i]), v, -(float)(40 / 60.0 - born_s));
        const struct birth birth = {{(double)p.x, (double)p.y, (double)p.z},
                                    {(double)v.x, (double)v.y, (double)v.z},
                                    born_s};
        check(&birth);
        seen++;
    }
    assert_true(seen > 3900);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

static void expect(const struct birth *birth, double x, double y, double z, double vx, double vy,
                   double vz, double place_limit, double speed_limit)
{
    const double *p = birth->at, *v = birth->velocity;
    const double place = hypot(hypot(p[0] - x, p[1] - y), p[2] - z);
    const double speed = hypot(hypot(v[0] - vx, v[1] - vy), v[2] - vz);
    if (!(place <= place_limit && speed <= speed_limit))
        fail_msg("born at %g s at [%.7g, %.7g, %.7g] with [%.7g, %.7g, %.7g] m/s, not at [%.7g, "
                 "%.7g, %.7g] with [%.7g, %.7g, %.7g] m/s",
                 birth->born_s, p[0], p[1], p[2], v[0], v[1], v[2], x, y, z, vx, vy, vz);
}

/* Whether a birth is after a jump at 0.5 s, which is the end of a step. */
static bool is_after(const struct birth *birth)
{
    return birth->born_s >= 0.5;
}

static void check_turned(const struct birth *birth)
{
    const double angle = is_after(birth) ? 2 * PI / 3 : 0;
    expect(birth, sin(angle), 0, cos(angle), 0, 0, 0, 1e-6, 0);
}

static void check_scaled(const struct birth *birth)
{
    expect(birth, 0, 0, is_after(birth) ? 3 : 1, 0, 0, 0, 1e-6, 0);
}

static void check_turned_back(const struct birth *birth)
{
    const double t = birth->born_s, ahead = is_after(birth) ? -1 : 1;
    const double x = is_after(birth) ? 2 - 2 * t : 2 * t;
    /* at the point of the path, the node stops within the cubics of two steps */
    const bool is_near = fabs(t - 0.5) < 1.01 / 60;
    expect(birth, x + 0.5 * ahead, 0.5, 0, 2 * ahead, 0, 0, is_near ? 0.01 : 2e-3,
           is_near ? 4.01 : 1e-2);
}

static void jumps_of_rotation_and_scale_throw_nothing(void **state)
{
    (void)state;
    each_birth("  a: {rotation: {keys: {0 s: [0, 0, 0], 0.5 s: [0, 120 deg, 0]}, ease: step}}\n",
               "attach: a, inherit: 1, from: {point: {origin: [0, 0, 1]}}", check_turned);
    each_birth("  a: {scale: {keys: {0 s: 1, 0.5 s: 3}, ease: step}}\n",
               "attach: a, inherit: 1, from: {point: {origin: [0, 0, 1]}}", check_scaled);
    each_birth("  a: {position: {path: {points: [[0, 0, 0], [1, 0, 0], [0, 0, 0]], over: [0 s, 1 "
               "s]}}, heading: path}\n",
               "attach: a, inherit: 1, from: {point: {origin: [0, 0.5, 0.5]}}", check_turned_back);
}

static void check_barrel(const struct birth *birth)
{
    expect(birth, is_after(birth) ? 0.8 : -0.8, 0, 60 * birth->born_s, 0, 0, 60, 1e-4, 1e-3);
}

static void check_hub(const struct birth *birth)
{
    const double t = birth->born_s, angle = 4 * PI * t, x = is_after(birth) ? 0.2 : -0.2;
    expect(birth, x * cos(angle), 0, -x * sin(angle), -x * 4 * PI * sin(angle), 0,
           -x * 4 * PI * cos(angle), 1e-4, 2e-2);
}

static void jumps_on_a_parent_that_moves_are_seen(void **state)
{
    (void)state;
    each_birth("  ship: {position: {path: {points: [[0, 0, 0], [0, 0, 60]], over: [0 s, 1 s]}}}\n"
               "  barrel: {parent: ship, position: {keys: {0 s: [-0.8, 0, 0], 0.5 s: [0.8, 0, 0]}, "
               "ease: step}}\n",
               "attach: barrel, inherit: 1", check_barrel);
    each_birth("  hub: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 720 deg, 0]}}}\n"
               "  tip: {parent: hub, position: {keys: {0 s: [-0.2, 0, 0], 0.5 s: [0.2, 0, 0]}, "
               "ease: step}}\n",
               "attach: tip, inherit: 1", check_hub);
}

/* Turns about y by so many degrees a step. */
static double degrees;

static void check_propeller(const struct birth *birth)
{
    const double rate = degrees * 60 * PI / 180, angle = rate * birth->born_s;
    expect(birth, sin(angle), 0, cos(angle), rate * cos(angle), 0, -rate * sin(angle), 1e-3,
           2e-3 * fabs(rate));
}

static void fast_spins_go_the_way_that_they_turn(void **state)
{
    (void)state;
    static const double speeds[] = {100, 170, 190, 270,  359.99, 360,
                                    361, 540, 725, -100, -270,   -360};
    for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
        char nodes[256];
        degrees = speeds[i];
        snprintf(
            nodes, sizeof nodes,
            "  a: {rotation: {keys: {0 s: [0, 0, 0], %.9g s: [0, %d deg, 0]}, repeat: loop}}\n",
            60 / fabs(degrees), degrees > 0 ? 3600 : -3600);
        each_birth(nodes, "attach: a, inherit: 1, from: {point: {origin: [0, 0, 1]}}",
                   check_propeller);
    }
}

/* ---- objects --------------------------------------------------------------------------------- */

/* Runs particles that rest between two places of a sphere; returns the state after its jump. */
static struct kiln_state_hash hash_after_jump(const char *nodes, const char *sphere,
                                              uint32_t *moved)
{
    char text[1024];
    uint64_t alive;
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n%s"
             "backdrop: {objects: [sphere: {radius: 0.5 m, %s}]}\n"
             "systems: {s: {emit: {bursts: {0 s: 100}, life: 9 s, speed: 0, from: {box: {origin: "
             "[0, 1, 0], size: [1, 1, 1]}}}, collide: {}}}\n",
             nodes, sphere);
    struct kiln_scene *scene = load_scene(text, NULL);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 40);
    const struct kiln_state_hash hash = simulation_hash(&run, &alive);
    const struct kiln_particle *records = simulation_records(&run);
    *moved = 0;
    for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++)
        *moved += particle_is_alive(records[i]) && particle_velocity(records[i]).x > 1;
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return hash;
}

static void objects_that_jump_sweep_as_those_without_nodes(void **state)
{
    (void)state;
    uint32_t by_node, by_hand;
    const struct kiln_state_hash node = hash_after_jump(
        "nodes: {a: {position: {keys: {0 s: [-5, 1, 0], 0.5 s: [5, 1, 0]}, ease: step}}}\n",
        "attach: a, center: [0, 0, 0]", &by_node);
    const struct kiln_state_hash hand = hash_after_jump(
        "", "center: {keys: {0 s: [-5, 1, 0], 0.5 s: [5, 1, 0]}, ease: step}", &by_hand);
    assert_memory_equal(&node, &hand, sizeof node);
    assert_true(by_node > 50 && by_node == by_hand);
}

/* ---- warnings -------------------------------------------------------------------------------- */

static void keep_warning(void *user, enum kiln_log_level level, const char *line)
{
    char *text = user;
    assert_int_equal(level, KILN_LOG_WARNING);
    assert_int_equal(text[0], '\0');
    snprintf(text, KILN_MESSAGE_SIZE, "%s", line);
}

/* A tip of 1 m on a node that turns by `degrees` in each step of a 60th of a second. */
static void expect_warning(const char *tip, double speed, const char *wanted)
{
    char text[1024], warning[KILN_MESSAGE_SIZE] = "";
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    params.log = (struct kiln_log){keep_warning, warning};
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n"
             "nodes:\n"
             "  hub: {rotation: {keys: {0 s: [0, 0, 0], 0.1 s: [0, %.9g deg, 0]}, repeat: loop}}\n"
             "  tip: {parent: hub, %s}\n"
             "systems: {s: {emit: {rate: 60, attach: tip}}}\n",
             6 * speed, tip);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    assert_string_equal(warning, wanted);
    kiln_scene_destroy(&scene);
}

static void arms_that_turn_fast_have_a_warning(void **state)
{
    (void)state;
    expect_warning("position: [0, 0, 1]", 90, "");
    expect_warning("position: [0, 0, 0]", 270, "");
    expect_warning("position: [0, 0, 1]", 180,
                   "test.yaml:6:40: systems.s.emit.attach: the node goes round 'hub', which turns "
                   "by up to 180 deg in a step, so that births between two steps are up to 21 % of "
                   "its distance beside the circle: let simulation.rate be 120 or more");
    expect_warning(
        "position: [0, {keys: {0 s: 0, 1 s: 1}}, 0]", 100,
        "test.yaml:6:40: systems.s.emit.attach: the node goes round 'hub', which turns "
        "by up to 100 deg in a step, so that births between two steps are up to 2.3 % of "
        "its distance beside the circle: let simulation.rate be 120 or more");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jumps_of_rotation_and_scale_throw_nothing),
        cmocka_unit_test(jumps_on_a_parent_that_moves_are_seen),
        cmocka_unit_test(fast_spins_go_the_way_that_they_turn),
        cmocka_unit_test(objects_that_jump_sweep_as_those_without_nodes),
        cmocka_unit_test(arms_that_turn_fast_have_a_warning),
    };
    return cmocka_run_group_tests_name("node_jumps", tests, NULL, NULL);
}
