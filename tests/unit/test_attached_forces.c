/* Forces, their regions and demitters that lie in nodes act as those that are written in the world
 * do. If this fails, a force that is attached to a node acts elsewhere, or in another direction. */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* Loads a scene that may name files of the tree. */
static struct kiln_scene *load(const char *text)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = KILN_SOURCE_DIR;
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), SCENE_NAME, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* Runs a scene with a force for 60 steps. */
static void run_force(const char *nodes, const char *force, struct kiln_scene **scene,
                      struct simulation *run)
{
    char text[1024];
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n%s"
             "systems: {a: {emit: {rate: 900, life: 9 s, from: {box: {size: [3, 3, 3]}}}, forces: "
             "[%s]}}\n",
             nodes, force);
    *scene = load(text);
    simulation_start(run, *scene, NULL, 1);
    simulation_run(run, 60);
}

/* Returns how far particles are from each other, at most, m. */
static double farthest(const char *nodes, const char *attached, const char *by_hand)
{
    struct kiln_scene *scenes[2];
    struct simulation runs[2];
    double most = 0;
    uint32_t seen = 0;
    run_force(nodes, attached, &scenes[0], &runs[0]);
    run_force("", by_hand, &scenes[1], &runs[1]);
    const struct kiln_particle *a = simulation_records(&runs[0]), *b = simulation_records(&runs[1]);
    for (uint32_t i = 0; i < runs[0].pool.systems[0].capacity; i++) {
        if (!particle_is_alive(a[i]))
            continue;
        const float3 way = float3_sub(particle_position(a[i]), particle_position(b[i]));
        const double distance = (double)float3_length(way);
        most = distance > most ? distance : most;
        seen++;
    }
    assert_true(seen > 800);
    for (int i = 0; i < 2; i++) {
        simulation_end(&runs[i]);
        kiln_scene_destroy(&scenes[i]);
    }
    return most;
}

static void attractors_act_where_their_node_is(void **state)
{
    (void)state;
    static const char nodes[] =
        "nodes: {a: {position: {keys: {0 s: [0, 1, 0], 1 s: [1, 1, 0]}}, scale: 2}}\n";
    static const char by_hand[] =
        "attract: {position: {keys: {0 s: [0, 2, 0], 1 s: [1, 2, 0]}}, strength: 3, radius: 0.6 m}";
    assert_true(farthest(nodes,
                         "attract: {attach: a, position: [0, 0.5, 0], strength: 3, radius: "
                         "0.3 m}",
                         by_hand) < 1e-4);
    assert_true(farthest(nodes, "attract: {position: [0, 0.5, 0], strength: 3, radius: 0.3 m}",
                         by_hand) > 0.1);
}

static void vortices_turn_with_their_node(void **state)
{
    (void)state;
    static const char nodes[] = "nodes: {a: {position: [0.5, 0, 0], rotation: {keys: {0 s: [0, 0, "
                                "0], 1 s: [0, 0, 90 deg]}}}}\n";
    /* the axis turns from y to -x; a table of its directions is near enough for short pieces */
    static const char by_hand[] =
        "vortex: {position: [0.5, 0, 0], pull: 3, axis: {keys: {0 s: [0, 1, 0], 0.25 s: [-0.38268, "
        "0.92388, 0], 0.5 s: [-0.70711, 0.70711, 0], 0.75 s: [-0.92388, 0.38268, 0], 1 s: [-1, 0, "
        "0]}}}";
    assert_true(farthest(nodes, "vortex: {attach: a, pull: 3}", by_hand) < 0.02);
    assert_true(farthest(nodes, "vortex: {pull: 3}", by_hand) > 0.2);
}

/* A node that stands, and turns everything. */
#define TURNED                                                                                     \
    "nodes: {a: {position: [1, 2, 3], rotation: [30 deg, 50 deg, 70 deg]}, b: {parent: a}}\n"

