/* Attractors and vortices that lie in nodes move particles as those that are written in the world
 * do. If this fails, a force that is attached to a node acts elsewhere. */
#include <stdio.h>

#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

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
    *scene = load_scene(text, NULL);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(attractors_act_where_their_node_is),
        cmocka_unit_test(vortices_turn_with_their_node),
    };
    return cmocka_run_group_tests_name("attached_forces", tests, NULL, NULL);
}
