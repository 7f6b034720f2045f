/* Checks that each technique of the stage `simulate` computes the same bits as `cpu` for what
 * happens to particles: repeated bursts, forces that act in regions, impacts, and children
 * of each impact and by the metre. If this fails,
 * GLSL has another region or another birth than C. */
#include "support/agree.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/simulation.h"

enum { STEPS = 90 };

/* All forces in regions that move, with births in repeated bursts. A quadratic drag and a vortex
 * need FORCES_ALL. */
static const char REGIONS[] =
    "kiln: 1\n"
    "seed: 3\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  a:\n"
    "    emit:\n"
    "      bursts:\n"
    "        - {at: -0.2 s, count: [200, 400], every: 0.15 s, jitter: 0.1 s}\n"
    "        - {at: 0.3 s, count: 100, every: 7 ms, most: 20}\n"
    "        - {count: [0, 50], every: 0.05 s, jitter: 0.05 s}\n"
    "      life: [0.5 s, 2 s]\n"
    "      speed: [1, 3]\n"
    "      from: {box: {origin: [0, 1, 0], size: [2, 2, 2], angle: 180 deg}}\n"
    "    forces:\n"
    "      - gravity: {region: {sphere: {center: [0, 1, 0], radius: 1}, falloff: 0.5 m}}\n"
    "      - drag: {strength: 2, quadratic: 0.5, region: {box: {size: [1, 4, 1]}}}\n"
    "      - wind: {velocity: [4, 0, 0], pull: 3, region: {box: {center: [0, 2, 0],\n"
    "               size: {keys: {0 s: [1, 1, 1], 1 s: [3, 1, 3]}}}, falloff: 0.2 m}}\n"
    "      - wind: {velocity: [0, 0, 2], mode: add, region: {sphere: {radius: 0.4}}}\n"
    "      - curl: {strength: 3, scale: {random: [0.2, 0.6]}, octaves: 2,\n"
    "               region: {sphere: {radius: {noise: [0.5, 2]}}, falloff: 1 m}}\n"
    "      - vortex: {speed: 3, inward: 1, radius: {height: {0 m: 0.2, 3 m: 1}}, pull: 4,\n"
    "                 region: {box: {center: [0, 1.5, 0], size: [3, 3, 3]}, falloff: 1 m}}\n"
    "      - attract: {position: [1, 1, 1], strength: 4, radius: {speed: {0: 0.1, 4: 0.5}},\n"
    "                  region: {sphere: {center: [1, 1, 1], radius: 1.5}, falloff: 0.3 m}}\n"
    "      - gravity: [0, -1, 0]\n";

/* Forces that every kernel has, so that kernels without FORCES_ALL are tested, too. */
static const char PLAIN[] =
    "kiln: 1\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 2000, life: 1 s, from: {box: {origin: [0, 1, 0], size: [2, 2, 2]}}}\n"
    "    forces:\n"
    "      - gravity: {region: {box: {size: [2, 2, 1]}, falloff: 0.4 m}}\n"
    "      - drag: {strength: 3, region: {sphere: {radius: 1.2}, falloff: 1.2 m}}\n";

/* Drops that stop, die or bounce on a floor and on a box that moves. They give birth to others
 * where they hit, along their ways and where they end, also after they have stopped. */
static const char IMPACTS[] =
    "kiln: 1\n"
    "seed: 5\n"
    "output: {frames: 60}\n"
    "backdrop:\n"
    "  floor: {height: 0 m}\n"
    "  objects:\n"
    "    - box: {center: {keys: {0 s: [0, 0.5, 0], 1 s: [0.5, 0.5, 0]}}, size: [1, 0.5, 1],\n"
    "            collide: true}\n"
    "systems:\n"
    "  stopping:\n"
    "    emit: {rate: 900, life: [0.4 s, 1.2 s], speed: [1, 3], from: {box: {origin: [0, 1.2, 0],\n"
    "           size: [3, 0.2, 3], angle: 180 deg}}}\n"
    "    forces: [gravity: {}, curl: {}]\n"
    "    collide: {then: stop, chance: {random: [0.2, 1], times: {life: [1, 0.5]}}}\n"
    "    bounds: {min: [-1.2, -1, -3], max: [3, 3, 3]}\n"
    "  plain:\n"
    "    emit: {rate: 500, life: 1 s, speed: 3, from: {point: {origin: [0, 1, 0], angle: 90 deg,\n"
    "           direction: [0, -1, 0]}}}\n"
    "    collide: {then: stop, mode: clamp}\n"
    "  dying:\n"
    "    emit: {rate: 500, life: 1 s, speed: 3, from: {point: {origin: [0, 1, 0], angle: 90 deg,\n"
    "           direction: [0, -1, 0]}}}\n"
    "    collide: {then: die, chance: 0.5, slowdown: 0.9}\n"
    "  shard:\n"
    "    emit: {parent: {system: dying, on: {death: {count: 3, impact: true}}}, life: 0.3 s}\n"
    "  splash:\n"
    "    emit: {parent: {system: stopping, on: {bounce: {count: [1, 3], align: normal}}}, life: "
    "0.2 s}\n"
    "  trail:\n"
    "    emit: {parent: {system: stopping, on: {trail: 10}}, life: 0.2 s}\n"
    "  end:\n"
    "    emit: {parent: {system: stopping, on: {death: [1, 4]}}, life: 0.2 s}\n";

/* Drops that stick to objects which move and turn, and ride out of the bounds and into a place
 * where they die; children at each impact, and by the metre, of balls that spin, and of what sticks
 * and rides; an emitter with births by the metre. */