/* Runs forces on particles that are born in a node or in the world, for 60 steps. */
static void run_in(bool node, const char *attach, const char *forces, struct kiln_scene **scene,
                   struct simulation *run)
{
    char text[2048], filled[1536];
    const char *from = forces;
    size_t length = 0;
    for (; *from; from++) { /* each @ becomes the key, or nothing */
        if (*from == '@')
            length += (size_t)snprintf(filled + length, sizeof filled - length, "%s", attach);
        else
            filled[length++] = *from;
    }
    filled[length] = '\0';
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n" TURNED
             "systems: {s: {emit: {%srate: 900, life: [0.5 s, 2 s], speed: [0, 1],\n"
             "  from: {box: {size: [3, 3, 3], angle: 90 deg}}},\n  %s}}\n",
             node ? "attach: b, " : "", filled);
    *scene = load(text);
    simulation_start(run, *scene, NULL, 1);
    simulation_run(run, 60);
}

/* Returns how far particles in a node are from where those in the world are, turned. */
static double farthest_turned(const char *attach, const char *forces)
{
    struct kiln_scene *scenes[2];
    struct simulation runs[2];
    double most = 0;
    uint32_t seen = 0;
    run_in(true, attach, forces, &scenes[0], &runs[0]);
    run_in(false, "", forces, &scenes[1], &runs[1]);
    const struct kiln_particle *a = simulation_records(&runs[0]), *b = simulation_records(&runs[1]);
    const struct kiln_attach in = {.name = "a", .node = 0};
    for (uint32_t i = 0; i < runs[0].pool.systems[0].capacity; i++) {
        const float3 other = particle_position(b[i]);
        const float3 turned = kiln_attached_point(scenes[0], &in, other, 0.0f);
        const float3 way = float3_sub(particle_position(a[i]), turned);
        const double distance = (double)float3_length(way);
        if (particle_is_alive(a[i]) != particle_is_alive(b[i]))
            fail_msg("%s: a particle lives at one place and not at the other", forces);
        if (!particle_is_alive(a[i]))
            continue;
        most = distance > most ? distance : most;
        seen++;
    }
    assert_true(seen > 200);
    for (int i = 0; i < 2; i++) {
        simulation_end(&runs[i]);
        kiln_scene_destroy(&scenes[i]);
    }
    return most;
}

/* What lies in a node with its emitter moves as without the node. */
static void all_forces_turn_with_their_node(void **state)
{
    (void)state;
    static const char *const forces[] = {
        "forces: [gravity: {@acceleration: [1, -3, 0]}]",
        "forces: [gravity: {@acceleration: {life: [[1, -3, 0], [0, 2, 2]]}}]",
        "forces: [wind: {@velocity: [1, 2, 0.5], pull: 3}]",
        "forces: [wind: {@velocity: {random: [[0, 0, 0], [1, 1, 2]]}, mode: add}]",
        "forces: [curl: {@strength: 2, octaves: 3, drift: [1, 0, 2], pull: 3}]",
        "forces: [curl: {@strength: 2, scale: {random: [0.3, 1]}}]",
        "forces: [attract: {@position: [0.5, 0, 0], strength: 3, radius: {life: [0.2, 1]}}]",
        "forces: [vortex: {@position: [0, 0, 0.5], axis: [1, 1, 0], inward: 1, lift: 2}]",
        "forces: [gravity: {@region: {box: {center: [0.5, 0, 0], size: [1, 2, 3]}, falloff: 0.5}}]",
        "forces: [drag: {@strength: 5, quadratic: 2, region: {sphere: {center: [0.5, 0, 0]}}}]",
        "demitters: [{@min: [-1, -1, 0.2], max: [2, 0.5, 2]}]",
        "forces: [wind: {@field: grid, file: tests/support/whirl.grid, pull: 4}]",
    };
    for (size_t i = 0; i < sizeof forces / sizeof *forces; i++) {
        const double away = farthest_turned("attach: a, ", forces[i]);
        if (!(away < 1e-4))
            fail_msg("%s: %g m away", forces[i], away);
    }
    assert_true(farthest_turned("", forces[0]) > 0.1);
    assert_true(farthest_turned("", forces[4]) > 0.1);
}

