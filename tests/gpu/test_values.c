/* Checks that each technique of the stage `simulate` computes the same bits as `cpu` where the
 * values of a scene vary over every clock. If this fails, GLSL evaluates a value in another way
 * than C (shaders/shared/value.h). */
#include "support/agree.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/simulation.h"

/* Returns the number of steps of flying particles; crowds are stepped half as often. A sample of
 * the tests has fewer, the last of which is at the last key over the time. */
static uint32_t steps(void)
{
    return test_is_full() ? 90 : 60;
}

/* Systems whose rows that move particles have values of every clock. */
static const char FLYING[] =
    "kiln: 1\n"
    "seed: 3\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  a:\n"
    "    emit:\n"
    "      rate: {noise: [500, 2000], period: 0.2 s, octaves: 2}\n"
    "      life: {random: {0: 0.3, 0.8: 1, 1: 3}, times: {choose: [1, 0.5], weights: [1, 2]}}\n"
    "      speed: {random: [1, 4], ease: out, plus: {noise: [0, 1], period: 0.3 s}}\n"
    "      inherit: {choose: [0, 1]}\n"
    "      from:\n"
    "        disc:\n"
    "          origin: {keys: {0 s: [0, 1, 0], 0.5 s: [1, 1, 0]}, ease: smooth, repeat: mirror,\n"
    "                   plus: {noise: [[0, 0, -0.5], [0, 0.1, 0.5]], period: 0.4 s}}\n"
    "          direction: {choose: [[0, 1, 0], [1, 1, 0], [0, 1, 1]], seed: 4}\n"
    "          angle: {random: [5 deg, 40 deg]}\n"
    "          radius: {noise: [0.1, 0.5], octaves: 3}\n"
    "          turn: {keys: {0 s: 0 deg/s, 1 s: 90 deg/s}, ease: in}\n"
    "    forces:\n"
    "      - gravity: {acceleration: [0, {age: {0 s: -9, 1 s: -1}, ease: smooth}, 0]}\n"
    "      - drag: {strength: {random: [0, 2]}, quadratic: {speed: {0: 0, 5 m/s: 0.5}}}\n"
    "      - wind: {velocity: {random: [[-1, 0, 0], [1, 0, 2]]},\n"
    "               pull: {height: {0 m: 0, 2 m: 3}, times: {life: [1, 0]}}}\n"
    "      - curl: {strength: {noise: [0, 2], per: particle, octaves: 2},\n"
    "              scale: {random: [0.3, 0.8]}}\n"
    "      - limit: {speed: {age: {0 s: 3 m/s, 0.4 s: 5 m/s}, repeat: loop,\n"
    "                times: {keys: {0 s: 1, 1 s: 2}}, plus: {random: [0 m/s, 1 m/s]}}}\n"
    "    collide:\n"
    "      randomness: {random: [0, 0.5]}\n"
    "      slowdown: {choose: [0.3, 0.9], weights: [1, 3]}\n"
    "      restitution: {speed: {0: 0.9, 4: 0.4}, ease: step}\n"
    "      friction: {life: [0, 0.4], times: {noise: [0, 2], per: particle}}\n"
    "  sparks:\n"
    "    emit:\n"
    "      parent: {system: a, on: {trail: {rate: {life: [0, 8], times: {random: [0, 2]}}}}}\n"
    "      life: {random: [0.1, 0.4]}\n"
    "      speed: {random: {0: 0, 0.9: 0.5, 1: 3}}\n"
    "    forces: [{gravity: {}}]\n"
    "  trail:\n"
    "    emit:\n"
    "      parent: {system: a, on: {trail: {rate: {keys: {0 s: 1, 0.7 s: 9, 1 s: 0}}}}}\n"
    "      life: 0.3 s\n";

/* Particles that collide and attract each other by values of every clock. */
static const char CROWD[] =
    "kiln: 1\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 1500, life: {random: [1 s, 2 s]}, from: {box: {origin: [0, 2, 0]}}}\n"
    "    forces: [{gravity: {}}]\n"
    "    interact:\n"
    "      - collide: {as_drawn: true}\n"
    "      - gravity: {strength: {random: [0, 0.02], times: {age: {0 s: 0, 1 s: 1}}}}\n"
    "    look: {size: {random: [0.02, 0.06], times: {life: [1, 0.5]}}, scale: {choose: [1, 2]}}\n";

static void flying_particles_agree(void **state)
{
    simulation_agree(*state, FLYING, NULL, steps());
}

static void crowds_agree(void **state)
{
    simulation_agree(*state, CROWD, NULL, steps() / 2);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(flying_particles_agree),
        test_on_device(crowds_agree),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    return test_list_run(&list, "values", argc, argv, simulation_device_open, test_device_close);
}
