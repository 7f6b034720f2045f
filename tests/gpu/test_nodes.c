/* Checks that each technique of the stage `simulate` computes the same bits as `cpu` where emitters
 * and colliders lie in nodes, and where particles move with nodes. If this fails, GLSL takes births
 * from the frame of a node in another way than C (shaders/shared/emit.h), or carries particles in
 * another way (carry.h). */
#include <math.h>
#include <string.h>

#include "support/agree.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/scenes.h"
#include "support/simulation.h"

static const char SCENE[] =
    "kiln: 1\n"
    "seed: 3\n"
    "output: {frames: 60}\n"
    "nodes:\n"
    "  hub: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [10 deg, 400 deg, 0]}},\n"
    "        scale: {keys: {0 s: 1, 1 s: 2}}}\n"
    "  arm: {parent: hub, position: [1, 1, 0]}\n"
    "  ship: {position: {path: {points: [[0, 1, 0], [1, 2, 1], [3, 0.5, 0]], over: [0.1 s, 1 s],\n"
    "         ease: smooth}}, heading: path}\n"
    "  jump: {position: {keys: {0 s: [0, 1, 0], 0.3 s: [2, 1, 0], 0.6 s: [0, 1, 2]}, ease: step}}\n"
    "backdrop:\n"
    "  objects:\n"
    "    - box: {attach: arm, center: [0, -0.6, 0]}\n"
    "    - capsule: {attach: ship, axis: [0, 0, 1], center: [0, 0, 1]}\n"
    "    - sphere: {attach: hub, center: [-1, 0, 0]}\n"
    "systems:\n"
    "  a:\n"
    "    emit:\n"
    "      rate: 1500\n"
    "      attach: arm\n"
    "      inherit: 0.8\n"
    "      from: {disc: {origin: {keys: {0 s: [0, 0, 0], 1 s: [0, 1, 0]}}, turn: 90 deg/s}}\n"
    "    forces: [{gravity: {}}]\n"
    "    collide: {restitution: 0.6, friction: 0.2}\n"
    "  b:\n"
    "    emit: {rate: 900, attach: ship, inherit: {random: [0, 1]},\n"
    "           from: {cone: {direction: [0, 0, -1]}}}\n"
    "    forces: [{attract: {attach: hub, position: [0, 1, 0], strength: 3}},\n"
    "             {vortex: {attach: ship, axis: [0, 0, 1], radius: 0.3}}]\n"
    "    collide: {}\n"
    "  c:\n"
    "    emit: {rate: 900, attach: jump, inherit: 1, from: {sphere: {outward: true}}}\n"
    "  free:\n"
    "    emit: {rate: 500, inherit: 1, from: {box: {}}}\n"
    "  sparks:\n"
    "    emit: {parent: {system: a, on: {trail: {rate: 4}}}, life: 0.3 s}\n";

/* All forces, their regions and demitters in nodes that move, turn and grow. FORCES_ALL is needed.
 */
static const char FORCES[] =
    "kiln: 1\n"
    "seed: 3\n"
    "output: {frames: 60}\n"
    "nodes:\n"
    "  hub: {position: [0, 1, 0], rotation: {keys: {0 s: [0, 0, 0], 1 s: [90 deg, 400 deg, 0]}},\n"
    "        scale: {keys: {0 s: 0.5, 1 s: 2}}}\n"
    "  arm: {parent: hub, position: {keys: {0 s: [0, 0, 0], 1 s: [1, 1, 0]}}, scale: 0.7}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 3000, life: [0.3 s, 1.5 s], speed: [0.5, 2],\n"
    "           from: {box: {origin: [0, 1, 0], size: [3, 3, 3], angle: 180 deg}}}\n"
    "    forces:\n"
    "      - gravity: {attach: hub, acceleration: {life: [[0, -9, 0], [3, 0, 1]]}}\n"
    "      - drag: {strength: 2, quadratic: 0.4, attach: arm, region: {box: {size: [1, 9, 1]}}}\n"
    "      - wind: {velocity: [4, 0, 0], pull: 3, region: {attach: arm, sphere: {}, falloff: 0.5 "
    "m}}\n"
    "      - wind: {velocity: [0, 0, 2], mode: add, attach: arm, region: {attach: hub, box: {}}}\n"
    "      - curl: {strength: 2, scale: {random: [0.2, 0.6]}, octaves: 3, drift: [0, 1, 0],\n"
    "               attach: hub}\n"
    "      - vortex: {speed: 3, inward: 1, radius: {height: {0 m: 0.2, 3 m: 1}}, attach: arm,\n"
    "                 position: [0.2, 0, 0], axis: [1, 1, 0],\n"
    "                 region: {box: {size: [3, 2, 3]}, falloff: 1 m}}\n"
    "      - attract: {position: [0.5, 0, 0], strength: 4, radius: {speed: {0: 0.1, 4: 0.5}},\n"
    "                  attach: hub}\n"
    "      - limit: 6\n"
    "    demitters:\n"
    "      - {attach: arm, min: [-0.1, -9, -0.1], max: [0.2, 0, 0.2]}\n"
    "      - {min: [1, 1, 1], max: [3, 3, 1.5]}\n";