/* The region alone lies in a node. */
static void regions_have_nodes_of_their_own(void **state)
{
    (void)state;
    static const char nodes[] =
        "nodes: {a: {position: {keys: {0 s: [0, 0, 0], 1 s: [1, 0, 0]}}, scale: 2,\n"
        "  rotation: [0, 0, 90 deg]}}\n";
    static const char by_hand[] =
        "gravity: {region: {box: {center: {keys: {0 s: [-1, 0, 0], 1 s: [0, 0, 0]}},\n"
        "  size: [1, 2, 4]}, falloff: 0.4 m}}";
    assert_true(farthest(nodes,
                         "gravity: {region: {attach: a, box: {center: [0, 0.5, 0],\n"
                         "  size: [1, 0.5, 2]}, falloff: 0.2 m}}",
                         by_hand) < 1e-4);
}

/* A node that moves carries eddies as their drift does, and its scale is that of the eddies. Drag
 * in it is drag at rest: air does not take up the velocity of the node. */
static void eddies_move_and_grow_with_their_node(void **state)
{
    (void)state;
    static const char nodes[] =
        "nodes: {a: {position: {keys: {0 s: [0, 0, 0], 1 s: [1, 0.5, 0]}}, scale: 2}}\n";
    assert_true(farthest(nodes, "curl: {attach: a, scale: 0.4, pull: 3}",
                         "curl: {scale: 0.8, drift: [1, 0.5, 0], pull: 3}") < 1e-4);
    assert_true(farthest(nodes, "drag: {attach: a, strength: 3}", "drag: 3") == 0);
    assert_true(farthest(nodes, "wind: {attach: a}", "wind: {}") < 1e-6);
}

/* A grid is carried, turned and scaled: its points lie elsewhere, its velocities are those of the
 * file. */
static void grids_grow_with_their_node(void **state)
{
    (void)state;
    static const char file[] = "wind: {%sfield: grid, file: tests/support/whirl.grid, pull: 4}";
    char attached[160], plain[160];
    snprintf(attached, sizeof attached, file, "attach: a, ");
    snprintf(plain, sizeof plain, file, "");
    assert_true(farthest("nodes: {a: {scale: 1}}\n", attached, plain) < 1e-6);
    assert_true(farthest("nodes: {a: {scale: 3}}\n", attached, plain) > 0.01);
}

/* A node of a small scale makes no radius and no eddy smaller than a scene may write it. */
static void nothing_is_smaller_than_a_millimetre(void **state)
{
    (void)state;
    static const char nodes[] = "nodes: {a: {position: [0, 0.2, 0], scale: 1e-6}}\n";
    assert_true(farthest(nodes, "vortex: {attach: a, speed: 900, pull: 3}",
                         "vortex: {position: [0, 0.2, 0], radius: 1 mm, speed: 900, pull: 3}") <
                1e-3);
    assert_true(farthest("nodes: {a: {scale: 0.001}}\n", "curl: {attach: a, scale: 0.5, pull: 3}",
                         "curl: {scale: 1 mm, pull: 3}") < 1e-3);
}

/* Particles that are born around an attractor of such a node stay there. */
static void no_attractor_empties_a_system(void **state)
{
    (void)state;
    struct simulation run;
    struct kiln_scene *scene =
        load("kiln: 1\noutput: {frames: 60, fps: 60}\n"
             "nodes: {a: {position: [0, 1, 0], scale: 1e-6}}\n"
             "systems: {s: {emit: {rate: 900, attach: a, life: 9 s, speed: 0, from: {box: {}}},\n"
             "  forces: [attract: {attach: a}]}}\n");
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 60);
    uint32_t alive = 0;
    for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++)
        alive += particle_is_alive(simulation_records(&run)[i]);
    assert_int_equal(alive, 885); /* in 59 steps, 15 were born in each */
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* ---- closed forms ---------------------------------------------------------------------------- */

/* Where a particle is and how fast it is, x + i z. A turn to the left around y is a factor of
 * e^(-i angle). */
struct seen {
    double complex at, velocity;
};

