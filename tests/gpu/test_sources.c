/* Checks that each technique of the stage `simulate` computes the same bits as `cpu` for births on
 * meshes, images and paths. If this fails, GLSL chooses another cell than C, or another place on
 * it. */
#include <unistd.h>

#include "support/agree.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/simulation.h"

enum { STEPS = 60 };

/* Births on all kinds of sources; some are around particles, in a node, on an object that moves
 * and turns, or on one with an animation. */
static const char SOURCES[] =
    "kiln: 1\n"
    "seed: 3\n"
    "output: {frames: 60}\n"
    "nodes:\n"
    "  n: {position: {keys: {0 s: [0, 0, 0], 1 s: [2, 0, 1]}}, rotation: [20 deg, 0, 0], scale: "
    "2}\n"
    "backdrop:\n"
    "  objects:\n"
    "    quilt:\n"
    "      mesh: {file: sources/quilt.obj, position: {keys: {0 s: [0, 0, 0], 2 s: [4, 1, 0]}},\n"
    "             rotation: {keys: {0 s: [0, 0, 0], 2 s: [0, 90 deg, 180 deg]}}}\n"
    "    part: {mesh: {file: mutation/moving.gltf, scale: 0.5, rotation: [0, 30 deg, 0],\n"
    "                  animation: {speed: 1.7}}}\n"
    "systems:\n"
    "  surface:\n"
    "    emit: {rate: 900, life: [0.5 s, 1 s], attach: n, inherit: 0.5,\n"
    "           from: {mesh: {file: sources/quilt.obj, angle: 20 deg, rotation: [10 deg, 20 deg, "
    "0]}}}\n"
    "    forces: [gravity: {}, curl: {}]\n"
    "  vertices:\n"
    "    emit: {rate: 300, life: 1 s, from: {mesh: {file: sources/quilt.obj, on: vertices, scale: "
    "3}}}\n"
    "  inside:\n"
    "    emit: {rate: 300, life: 1 s, from: {mesh: {file: mutation/tetrahedron.obj, on: volume}}}\n"
    "  moving:\n"
    "    emit: {rate: 900, life: 1 s, inherit: 1, from: {mesh: {object: quilt, outward: false}}}\n"
    "  posed:\n"
    "    emit: {rate: 900, life: 1 s, inherit: 0.7, from: {mesh: {object: part, angle: 30 deg}}}\n"
    "  picture:\n"
    "    emit: {rate: 900, bursts: {0.3 s: 100}, life: 1 s, from: {image: {file: "
    "sources/mark.png,\n"
    "           width: 3 m, angle: 10 deg, turn: 90 deg/s}}}\n"
    "    bounds: {min: [-1.4, -3, -3], max: [3, 3, 3]}\n"
    "  child:\n"
    "    emit: {parent: {system: picture, on: {death: 2}}, life: 0.4 s, from: {image: "
    "sources/mark.png}}\n"
    "  path:\n"
    "    emit: {rate: 300, bursts: {0.2 s: 150, 0.21 s: 1}, life: 1 s,\n"
    "           from: {path: {points: [[0, 0, 0], [1, 1, 0], [2, 0, 0]], ordered: true}}}\n"
    "  ring:\n"
    "    emit: {rate: 300, bursts: {0.2 s: 150}, life: 1 s, from: {ring: {ordered: true}}}\n"
    "  line:\n"
    "    emit: {bursts: {0.2 s: 150}, life: 1 s, from: {line: {ordered: true}}}\n"
    "  rake:\n"
    "    emit: {bursts: {0.2 s: 150}, life: 1 s, from: {line: {nozzles: 3}}}\n";

static void sources_agree(void **state)
{
    simulation_agree(*state, SOURCES, NULL, STEPS);
}

static void sources_agree_in_stages(void **state)
{
    simulation_agree(*state, SOURCES, "simulation.integration=rk4", STEPS / 3);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(sources_agree),
        test_on_device(sources_agree_in_stages),
    };
    struct test_list list = {.count = 0};
    if (chdir(KILN_SOURCE_DIR "/tests") != 0)
        return 1;
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    return test_list_run(&list, "sources", argc, argv, simulation_device_open, test_device_close);
}
