/* lib/scene: bad scenes, and the exact words that say where, what was found and what is allowed. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "scene/options.h"
#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/scenes.h"

#define ATLASES                                                                                    \
    "\"builtin:fire\", \"builtin:flame\", \"builtin:tongue\", \"builtin:smoke\", "                 \
    "\"builtin:puff\", "                                                                           \
    "\"builtin:spark\", \"builtin:star\", \"builtin:drop\", \"builtin:splash\", "                  \
    "\"builtin:debris\", \"builtin:trail\", \"builtin:band\", or the path of an image or video "   \
    "file, "                                                                                       \
    "from the scene's folder and inside it; or a list of 1 to 8 of these"

#define FOUR(name, first)                                                                          \
    name first "0: {}, " name first "1: {}, " name first "2: {}, " name first "3: {}, "
#define EIGHT(name) FOUR(name, "a") FOUR(name, "b")

static const struct bad keys[] = {
    {"kiln: 1\n"
     "systems:\n"
     "  smoke:\n"
     "    emit: {raet: 5}\n",
     ":4:12: systems.smoke.emit.raet: unknown key (did you mean 'rate'?)"},
    {"kiln: 1\n"
     "colour: red\n",
     ":2:1: colour: unknown key (there are: kiln, include, params, seed, output, simulation, "
     "nodes, camera, backdrop, systems, gas, post)"},
    {"kiln: 1\n"
     "seed: 1\n"
     "seed: 2\n",
     ":3:1: duplicate key 'seed' (first in line 2)"},
    {"kiln: 1\n"
     "<<: 5\n",
     ":2:5: <<: expected a mapping or a list of mappings"},
    {"kiln: 1\n"
     "[a, b]: 3\n",
     ":2:1: a key must be a word, not a list or mapping"},
    {"kiln: 1\n"
     "'': 3\n",
     ":2:1: empty key"},
    {"kiln: 1\n"
     "\"a\\e[31mb\": 3\n",
     ":2:1: a\\x1b[31mb: unknown key (there are: kiln, include, params, seed, output, simulation, "
     "nodes, camera, backdrop, systems, gas, post)"},
    {"seed: 1\n", ":1:1: kiln: the key is missing and must be given"},
    {"kiln: 2\n", ":1:7: kiln: 2 is out of range; allowed is 1"},
};

static const struct bad texts[] = {
    {"", ": the file is empty; a scene starts with 'kiln: 1'"},
    {"# nothing here\n", ": the file is empty; a scene starts with 'kiln: 1'"},
    {"hello\n", ":1:1: expected a mapping of keys, found 'hello'"},
    {"- 1\n", ":1:1: expected a mapping of keys, found a list"},
    {"kiln: *x\n", ":1:7: there is no anchor 'x' above"},
    {"kiln: !!int 1\n", ":1:13: tags are not allowed"},
    {"kiln: 1\n"
     "---\n"
     "kiln: 1\n",
     ":2:1: a scene has one document; a second one starts here"},
    {"kiln: [1, 2\n"
     "seed: 4\n",
     ":3:1: not valid YAML: flow sequence without a closing bracket"},
    {"kiln: \"abc\n", ":1:8: not valid YAML: double-quoted scalar without closing quote"},
    {"kiln: 1\n"
     "\tseed: 4\n",
     ":1:7: not valid YAML: invalid multiline plain key"},
    {"kiln: 1\n"
     "seed: \"a\\0b\"\n",
     ":2:8: a text must not contain zero bytes"},
    {"kiln: 1\nseed: \"1\\\n  2\"\n",
     ":2:8: a backslash must not continue a quoted text in the next line"},
};

static const struct bad types[] = {
    {"kiln: 1\n"
     "seed: abc\n",
     ":2:7: seed: expected a whole number from 0 to 4294967295, found 'abc'"},
    {"kiln: 1\n"
     "seed: [1]\n",
     ":2:7: seed: expected a whole number from 0 to 4294967295, found a list"},
    {"kiln: 1\n"
     "seed: {a: 1}\n",
     ":2:7: seed: expected a whole number from 0 to 4294967295, found a mapping"},
    {"kiln: 1\n"
     "seed: \"7\"\n",
     ":2:7: seed: expected a whole number from 0 to 4294967295, found the text \"7\""},
    {"kiln: 1\n"
     "seed:\n",
     ":2:1: seed: expected a whole number from 0 to 4294967295, found nothing"},
    {"kiln: 1\n"
     "seed: 1.5\n",
     ":2:7: seed: expected a whole number from 0 to 4294967295, found '1.5'"},
    {"kiln: 1\n"
     "post: {dither: yes}\n",
     ":2:16: post.dither: expected true or false, found 'yes'"},
    {"kiln: 1\n"
     "post: {tonemap: agxx}\n",
     ":2:17: post.tonemap: unknown word 'agxx' (did you mean 'agx'?)"},
    {"kiln: 1\n"
     "post: {tonemap: film}\n",
     ":2:17: post.tonemap: expected none, agx or aces, found 'film'"},
    {"kiln: 1\n"
     "post: 3\n",
     ":2:7: post: expected a mapping of keys, found '3'"},
    {"kiln: 1\n"
     "output: {fps: fast}\n",
     ":2:15: output.fps: expected a rate like 30, 29.97 or 30000/1001 from 1 to 1000, found "
     "'fast'"},
    {"kiln: 1\n"
     "output: {fps: 30/0}\n",
     ":2:15: output.fps: expected a rate like 30, 29.97 or 30000/1001 from 1 to 1000, found "
     "'30/0'"},
    {"kiln: 1\n"
     "output: {size: 720}\n",
     ":2:16: output.size: expected two whole numbers [a, b], each from 16 px to 16384 px, found "
     "'720'"},
    {"kiln: 1\n"
     "camera: {position: [1, 2]}\n",
     ":2:20: camera.position: expected [x, y, z], each from -100000 m to 100000 m, or {keys: "
     "{time: value}}, found a list"},
    {"kiln: 1\n"
     "camera: {position: 3}\n",
     ":2:20: camera.position: expected [x, y, z], each from -100000 m to 100000 m, or {keys: "
     "{time: value}}, found '3'"},
    {"kiln: 1\n"
     "camera: {position: [1, 2, x]}\n",
     ":2:27: camera.position.2: expected a number from -100000 m to 100000 m, found 'x'"},
    {"kiln: 1\n"
     "systems: [a]\n",
     ":2:10: systems: expected a mapping of up to 64 names to mappings of keys, found a list"},
    {"kiln: 1\n"
     "systems: {a: {collide: true}}\n",
     ":2:24: systems.a.collide: expected a mapping of keys, or none, found 'true'"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: 9}}}\n",
     ":2:30: systems.a.emit.bursts: expected {time: particles, ...}, each number of particles a "
     "whole number from 0 to 33554432, or a list of bursts, found '9'"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [1]}}}\n",
     ":2:31: systems.a.emit.bursts.0: expected a mapping of keys, found '1'"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{at: 0 s}]}}}\n",
     ":2:31: systems.a.emit.bursts.0.count: the key is missing and must be given"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{count: [30, 20]}]}}}\n",
     ":2:39: systems.a.emit.bursts.0.count: 30 is above 20; the least number comes first"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{count: [1, 2, 3]}]}}}\n",
     ":2:39: systems.a.emit.bursts.0.count: expected a whole number from 0 to 33554432, or the "
     "least and the greatest of those that are drawn, [a, b], found a list"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{count: 1, every: 0.1 ms}]}}}\n",
     ":2:49: systems.a.emit.bursts.0.every: must be 0 s, for a burst that is not repeated, or at "
     "least 0.001 s; found 0.0001 s"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{count: 1, every: 1 s, jitter: 2 s}]}}}\n",
     ":2:62: systems.a.emit.bursts.0.jitter: must be at most `every`, 1 s; found 2 s"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{at: 0.5 s, count: 1, every: 1 ms}]}}}\n"
     "output: {fps: 10}\n"
     "simulation: {rate: 10}\n",
     ":2:30: systems.a.emit.bursts: the step at 0.5 s has more than 64 bursts: let them be less "
     "frequent"},
    {"kiln: 1\n"
     "systems: {a: {collide: {dies: true, then: stop}}}\n",
     ":2:43: systems.a.collide.then: must not be stop where `dies` is true"},
    {"kiln: 1\n"
     "systems: {a: {collide: {dies: true, then: bounce}}}\n",
     ":2:43: systems.a.collide.then: must not be bounce where `dies` is true"},
    {"kiln: 1\n"
     "systems: {a: {collide: {then: die, dies: false}}}\n",
     ":2:31: systems.a.collide.then: must not be die where `dies` is false"},
    {"kiln: 1\n"
     "systems: {a: {collide: {chance: 0.5}}}\n",
     ":2:33: systems.a.collide.chance: needs a `then` other than bounce, which is what particles "
     "do by the rest of the chance"},
    {"kiln: 1\n"
     "systems: {a: {collide: {then: bounce, chance: {life: [0, 1]}}}}\n",
     ":2:47: systems.a.collide.chance: needs a `then` other than bounce, which is what particles "
     "do by the rest of the chance"},
    {"kiln: 1\n"
     "systems: {a: {collide: {then: stop}, interact: [collide: {}]}}\n",
     ":2:31: systems.a.collide.then: must not be stop where particles interact, since nothing "
     "pushes a particle that has stopped"},
    {"kiln: 1\n"
     "systems: {a: {collide: {dies: true, then: stick}}}\n",
     ":2:43: systems.a.collide.then: must not be stick where `dies` is true"},
    {"kiln: 1\n"
     "systems: {a: {collide: {then: stick}, interact: [collide: {}]}}\n",
     ":2:31: systems.a.collide.then: must not be stick where particles interact, since nothing "
     "pushes a particle that has stopped"},
    {"kiln: 1\n"
     "systems: {a: {forces: [drag: {region: {falloff: 1 m}}]}}\n",
     ":2:39: systems.a.forces.0.drag.region: must have one of `box` and `sphere`, found "
     "neither"},
    {"kiln: 1\n"
     "systems: {a: {forces: [gravity: {region: {box: {}, sphere: {}}}]}}\n",
     ":2:42: systems.a.forces.0.gravity.region: must have one of `box` and `sphere`, found both"},
    {"kiln: 1\n"
     "systems: {a: {bounds: {min: [0, 0, 0]}}}\n",
     ":2:23: systems.a.bounds: expected {min: [x, y, z], max: [x, y, z]}, each number from -100000 "
     "m to 100000 m, or none, found a mapping"},
    {"kiln: 1\n"
     "systems: {a: {look: {atlas: []}}}\n",
     ":2:29: systems.a.look.atlas: expected " ATLASES ", found a list"},
    {"kiln: 1\n"
     "systems: {a: {look: {atlas: [builtin:fire, 3]}}}\n",
     ":2:44: systems.a.look.atlas: expected " ATLASES ", found '3'"},
    {"kiln: 1\n"
     "systems: {a: {look: {atlas: [a]}}}\n",
     ":2:30: systems.a.look.atlas: cannot open 'a': No such file or directory"
     "; a path starts at the scene's folder, or at the asset root that is given instead"},
    {"kiln: 1\n"
     "systems: {a: {look: {motion: builtin:fire}}}\n",
     ":2:30: systems.a.look.motion: expected auto, none, or the path of an image file, from the "
     "scene's folder and inside it, found 'builtin:fire'"},
    {"kiln: 1\n"
     "systems: {a: {look: {atlas: ''}}}\n",
     ":2:29: systems.a.look.atlas: expected " ATLASES ", found the text \"\""},
};

static const struct bad limits[] = {
    {"kiln: 1\n"
     "seed: -1\n",
     ":2:7: seed: -1 is out of range; allowed is from 0 to 4294967295"},
    {"kiln: 1\n"
     "seed: 4294967296\n",
     ":2:7: seed: 4294967296 is out of range; allowed is from 0 to 4294967295"},
    {"kiln: 1\n"
     "output: {frames: 0}\n",
     ":2:18: output.frames: 0 is out of range; allowed is from 1 to 1000000"},
    {"kiln: 1\n"
     "output: {frames: 1000001}\n",
     ":2:18: output.frames: 1000001 is out of range; allowed is from 1 to 1000000"},
    {"kiln: 1\n"
     "output: {size: [8, 720]}\n",
     ":2:17: output.size: 8 is out of range; allowed is from 16 px to 16384 px"},
    {"kiln: 1\n"
     "output: {size: [720, 100000]}\n",
     ":2:22: output.size: 100000 is out of range; allowed is from 16 px to 16384 px"},
    {"kiln: 1\n"
     "output: {fps: 2000}\n",
     ":2:15: output.fps: expected a rate like 30, 29.97 or 30000/1001 from 1 to 1000, found "
     "'2000'"},
    {"kiln: 1\n"
     "camera: {near: .nan}\n",
     ":2:16: camera.near: .nan is not a finite number"},
    {"kiln: 1\n"
     "camera: {near: -.inf}\n",
     ":2:16: camera.near: -.inf is not a finite number"},
    {"kiln: 1\n"
     "camera: {near: nan}\n",
     ":2:16: camera.near: nan is not a finite number"},
    {"kiln: 1\n"
     "camera: {near: 1e39}\n",
     ":2:16: camera.near: 1e39 is out of range; allowed is from 0.001 m to 100 m"},
    {"kiln: 1\n"
     "camera: {near: 1e999}\n",
     ":2:16: camera.near: expected a number from 0.001 m to 100 m, found '1e999'"},
    {"kiln: 1\n"
     "camera: {fov: 200 deg}\n",
     ":2:15: camera.fov: 200 deg is out of range; allowed is from 1 deg to 170 deg"},
    {"kiln: 1\n"
     "systems: {a: {emit: {life: [3, 2]}}}\n",
     ":2:28: systems.a.emit.life: the first must not be above the second"},
    {"kiln: 1\n"
     "systems: {a: {emit: {life: [{keys: {0 s: 1, 1 s: 5}}, 2]}}}\n",
     ":2:28: systems.a.emit.life: the first must not be above the second"},
    {"kiln: 1\n"
     "systems: {a: {emit: {life: 0}}}\n",
     ":2:28: systems.a.emit.life: 0 is out of range; allowed is from 0.001 s to 10000 s"},
    {"kiln: 1\n"
     "systems: {a: {bounds: {min: [0, 0, 0], max: [1, 0, 1]}}}\n",
     ":2:23: systems.a.bounds: min must be below max in x, y and z"},
    {"kiln: 1\n"
     "systems: {a b: {}}\n",
     ":2:11: systems.a b: a name starts with a letter and has at most 32 letters, digits, '_' and "
     "'-'"},
    {"kiln: 1\n"
     "systems: {'': {}}\n",
     ":2:11: empty key"},
    {"kiln: 1\n"
     "systems: {" EIGHT("a") EIGHT("b") EIGHT("c") EIGHT("d") EIGHT("e") EIGHT("f") EIGHT("g")
         EIGHT("h") "one_more: {}}\n",
     ":2:10: systems: found 65 entries; at most 64 are allowed"},
    {"kiln: 1\n"
     "systems: {a: {demitters: [{min: [0, 0, 0], max: [1, 1, 1]}, {min: [0, 0, 0], max: [1, 1, "
     "1]}, {min: [0, 0, 0], max: [1, 1, 1]}, {min: [0, 0, 0], max: [1, 1, 1]}, {min: [0, 0, 0], "
     "max: [1, 1, 1]}, {min: [0, 0, 0], max: [1, 1, 1]}, {min: [0, 0, 0], max: [1, 1, 1]}, {min: "
     "[0, 0, 0], max: [1, 1, 1]}, {min: [0, 0, 0], max: [1, 1, 1]}]}}\n",
     ":2:26: systems.a.demitters: found 9 entries; at most 8 are allowed"},
};

static const struct bad units[] = {
    {"kiln: 1\n"
     "camera: {fov: 45}\n",
     ":2:15: camera.fov: an angle needs its unit: 45 deg or 45 rad"},
    {"kiln: 1\n"
     "camera: {fov: 45 s}\n",
     ":2:15: camera.fov: unit 's' is wrong; allowed is deg or rad"},
    {"kiln: 1\n"
     "camera: {near: 5 %}\n",
     ":2:16: camera.near: unit '%' is wrong; allowed is m, cm or mm"},
    {"kiln: 1\n"
     "output: {frames: 3 s}\n",
     ":2:18: output.frames: unit 's' is wrong; this number takes no unit"},
    {"kiln: 1\n"
     "systems: {a: {look: {shape: ball}}}\n",
     ":2:29: systems.a.look.shape: expected billboard, point, line, sphere, mesh or ribbon, found "
     "'ball'"},
    {"kiln: 1\n"
     "systems: {a: {look: {facing: {normal: [0, 0, 0]}}}}\n",
     ":2:39: systems.a.look.facing.normal: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "systems: {a: {look: {facing: surface}}}\n",
     ":2:30: systems.a.look.facing: no particle rests on a surface: set systems.a.collide.then to "
     "stop "
     "or stick, or let impacts give birth to particles without a speed (emit.parent.on)"},
    {"kiln: 1\n"
     "systems: {a: {collide: {}}, b: {emit: {parent: {system: a, on: {bounce: 1}}},\n"
     "  look: {facing: surface}, interact: [collide: {radius: 1 cm}]}}\n",
     ":3:18: systems.b.look.facing: must not be surface where particles interact, since nothing "
     "pushes a particle that rests from its birth"},
    {"kiln: 1\n"
     "systems: {a: {look: {facing: eye}}}\n",
     ":2:30: systems.a.look.facing: expected screen, viewplane, viewpoint, axial, velocity or "
     "surface, "
     "or {normal: [x, y, z]}, "
     "found 'eye'"},
    {"kiln: 1\n"
     "systems: {a: {look: {point: {size: 3 m}}}}\n",
     ":2:36: systems.a.look.point.size: unit 'm' is wrong; allowed is px"},
    {"kiln: 1\n"
     "systems: {a: {look: {line: {width: -1}}}}\n",
     ":2:36: systems.a.look.line.width: -1 is out of range; allowed is from 0 px to "
     "1000 px"},
    {"kiln: 1\n"
     "systems: {a: {look: {spin: [0, 3]}}}\n",
     ":2:32: systems.a.look.spin: an angle needs its unit: 3 deg/s or 3 rad/s"},
    {"kiln: 1\n"
     "systems: {a: {look: {fade: {in: 3 s}}}}\n",
     ":2:33: systems.a.look.fade.in: unit 's' is wrong; allowed is none or %"},
    {"kiln: 1\n"
     "systems: {a: {emit: {life: 2 minutes}}}\n",
     ":2:28: systems.a.emit.life: unit 'minutes' is wrong; allowed is s, ms, min or h"},
};

static const struct bad kinds[] = {
    {"kiln: 1\n"
     "systems: {a: {forces: [{gravty: [0, 1, 0]}]}}\n",
     ":2:25: systems.a.forces.0.gravty: unknown kind (did you mean 'gravity'?)"},
    {"kiln: 1\n"
     "systems: {a: {forces: [{gravity: [0, 1, 0], drag: 1}]}}\n",
     ":2:45: systems.a.forces.0: expected one kind, found 'gravity' and 'drag'"},
    {"kiln: 1\n"
     "systems: {a: {forces: [{wind: {field: crul}}]}}\n",
     ":2:39: systems.a.forces.0.wind.field: unknown word 'crul' (did you mean 'curl'?)"},
    {"kiln: 1\n"
     "systems: {a: {forces: [{wind: {field: [curl]}}]}}\n",
     ":2:39: systems.a.forces.0.wind.field: expected a word, found a list"},
    {"kiln: 1\n"
     "systems: {a: {forces: [{wind: {octaves: 2}}]}}\n",
     ":2:32: systems.a.forces.0.wind.octaves: unknown key (there are: velocity, pull, mode, "
     "attach, region)"},
    {"kiln: 1\n"
     "systems: {a: {emit: {from: {}}}}\n",
     ":2:28: systems.a.emit.from: expected {point, sphere, box, disc, ring, cone, line, mesh, "
     "image or path: {...}}, "
     "found "
     "a "
     "mapping"},
    {"kiln: 1\n"
     "systems: {a: {emit: {from: cone}}}\n",
     ":2:28: systems.a.emit.from: expected {point, sphere, box, disc, ring, cone, line, mesh, "
     "image or path: {...}}, "
     "found "
     "'cone'"},
    {"kiln: 1\n"
     "systems: {a: {emit: {from: {cone: 5}}}}\n",
     ":2:35: systems.a.emit.from.cone: expected a mapping of keys, found '5'"},
    {"kiln: 1\n"
     "systems: {a: {emit: {from: {point: {radius: 1}}}}}\n",
     ":2:37: systems.a.emit.from.point.radius: unknown key (there are: origin, direction, angle)"},
};

static const struct bad agreement[] = {
    {"kiln: 1\n"
     "systems: {a: {look: {cells: [64, 33]}}}\n",
     ":2:29: systems.a.look.cells: found 2112 cells; at most 2048 are allowed"},
    {"kiln: 1\n"
     "systems: {a: {look: {axis: [0, 0, 0]}}}\n",
     ":2:28: systems.a.look.axis: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "systems: {a: {look: {axis: {keys: {0 s: [1, 0, 0], 2 s: [0, 0, 0]}}}}}\n",
     ":2:28: systems.a.look.axis: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "systems: {a: {look: {shape: sphere, blend: add}}}\n",
     ":2:44: systems.a.look.blend: must be alpha for spheres, which cover what is behind"},
    {"kiln: 1\n"
     "systems: {a: {look: {shape: mesh}}}\n",
     ":2:21: systems.a.look.mesh.file: must name a file where shape is mesh"},
    {"kiln: 1\n"
     "simulation: {rate: 50}\n",
     ":2:20: simulation.rate: must be a whole multiple of output.fps; the nearest are 30 and 60"},
    {"kiln: 1\n"
     "output: {fps: 29.97}\n"
     "simulation: {rate: 60}\n",
     ":3:20: simulation.rate: must be a whole multiple of output.fps; the nearest are "
     "60000/1001 and 90000/1001"},
    {"kiln: 1\n"
     "output: {fps: 24000/1001}\n"
     "simulation: {rate: 60}\n",
     ":3:20: simulation.rate: must be a whole multiple of output.fps; the nearest are 48000/1001 "
     "and 72000/1001"},
    {"kiln: 1\n"
     "output: {fps: 240}\n"
     "simulation: {rate: 60}\n",
     ":3:20: simulation.rate: must be a whole multiple of output.fps; the nearest is 240"},
    {"kiln: 1\n"
     "output: {frames: 1000000}\n"
     "simulation: {rate: 300}\n",
     ":2:18: output.frames: the clip and its warm-up have 9999990 steps; a run has at most "
     "4194303"},
    {"kiln: 1\n"
     "camera: {position: [1, 2, 3], target: [1, 2, 3]}\n",
     ":2:39: camera.target: must not be the position of the camera"},
    {"kiln: 1\n"
     "camera: {position: {keys: {0 s: [0, 0, 0], 1 s: [0, 1, 0]}}, target: [0, 1, 0]}\n",
     ":2:70: camera.target: must not be the position of the camera"},
    {"kiln: 1\n"
     "backdrop: {floor: {height: {keys: {0 s: 0, 1 s: 1}}}}\n",
     ":2:28: backdrop.floor.height: cannot vary while the floor collides; set "
     "backdrop.floor.collide to false"},
    {"kiln: 1\n"
     "backdrop: {sun: {direction: [0, 0, 0]}}\n",
     ":2:29: backdrop.sun.direction: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "backdrop: {lights: [point: {}, spot: {direction: [0, 0, 0]}]}\n",
     ":2:50: backdrop.lights.1.spot.direction: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "backdrop: {lights: [rectangle: {direction: {keys: {0 s: [1, 0, 0], 1 s: [0, 0, 0]}}}]}\n",
     ":2:44: backdrop.lights.0.rectangle.direction: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "systems: {a: {emit: {from: {cone: {direction: [0, 0, 0]}}}}}\n",
     ":2:47: systems.a.emit.from.cone.direction: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: {1 s: 5, 500 ms: 1}}}}\n",
     ":2:39: systems.a.emit.bursts.500 ms: the time of a burst must be later than that of the "
     "burst before it"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 10000000, life: 100 s}}}\n",
     ":2:21: systems.a.emit: up to 49666667 particles at once need 1515 MiB; the systems of a "
     "scene may have 33554432 in all (1024 MiB), of which 0 are taken: lower rate, bursts or life"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: {1 s: 20000000}}}, b: {emit: {bursts: {1 s: 20000000}}}}\n",
     ":2:59: systems.b.emit: up to 20000000 particles at once need 610 MiB; the systems of a scene "
     "may have 33554432 in all (1024 MiB), of which 20000000 are taken: lower rate, bursts or "
     "life"},
    {"kiln: 1\n"
     "output: {frames: 100000}\n"
     "systems: {a: {emit: {rate: 10000000, life: 0.1 s}}}\n",
     ":3:21: systems.a.emit: the run has 33333000000 births; at most 4294967295 are allowed"},
};

BAD_TEST(keys)
BAD_TEST(texts)
BAD_TEST(types)
BAD_TEST(limits)
BAD_TEST(units)
BAD_TEST(kinds)
BAD_TEST(agreement)

static void expect_generated(char *text, const char *message)
{
    struct bad bad = {text, message};
    expect_all(&bad, 1);
    free(text);
}

/* `count` times a piece between a start and an end; freed by expect_generated. */
static char *repeat(const char *start, const char *piece, size_t count, const char *end)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    fputs(start, out);
    for (size_t i = 0; i < count; i++)
        fputs(piece, out);
    fputs(end, out);
    assert_int_equal(fclose(out), 0);
    return text;
}

