/* Bad nodes, paths and attached parts of a scene, and the exact words that say where, what was
 * found and what is allowed. */
#include "support/bad_scenes.h"
#include "support/cmocka.h"

static const struct bad nodes[] = {
    {"kiln: 1\n"
     "nodes: {a: {parent: b}}\n",
     ":2:21: nodes.a.parent: unknown node 'b' (there are: a)"},
    {"kiln: 1\n"
     "nodes: {rocket: {}, booster: {parent: rockt}}\n",
     ":2:39: nodes.booster.parent: unknown node 'rockt' (did you mean 'rocket'?)"},
    {"kiln: 1\n"
     "nodes: {a: {parent: a}}\n",
     ":2:21: nodes.a.parent: the node is its own parent: a, a; the first node of a chain has no "
     "parent"},
    {"kiln: 1\n"
     "nodes: {x: {parent: a}, a: {parent: b}, b: {parent: c}, c: {parent: a}}\n",
     ":2:37: nodes.a.parent: the node is its own parent: a, b, c, a; the first node of a chain has "
     "no parent"},
    {"kiln: 1\n"
     "nodes: {none: {}, b: {parent: none}}\n",
     ":2:15: nodes.none: must have another name, since none stands for no node"},
    {"kiln: 1\n"
     "nodes: {a: {heading: path}}\n",
     ":2:22: nodes.a.heading: needs a position that is a path"},
    {"kiln: 1\n"
     "nodes: {a: {ahead: w}}\n",
     ":2:20: nodes.a.ahead: expected z, y, x, -z, -y or -x, found 'w'"},
    {"kiln: 1\n"
     "nodes: {a: {scale: 0}}\n",
     ":2:20: nodes.a.scale: 0 is out of range; allowed is from 1e-06 to 100000"},
    {"kiln: 1\n"
     "nodes: {a: {position: 1}}\n",
     ":2:23: nodes.a.position: expected [x, y, z], each from -100000 m to 100000 m, or {path: "
     "{...}}, or {keys: {time: value}}, found '1'"},
};

static const struct bad paths[] = {
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {over: [0 s, 1 s]}}}}\n",
     ":2:30: nodes.a.position.path.points: the key is missing and must be given"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0], [1, 0, 0]]}}}}\n",
     ":2:30: nodes.a.position.path.over: the key is missing and must be given"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0]], over: [0 s, 1 s]}}}}\n",
     ":2:39: nodes.a.position.path.points: found 1 point; allowed is from 2 to 1024"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0], [0, 0, 0]], over: [0 s, 1 s]}}}}\n",
     ":2:51: nodes.a.position.path.points.1: must not be the point before it"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0], [0, 0]], over: [0 s, 1 s]}}}}\n",
     ":2:51: nodes.a.position.path.points.1: expected [x, y, z], found a list"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0], [1, 0, 0]], over: 1 s}}}}\n",
     ":2:69: nodes.a.position.path.over: expected two times, [first, last], of which the second is "
     "the later one, found 1 s and 1 s"},
    {"kiln: 1\n"
     "output: {fps: 10, frames: 100}\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0], [1, 0, 0]], over: [10 %, 10 %]}}}}\n",
     ":3:69: nodes.a.position.path.over: expected two times, [first, last], of which the second is "
     "the later one, found 1 s and 1 s"},
    {"kiln: 1\n"
     "nodes: {a: {position: {points: [[0, 0, 0], [1, 0, 0]], over: [0 s, 1 s]}}}\n",
     ":2:23: nodes.a.position: a curve through points is written {path: {points: [...], over: "
     "[...]}}"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {points: [[0, 0, 0], [1, 0, 0]], over: [0, 1], closed: "
     "true}}}}\n",
     ":2:39: nodes.a.position.path.points: found 2 points; a closed path has 3 at least"},
    {"kiln: 1\n"
     "nodes:\n"
     "  a: {position: {path: {points: [[0, 0, 0], [1, 0, 0], [0, 0, 0]], over: [0, 1], closed: "
     "true}}}\n",
     ":3:33: nodes.a.position.path.points: the last point must not be the first; a closed path "
     "goes "
     "on to the first by itself"},
    {"kiln: 1\n"
     "nodes: {a: {position: {path: {}, keys: {}}}}\n",
     ":2:34: nodes.a.position.keys: unknown key (there are: path)"},
};