static const char TRAILS[] =
    "kiln: 1\n"
    "seed: 6\n"
    "output: {frames: 60}\n"
    "nodes:\n"
    "  hub: {position: {keys: {0 s: [0, 0.5, 0], 1 s: [0.5, 0.8, 0]}},\n"
    "        rotation: {keys: {0 s: [0, 0, 0], 1 s: [20 deg, 300 deg, 0]}}}\n"
    "backdrop:\n"
    "  floor: {height: 0 m}\n"
    "  objects:\n"
    "    - box: {attach: hub, center: [0, 0, 0], size: [1, 0.3, 1], collide: true}\n"
    "    - sphere: {center: {keys: {0 s: [1, 0.5, 0], 1 s: [1, 0.2, 1]}}, radius: 0.4 m,\n"
    "               collide: true}\n"
    "    - capsule: {center: [-1, 0.3, 0], axis: {keys: {0 s: [0, 1, 0], 1 s: [1, 0, 1]}},\n"
    "                radius: 0.2 m, height: 1 m, collide: true}\n"
    "    - box: {center: {keys: {0 s: [0, 0.2, 1.2], 1 s: [0, 0.2, 2]}}, size: [1, 0.4, 0.4],\n"
    "            collide: true}\n"
    "systems:\n"
    "  wake:\n"
    "    emit: {attach: hub, rate: 50, per_metre: 300, bursts: {0.5 s: 20}, life: 0.4 s,\n"
    "           from: {point: {origin: {keys: {0 s: [0, 0, 0], 1 s: [1, 0, 0]}}}}}\n"
    "  sticky:\n"
    "    emit: {rate: 900, life: [0.4 s, 1.2 s], speed: [1, 3], from: {box: {origin: [0, 1.2, 0],\n"
    "           size: [3, 0.2, 3], angle: 180 deg}}}\n"
    "    forces: [gravity: {}]\n"
    "    collide: {then: stick, chance: 0.6}\n"
    "    look: {facing: surface}\n"
    "    bounds: {min: [-3, -1, -3], max: [1.3, 3, 1.9]}\n"
    "    demitters: [{min: [0.4, 0.3, -1], max: [0.8, 1.2, 1]}]\n"
    "  plain:\n"
    "    emit: {rate: 500, life: 1 s, speed: 3, from: {point: {origin: [0, 1, 0], angle: 90 deg,\n"
    "           direction: [0, -1, 0]}}}\n"
    "    collide: {then: stick, mode: clamp}\n"
    "  balls:\n"
    "    emit: {rate: 100, life: 1 s, speed: 3, from: {box: {origin: [0, 1.5, 0], size: [1, 1, "
    "1],\n"
    "           angle: 180 deg}}}\n"
    "    forces: [gravity: {}]\n"
    "    interact: [collide: {radius: 4 cm, spin: true}]\n"
    "    collide: {restitution: 0.9, slowdown: 1}\n"
    "  dust:\n"
    "    emit: {parent: {system: balls, on: {bounce: {count: [1, 3], every: true, most: 6,\n"
    "           align: normal}}, inherit: {size: true}},\n"
    "           life: 0.4 s}\n"
    "  smoke:\n"
    "    emit: {parent: {system: balls, on: {trail: {per_metre: 9, most: 40}}}, inherit: 0.5,\n"
    "           life: 0.3 s, speed: 0.2}\n"
    "  drips:\n"
    "    emit: {parent: {system: sticky, on: {trail: {per_metre: 4.5, most: 6, align: "
    "velocity}}},\n"
    "           life: 0.2 s, speed: 1}\n"
    "  splash:\n"
    "    emit: {parent: {system: sticky, on: {bounce: {count: 1, every: true, most: 2}}},\n"
    "           life: 0.2 s, inherit: 1}\n"
    "  rings:\n"
    "    emit: {parent: {system: balls, on: {bounce: 1}}, life: 0.4 s, speed: {choose: [0, 1]}}\n"
    "    forces: [gravity: {}]\n"
    "    demitters: [{min: [-0.2, -1, -1], max: [0.1, 1, 1]}]\n"
    "    look: {facing: surface}\n"
    "  end:\n"
    "    emit: {parent: {system: sticky, on: {death: 1}, inherit: {color: true}}, life: 0.2 s,\n"
    "           inherit: 1}\n";

static void trails_agree(void **state)
{
    simulation_agree(*state, TRAILS, NULL, STEPS);
}

static void trails_agree_in_stages(void **state)
{
    simulation_agree(*state, TRAILS, "simulation.integration=rk4", STEPS / 3);
}

static void impacts_agree(void **state)
{
    simulation_agree(*state, IMPACTS, NULL, STEPS);
}

static void impacts_agree_in_stages(void **state)
{
    simulation_agree(*state, IMPACTS, "simulation.integration=rk4", STEPS / 3);
}

static void regions_agree(void **state)
{
    simulation_agree(*state, REGIONS, NULL, STEPS);
}

static void regions_agree_in_stages(void **state)
{
    simulation_agree(*state, REGIONS, "simulation.integration=rk4", STEPS / 3);
}

static void plain_forces_agree(void **state)
{
    simulation_agree(*state, PLAIN, NULL, STEPS / 3);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(regions_agree),           test_on_device(regions_agree_in_stages),
        test_on_device(plain_forces_agree),      test_on_device(impacts_agree),
        test_on_device(impacts_agree_in_stages), test_on_device(trails_agree),
        test_on_device(trails_agree_in_stages),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    return test_list_run(&list, "events", argc, argv, simulation_device_open, test_device_close);
}
