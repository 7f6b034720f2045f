/* Bad values of a scene, and the exact words that say where, what was found and what is allowed. */
#include "support/bad_scenes.h"
#include "support/cmocka.h"

static const struct bad curves[] = {
    {"kiln: 1\n"
     "camera: {fov: {life: [40 deg, 50 deg]}}\n",
     ":2:16: camera.fov.life: cannot vary over life here; allowed is a constant or a "
     "mapping with keys or noise"},
    {"kiln: 1\n"
     "systems: {a: {look: {cycles: {life: [1, 2]}}}}\n",
     ":2:31: systems.a.look.cycles.life: cannot vary over life here; allowed is a constant or "
     "a mapping with keys, random, choose or noise"},
    {"kiln: 1\n"
     "output: {frames: {keys: {0 s: 1}}}\n",
     ":2:18: output.frames: expected a whole number from 1 to 1000000, found a mapping"},
    {"kiln: 1\n"
     "camera: {fov: {keys: [40 deg]}}\n",
     ":2:22: camera.fov.keys: expected a mapping {time: value, ...}, found a list"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {}}}\n",
     ":2:22: camera.fov.keys: found no keys; at least one is needed"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {now: 40 deg}}}\n",
     ":2:23: camera.fov.keys.now: expected a number from -100000 s to 1000000 s, found 'now'"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {0 s: [1]}}}\n",
     ":2:28: camera.fov.keys.0 s: expected a number from 1 deg to 170 deg, found a list"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {1 s: 40 deg, 0 s: 50 deg}}}\n",
     ":2:36: camera.fov.keys.0 s: the time of a key must be later than that of the key before it"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {1 s: 40 deg, 1000 ms: 50 deg}}}\n",
     ":2:36: camera.fov.keys.1000 ms: the time of a key must be later than that of the key before "
     "it"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {0 s: 40 deg}, life: [1]}}\n",
     ":2:37: camera.fov: expected one clock, found 'keys' and 'life'"},
    {"kiln: 1\n"
     "camera: {fov: {from: 1}}\n",
     ":2:15: camera.fov: expected a constant or a mapping with keys or noise, found a mapping"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {0 s: 40 deg}, eas: step}}\n",
     ":2:37: camera.fov.eas: unknown key (did you mean 'ease'?)"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {0 s: 40 deg}, ease: steps}}\n",
     ":2:43: camera.fov.ease: unknown word 'steps' (did you mean 'step'?)"},
    {"kiln: 1\n"
     "camera: {fov: {keys: {0 s: 40 deg}, period: 1 s}}\n",
     ":2:37: camera.fov: 'period' does not go with 'keys'"},
    {"kiln: 1\n"
     "camera: {fov: {noise: [40 deg, 50 deg], per: particle}}\n",
     ":2:46: camera.fov: a noise of each particle is not possible here; allowed is per: system"},
    {"kiln: 1\n"
     "camera: {fov: {noise: [40 deg, 50 deg], octaves: 9}}\n",
     ":2:50: camera.fov.octaves: 9 is out of range; allowed is from 1 to 8"},
    {"kiln: 1\n"
     "camera: {fov: {noise: [40 deg, 50 deg], period: 0 s}}\n",
     ":2:49: camera.fov.period: 0 s is out of range; allowed is from 0.001 s to 1000000 s"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {life: [0, 1], times: {random: [0, 1], times: 2}}}}}\n",
     ":2:67: systems.a.look.size.times: 'times' is not possible here"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {choose: [1, 2], weights: [1]}}}}\n",
     ":2:54: systems.a.look.size.weights: expected a list of 2 weights, one for each of what is "
     "chosen from"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {choose: [1, 2], weights: [0, 0]}}}}\n",
     ":2:54: systems.a.look.size.weights: one weight at least must be above 0"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {choose: {0: 1}}}}}\n",
     ":2:37: systems.a.look.size.choose: expected a list of what is chosen from, found a mapping"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {random: 3}}}}\n",
     ":2:37: systems.a.look.size.random: expected [least, ..., most] or {part: value}, found '3'"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {random: {0.5: 1, 0.2: 2}}}}}\n",
     ":2:46: systems.a.look.size.random.0.2: the quantile of a key must be above that of the key "
     "before it"},
    {"kiln: 1\n"
     "systems: {a: {look: {spin: {life: [0 deg/s, 90 deg/s], ease: smooth}}}}\n",
     ":2:62: systems.a.look.spin: ease: 'smooth' is not possible here; allowed is linear or step"},
    {"kiln: 1\n"
     "systems: {a: {look: {spin: {life: [0 deg/s, 90 deg/s], times: {random: [-1, 1]}}}}}\n",
     ":2:28: systems.a.look.spin: may reach -90 deg/s; allowed is a number from 0 deg/s to 36000 "
     "deg/s"},
    {"kiln: 1\n"
     "systems: {a: {emit: {speed: [{random: [1, 2]}, 3]}}}\n",
     ":2:31: systems.a.emit.speed.random: cannot vary over random here; allowed is a constant or "
     "a mapping with keys"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {life: [0, 1], seed: 3}}}}\n",
     ":2:43: systems.a.look.size: 'seed' does not go with 'life'"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {life: {0: 1, 2: 2}}}}}\n",
     ":2:42: systems.a.look.size.life.2: 2 is out of range; allowed is from 0 to 1"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {life: 3}}}}\n",
     ":2:35: systems.a.look.size.life: expected [first, ..., last] or {part of life: value}, found "
     "'3'"},
    {"kiln: 1\n"
     "systems: {a: {look: {size: {life: []}}}}\n",
     ":2:35: systems.a.look.size.life: found no keys; at least one is needed"},
    {"kiln: 1\n"
     "camera: {position: {keys: {0 s: [1, 2]}}}\n",
     ":2:33: camera.position.keys.0 s: expected [x, y, z], found a list"},
    {"kiln: 1\n"
     "camera: {position: {keys: {0 s: [1e5, 0, 0], 1e-40 s: [0, 0, 1]}}}\n",
     ":2:46: camera.position.keys.1e-40 s: the time of a key must be later than that of the key "
     "before it"},
    {"kiln: 1\n"
     "camera: {position: {keys: {0 s: [0, 1e5, 0], 1e-30: 0}}}\n",
     ":2:53: camera.position.keys.1e-30: expected [x, y, z], found '0'"},
};

static const struct bad distances[] = {
    {"kiln: 1\n"
     "systems:\n"
     "  a:\n"
     "    interact: [{collide: {as_drawn: true}}]\n"
     "    look: {size: {distance: {0: 1, 9: 2}}}\n",
     ":5:18: systems.a.look.size: cannot vary over the distance to the eye, since particles "
     "collide "
     "as they are drawn"},
    {"kiln: 1\n"
     "systems: {a: {emit: {speed: {distance: {0: 1}}}}}\n",
     ":2:30: systems.a.emit.speed.distance: cannot vary over distance here; allowed is a constant "
     "or a mapping with keys, random, choose or noise"},
    {"kiln: 1\n"
     "systems: {a: {emit: {from: {cone: {direction: {choose: [[0, 1, 0], [0, 0, 0]]}}}}}}\n",
     ":2:47: systems.a.emit.from.cone.direction: must not be [0, 0, 0]"},
};

BAD_TEST(curves)
BAD_TEST(distances)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_curves),
        cmocka_unit_test(bad_distances),
    };
    return cmocka_run_group_tests_name("value_errors", tests, NULL, NULL);
}