static const struct bad attached[] = {
    {"kiln: 1\n"
     "camera: {attach: a}\n",
     ":2:18: camera.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "nodes: {a: {}}\n"
     "camera: {attach: a, position: {keys: {0 s: [0, 0, 0], 1 s: [1, 0, 0]}}}\n",
     ":3:31: camera.position: varies within a node, so the camera needs a target, too"},
    {"kiln: 1\n"
     "nodes: {a: {}}\n"
     "camera: {attach: a, aperture: 10 cm}\n",
     ":3:9: camera.focus: must be a distance, such as 5 m, where a camera with an aperture has no "
     "target in its node"},
    {"kiln: 1\n"
     "nodes: {a: {}}\n"
     "camera: {attach: a, position: [1, 0, 0], aperture: {keys: {0 s: 0, 1 s: 1 cm}}, focus: "
     "target}\n",
     ":3:88: camera.focus: must be a distance, such as 5 m, where a camera with an aperture has no "
     "target in its node"},
    {"kiln: 1\n"
     "backdrop: {objects: [{sphere: {}}, {box: {attach: a}}]}\n",
     ":2:51: backdrop.objects.1.box.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "backdrop: {objects: [{terrain: {attach: a}}]}\n",
     ":2:33: backdrop.objects.0.terrain.attach: unknown key (there are: image, position, size, "
     "samples, hills, octaves, roughness, ridges, seed, color, collide, restitution, friction)"},
    {"kiln: 1\n"
     "backdrop: {lights: [{spot: {attach: a}}]}\n",
     ":2:37: backdrop.lights.0.spot.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "systems: {s: {emit: {attach: a}}}\n",
     ":2:30: systems.s.emit.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "systems: {s: {forces: [{drag: 1}, {vortex: {attach: a}}]}}\n",
     ":2:53: systems.s.forces.1.vortex.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "systems: {s: {forces: [{wind: {field: vortex, attach: a}}]}}\n",
     ":2:55: systems.s.forces.0.wind.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "systems: {s: {forces: [{gravity: {region: {attach: a, box: {}}}}]}}\n",
     ":2:52: systems.s.forces.0.gravity.region.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "systems: {s: {demitters: [{min: [0, 0, 0], max: [1, 1, 1], attach: a}]}}\n",
     ":2:68: systems.s.demitters.0.attach: unknown node 'a' (there are none)"},
    {"kiln: 1\n"
     "systems: {s: {demitters: [{min: [0, 0, 0], max: [1, 1, 1], attach: 1}]}}\n",
     ":2:68: systems.s.demitters.0.attach: expected the name of a node, or none, found '1'"},
    {"kiln: 1\n"
     "systems: {s: {demitters: [{min: [0, 0, 0], attach: a}]}}\n",
     ":2:27: systems.s.demitters.0: expected {min: [x, y, z], max: [x, y, z]}, each number from "
     "-100000 m to 100000 m, found a mapping"},
    {"kiln: 1\n"
     "systems: {s: {forces: [{limit: {attach: a}}]}}\n",
     ":2:33: systems.s.forces.0.limit.attach: unknown key (there are: speed)"},
    {"kiln: 1\n"
     "nodes: {a: {}}\n"
     "systems: {s: {emit: {rate: 1}}, t: {emit: {attach: a, parent: {system: s}}}}\n",
     ":3:52: systems.t.emit.attach: must be none for a system with a parent, around whose "
     "particles "
     "its own are born"},
};

BAD_TEST(nodes)
BAD_TEST(paths)
BAD_TEST(attached)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_nodes),
        cmocka_unit_test(bad_paths),
        cmocka_unit_test(bad_attached),
    };
    return cmocka_run_group_tests_name("node_errors", tests, NULL, NULL);
}