/* Returns what a particle, born at rest at (1, 0, 0), has become after a second. */
static struct seen after_a_second(const char *nodes, const char *force)
{
    char text[1024];
    struct simulation run;
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 120, fps: 120}\nsimulation: {integration: rk4, rate: 120}\n"
             "nodes: {n: {%s}}\nsystems: {a: {emit: {bursts: {0 s: 1}, life: 9 s, speed: 0, "
             "from: {point: {origin: [1, 0, 0]}}}, forces: [%s]}}\n",
             nodes, force);
    struct kiln_scene *scene = load(text);
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 120);
    const float3 at = particle_position(simulation_records(&run)[0]);
    const float3 v = particle_velocity(simulation_records(&run)[0]);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    assert_true(at.y == 0.0f && v.y == 0.0f);
    return (struct seen){.at = (double)at.x + I * (double)at.z,
                         .velocity = (double)v.x + I * (double)v.z};
}

static void expect_near(const char *force, struct seen found, struct seen expected)
{
    const double away = cabs(found.at - expected.at),
                 faster = cabs(found.velocity - expected.velocity);
    if (!(away < 5e-4 && faster < 2e-3))
        fail_msg("%s: %g m and %g m/s away", force, away, faster);
}

/* A wind of V in a node that turns by w a second: v' = p (V e^(-i w t) - v). */
static void a_wind_turns_with_its_node(void **state)
{
    (void)state;
    static const char nodes[] = "rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 180 deg, 0]}}";
    static const char *const winds[] = {
        "wind: {attach: n, velocity: [2, 0, 0], pull: 3}",
        "wind: {baked: {attach: n, box: {size: [6, 6, 6]}, cells: 3, of: [wind: {attach: n, "
        "velocity: [2, 0, 0], pull: 3}]}}",
    };
    const double p = 3, w = acos(-1.0);
    const double complex whole = p * 2 / (p - I * w), turned = cexp(-I * w);
    const struct seen expected = {
        .at = 1 + whole * ((turned - 1) / (-I * w) + (exp(-p) - 1) / p),
        .velocity = whole * (turned - exp(-p)),
    };
    for (size_t i = 0; i < sizeof winds / sizeof *winds; i++)
        expect_near(winds[i], after_a_second(nodes, winds[i]), expected);
}

/* Air that turns as a solid body does around a node that flies by u m/s along x. The axis is y, so
 * z'' = p (-i w (z - u t) - z'). */
static void a_whirl_flies_with_its_node(void **state)
{
    (void)state;
    static const char nodes[] = "position: {keys: {0 s: [0, 0, 0], 1 s: [1.5, 0, 0]}}";
    static const char *const whirls[] = {
        "vortex: {attach: n, speed: 30, radius: 10 m, pull: 5}",
        "wind: {baked: {attach: n, box: {size: [6, 2, 6]}, cells: 6, of: [vortex: {attach: n, "
        "speed: 30, radius: 10 m, pull: 5}]}}",
    };
    const double p = 5, w = 3, u = 1.5;
    const double complex root = csqrt(p * p - 4 * I * p * w);
    const double complex one = (-p + root) / 2, two = (-p - root) / 2, beside = I * u / w;
    const double complex first = (-u - two * (1 - beside)) / root, second = 1 - beside - first;
    const struct seen expected = {
        .at = first * cexp(one) + second * cexp(two) + beside + u,
        .velocity = one * first * cexp(one) + two * second * cexp(two) + u,
    };
    for (size_t i = 0; i < sizeof whirls / sizeof *whirls; i++)
        expect_near(whirls[i], after_a_second(nodes, whirls[i]), expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(attractors_act_where_their_node_is),
        cmocka_unit_test(vortices_turn_with_their_node),
        cmocka_unit_test(all_forces_turn_with_their_node),
        cmocka_unit_test(regions_have_nodes_of_their_own),
        cmocka_unit_test(eddies_move_and_grow_with_their_node),
        cmocka_unit_test(grids_grow_with_their_node),
        cmocka_unit_test(nothing_is_smaller_than_a_millimetre),
        cmocka_unit_test(no_attractor_empties_a_system),
        cmocka_unit_test(a_wind_turns_with_its_node),
        cmocka_unit_test(a_whirl_flies_with_its_node),
    };
    return cmocka_run_group_tests_name("attached_forces", tests, NULL, NULL);
}