/* Forces that every kernel has. */
static const char PLAIN[] =
    "kiln: 1\n"
    "output: {frames: 60}\n"
    "nodes: {hub: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 90 deg, 0]}}, scale: 2}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 2000, life: 1 s, from: {box: {origin: [0, 1, 0], size: [2, 2, 2]}}}\n"
    "    forces: [wind: {attach: hub, pull: 3}, curl: {attach: hub},\n"
    "             gravity: {region: {attach: hub, box: {}}}]\n";

static void attached_forces_agree(void **state)
{
    simulation_agree(*state, FORCES, NULL, 70);
    simulation_agree(*state, FORCES, "simulation.integration=rk4", 25);
    simulation_agree(*state, PLAIN, NULL, 30);
    /* radii and eddies that would be too small */
    simulation_agree(*state, FORCES, "nodes.arm.scale=1e-5", 30);
    simulation_agree(*state, PLAIN, "nodes.hub.scale=1e-6", 20);
}

/* Systems that move with nodes: with collisions, children, other particles, spins and a jump. */
static const char SPACES[] =
    "kiln: 1\n"
    "seed: 7\n"
    "output: {frames: 60}\n"
    "nodes:\n"
    "  ship: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [60 deg, 500 deg, 0]}},\n"
    "         position: {keys: {0 s: [0, 1, 0], 1 s: [3, 1.2, 1]}}}\n"
    "  jump: {position: {keys: {0 s: [0, 1, 0], 0.3 s: [2, 1, 0], 0.6 s: [0, 1, 2]}, ease: step},\n"
    "         rotation: {keys: {0 s: [0, 0, 0], 0.3 s: [0, 90 deg, 0]}, ease: step}}\n"
    "backdrop:\n"
    "  objects:\n"
    "    - box: {center: [2, 0.5, 1], size: [1, 1, 1], rotation: [0, 30 deg, 0]}\n"
    "    - sphere: {attach: ship, center: [-0.5, 0, 0.5], radius: 0.3}\n"
    "systems:\n"
    "  a:\n"
    "    space: ship\n"
    "    emit: {rate: 1500, attach: ship, from: {box: {size: [2, 2, 2], angle: 180 deg}}}\n"
    "    forces: [{gravity: {}}, {drag: 1}]\n"
    "    collide: {restitution: 0.6, friction: 0.2, randomness: 0.1}\n"
    "  sparks:\n"
    "    emit: {parent: {system: a, on: {trail: {rate: 4}}}, life: 0.3 s}\n"
    "    space: jump\n"
    "  hits:\n"
    "    emit: {parent: {system: a, on: {bounce: 2}}, life: 0.3 s}\n"
    "  clamped:\n"
    "    space: ship\n"
    "    emit: {rate: 400, attach: jump}\n"
    "    collide: {mode: clamp}\n"
    "  stopping:\n"
    "    space: ship\n"
    "    emit: {rate: 400, attach: ship}\n"
    "    forces: [gravity: {}]\n"
    "    collide: {then: stop, chance: 0.5}\n"
    "  balls:\n"
    "    space: ship\n"
    "    emit: {rate: 200, attach: ship, from: {box: {size: [1, 1, 1]}}}\n"
    "    forces: [gravity: {}]\n"
    "    interact: [{collide: {radius: 0.05 m, turning: [1 rad/s, 5 rad/s]}}]\n"
    "    collide: {friction: 0.4}\n";

static void attached_emitters_agree(void **state)
{
    simulation_agree(*state, SCENE, NULL, 70);
}

static void spaces_agree(void **state)
{
    simulation_agree(*state, SPACES, NULL, 50);
}

static void spaces_agree_along_curves(void **state)
{
    simulation_agree(*state, SPACES, "simulation.integration=rk4", 40);
    if (test_is_full())
        simulation_agree(*state, SPACES, "simulation.integration=position_first", 40);
}

/* A circle of 1 m, once around in a second. */
static const char CIRCLE[] =
    "kiln: 1\n"
    "output: {frames: 120, fps: 60}\n"
    "nodes:\n"
    "  hub: {rotation: {keys: {0 s: [0, 0, 0], 2 s: [0, 720 deg, 0]}}}\n"
    "  arm: {parent: hub, position: [1, 0, 0]}\n"
    "systems: {a: {emit: {rate: 3000, speed: 0, life: 9 s, attach: arm, from: {point: {}}}}}\n";

static void births_lie_on_a_circle(void **state)
{
    struct kiln_scene *scene = load_scene(CIRCLE, NULL);
    for (size_t i = 0; i < simulation_way_count(); i++) {
        struct simulation run;
        uint32_t seen = 0;
        simulation_start_with(&run, scene, *state, simulation_ways[i].technique, 1);
        simulation_run(&run, 60);
        const struct kiln_particle *records = simulation_records(&run);
        for (uint32_t k = 0; k < run.pool.systems[0].capacity; k++) {
            const float3 p = particle_position(records[k]);
            const double radius = hypot((double)p.x, (double)p.z);
            if (!particle_is_alive(records[k]))
                continue;
            seen++;
            if (!(fabs(radius - 1) < 1e-5))
                fail_msg("%s: born %.9g m from the axis", simulation_ways[i].name, radius);
        }
        assert_true(seen > 2900);
        simulation_end(&run);
    }
    kiln_scene_destroy(&scene);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(attached_emitters_agree),
        test_on_device(attached_forces_agree),
        test_on_device(spaces_agree),
        test_on_device(spaces_agree_along_curves),
        test_on_device(births_lie_on_a_circle),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    return test_list_run(&list, "nodes", argc, argv, simulation_device_open, test_device_close);
}
