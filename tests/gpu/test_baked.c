/* Checks that each technique of the stage `simulate` moves particles in baked winds as `cpu` does,
 * bit by bit. If this fails, the kernel in GL writes another grid than the host, or particles read
 * it otherwise. */
#include "support/agree.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/simulation.h"

/* Two grids, one in a node that moves, turns and grows, with forces of all kinds. */
static const char ALL[] =
    "kiln: 1\n"
    "seed: 3\n"
    "output: {frames: 60}\n"
    "nodes:\n"
    "  n: {position: [0, 1, 0], rotation: {keys: {0 s: [0, 0, 0], 1 s: [90 deg, 200 deg, 0]}},\n"
    "      scale: {keys: {0 s: 0.5, 1 s: 2}}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 3000, life: [0.3 s, 1.5 s], from: {box: {origin: [0, 1, 0], size: [3, 3, "
    "3],\n"
    "           angle: 180 deg}}}\n"
    "    forces:\n"
    "      - wind: {baked: {attach: n, box: {size: [3, 2, 4]}, cells: 13, every: 3, of: [\n"
    "          curl: {strength: 2, octaves: 3, drift: [0, 1, 0], attach: n},\n"
    "          vortex: {speed: 3, inward: 1, lift: {noise: [0, 2]}, radius: 0.4, pull: 4},\n"
    "          attract: {position: [0.5, 0, 0], strength: 4, region: {sphere: {}, falloff: 0.5}},\n"
    "          gravity: [0, -1, 0], drag: 0.3, wind: {mode: add, velocity: [0.01, 0, 0]}]}}\n"
    "      - gravity: {life: [[0, 0, 0], [0, 1, 0]]}\n"
    "  b:\n"
    "    emit: {rate: 900, life: 1 s, from: {sphere: {}}}\n"
    "    forces:\n"
    "      - wind: {baked: {box: {center: [0, 0.5, 0], size: [1, 1, 1]}, cells: 5,\n"
    "          of: [curl: {scale: 0.5, pull: 9}], region: {box: {size: [3, 3, 1]}, falloff: 1}}}\n";

/* Forces that every kernel has. */
static const char PLAIN[] =
    "kiln: 1\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 2000, life: 1 s, from: {box: {origin: [0, 1, 0], size: [2, 2, 2]}}}\n"
    "    forces:\n"
    "      - wind: {baked: {box: {size: [3, 3, 3]}, cells: 8, every: 4,\n"
    "          of: [curl: {octaves: 2, drift: [1, 0, 0]}, gravity: [0, 1, 0]]}}\n";

static void baked_winds_agree(void **state)
{
    simulation_agree(*state, ALL, NULL, 60);
}

static void baked_winds_agree_in_stages(void **state)
{
    simulation_agree(*state, ALL, "simulation.integration=rk4", 25);
}

static void plain_winds_agree(void **state)
{
    simulation_agree(*state, PLAIN, NULL, 30);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(baked_winds_agree),
        test_on_device(baked_winds_agree_in_stages),
        test_on_device(plain_winds_agree),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    return test_list_run(&list, "baked", argc, argv, simulation_device_open, test_device_close);
}