static void bad_growth(void **state)
{
    (void)state;
    expect_generated(repeat("kiln: ", "[", 100000, "\n"),
                     ":1:70: nested deeper than the 64 levels that are allowed");
    expect_generated(repeat("kiln: ", "{a: ", 100000, "\n"),
                     ":1:259: nested deeper than the 64 levels that are allowed");
    expect_generated(repeat("kiln: [", "1,", 5000, "]\n"),
                     ":1:2056: more than 1024 entries in one list or mapping; no more are allowed");
    /* Wide within each limit, but not in all. */
    char *row = repeat("  - [", "1,", 999, "1]\n");
    expect_generated(repeat("kiln:\n", row, 300, ""),
                     ":263:1764: more than 262144 entries in all; no more are allowed");
    free(row);
}

/* Appends the names of all kinds of force, as a message lists them: "gravity, drag or wind". */
static void add_force_names(struct kiln_text *text)
{
    const char *before = NULL; /* the name that is not in the text yet */
    for (const struct kiln_option_kind *kind = kiln_force_kinds; kind->name; kind++) {
        if (before && strcmp(kind->name, before) == 0)
            continue; /* another variant of the same name */
        if (before)
            kiln_text_add(text, "%s%s", text->length ? ", " : "", before);
        before = kind->name;
    }
    kiln_text_add(text, " or %s", before);
}

/* The messages that list the kinds of force. */
static void bad_forces(void **state)
{
    (void)state;
    static const struct {
        const char *forces, *where, *found;
    } cases[] = {
        {"{drag: 1}", ":2:23: systems.a.forces: expected a list of up to 32: ", "a mapping"},
        {"[gravity]", ":2:24: systems.a.forces.0: expected ", "'gravity'"},
        {"[{}]", ":2:24: systems.a.forces.0: expected ", "a mapping"},
    };
    struct kiln_text names = {0};
    add_force_names(&names);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[64], message[KILN_MESSAGE_SIZE];
        snprintf(text, sizeof text, "kiln: 1\nsystems: {a: {forces: %s}}\n", cases[i].forces);
        snprintf(message, sizeof message, "%s{%s: {...}}, found %s", cases[i].where, names.data,
                 cases[i].found);
        expect_generated(strdup(text), message);
    }
    kiln_text_free(&names);
}

/* Every key of all scenes lies in one table. A curve has up to 1024 of them. */
static void bad_key_count(void **state)
{
    (void)state;
    enum { CURVES = 64, KEYS = KILN_MAX_VALUE_KEYS / CURVES, ROOM = 2 << 20 };
    char *text = malloc(ROOM);
    assert_non_null(text);
    size_t length = (size_t)snprintf(text, ROOM, "kiln: 1\nsystems:\n");
    for (int curve = 0; curve < CURVES; curve++) {
        length +=
            (size_t)snprintf(text + length, ROOM - length, "  s%d: {look: {size: {keys: {", curve);
        for (int i = 0; i < KEYS; i++)
            length += (size_t)snprintf(text + length, ROOM - length, "%s%d: %d cm", i ? ", " : "",
                                       i, 1 + (i + curve) % 9);
        length += (size_t)snprintf(text + length, ROOM - length, "}}}}\n");
    }
    struct kiln_scene *scene = load_scene(text, NULL);
    assert_int_equal(scene->key_count, KILN_MAX_VALUE_KEYS);
    const struct kiln_value *size = &scene->systems[63].look.size;
    for (uint32_t i = 0; i < KEYS; i++) {
        assert_true(scene->keys[size->first + i].x == (float)i);
        assert_true(fabsf(scene->keys[size->first + i].y - 0.01f * (float)(1 + (i + 63) % 9)) <
                    1e-7f);
    }
    kiln_scene_destroy(&scene);

    snprintf(text + length, ROOM - length, "camera: {roll: {keys: {0: 0}}}\n");
    expect_generated(text, ":66:29: systems.s63.look.size.keys: 1024 keys are too many; a scene "
                           "has at most 65536, and 64513 of them are used already");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_keys),      cmocka_unit_test(bad_texts),
        cmocka_unit_test(bad_types),     cmocka_unit_test(bad_limits),
        cmocka_unit_test(bad_units),     cmocka_unit_test(bad_kinds),
        cmocka_unit_test(bad_agreement), cmocka_unit_test(bad_growth),
        cmocka_unit_test(bad_key_count), cmocka_unit_test(bad_forces),
    };
    return cmocka_run_group_tests_name("scene_errors", tests, NULL, NULL);
}
