/* What is wrong with the gas of a scene is said with its place. If this fails, an author of a scene
 * gets a wrong reason, or a scene loads that the solver cannot step. */
#include "support/bad_scenes.h"
#include "support/cmocka.h"

static const struct bad domains[] = {
    {"kiln: 1\ngas: {a: {}}\n", ":2:10: gas.a.box: the key is missing and must be given"},
    {"kiln: 1\ngas: {a: {box: {}}}\n",
     ":2:16: gas.a.box.size: the key is missing and must be given"},
    {"kiln: 1\ngas: {a: {box: {size: [0, 1, 1]}, sources: [{}]}}\n",
     ":2:24: gas.a.box.size.0: 0 is out of range; allowed is from 0.001 m to 100000 m"},
    {"kiln: 1\ngas: {a: {box: {size: [1, -1, 1]}, sources: [{}]}}\n",
     ":2:27: gas.a.box.size.1: -1 is out of range; allowed is from 0.001 m to 100000 m"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1], center: {keys: {0 s: [0, 0, 0]}}}, sources: "
     "[{}]}}\n",
     ":2:43: gas.a.box.center.keys: cannot vary over time here; allowed is a constant"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1], center: [.nan, 0, 0]}, sources: [{}]}}\n",
     ":2:43: gas.a.box.center.0: .nan is not a finite number"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cell: 1 cm, cells: 64}}\n",
     ":2:69: gas.a.cells: cannot be given together with `cell`"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cell: 0.1 mm}}\n",
     ":2:56: gas.a.cell: the domain has 10000 x 10000 x 10000 cells, which take up to 113045.6 GiB "
     "where gas fills it; an edge has at most 1024: make the cells larger"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cell: 0.5 mm, sides: {top: "
     "closed}}}\n",
     ":2:56: gas.a.cell: the domain has 2000 x 2000 x 2000 cells, which take up to 904.4 GiB where "
     "gas fills it; an edge has at most 1024: make the cells larger"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cells: 1024}}\n",
     ":2:6: gas: the domains have 1073741824 cells, which take up to 116.4 GiB where gas fills "
     "them; a scene has at most 268435456: make the cells larger"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cells: 1025}}\n",
     ":2:57: gas.a.cells: 1025 is out of range; allowed is from 16 to 1024"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cells: 15}}\n",
     ":2:57: gas.a.cells: 15 is out of range; allowed is from 16 to 1024"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cells: 512}, b: {box: {size: [1, "
     "1, 1]}, sources: [{}], cells: 512}, c: {box: {size: [1, 1, 1]}, sources: [{}], cells: "
     "512}}\n",
     ":2:6: gas: the domains have 402653184 cells, which take up to 43.8 GiB where gas fills them; "
     "a scene has at most 268435456: make the cells larger"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], substeps: 0}}\n",
     ":2:60: gas.a.substeps: 0 is out of range; allowed is from 1 to 16"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], substeps: 17}}\n",
     ":2:60: gas.a.substeps: 17 is out of range; allowed is from 1 to 16"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], rate: 10000}}\n",
     ":2:56: gas.a.rate: a step of the scene has at most 16 of the gas, 960 a second: a larger "
     "simulation.rate makes more"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], detail: 3}}\n",
     ":2:58: gas.a.detail: found 3; allowed are 1, 2 and 4"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], detail: 5}}\n",
     ":2:58: gas.a.detail: 5 is out of range; allowed is from 1 to 4"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], sides: {left: shut}}}\n",
     ":2:64: gas.a.sides.left: expected open or closed, found 'shut'"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], sides: {up: open}}}\n",
     ":2:58: gas.a.sides.up: unknown key (there are: left, right, bottom, top, back, front)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], attach: n}}\n",
     ":2:58: gas.a.attach: unknown node 'n' (there are none)"},
    {"kiln: 1\nnodes: {node: {}}\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], attach: nod}}\n",
     ":3:58: gas.a.attach: unknown node 'nod' (did you mean 'node'?)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], burn: 3}}\n",
     ":2:56: gas.a.burn: expected a mapping of keys, or none, found '3'"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], burn: {life: 0}}}\n",
     ":2:63: gas.a.burn.life: 0 is out of range; allowed is from 0.001 s to 1000 s"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], vorticity: 3}}\n",
     ":2:61: gas.a.vorticity: 3 is out of range; allowed is from 0 to 2"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], pressure: {cycles: 0}}}\n",
     ":2:69: gas.a.pressure.cycles: 0 is out of range; allowed is from 1 to 16"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], pressure: {residual: 2}}}\n",
     ":2:71: gas.a.pressure.residual: 2 is out of range; allowed is from 0 to 1"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], turbulence: {octaves: 5}}}\n",
     ":2:72: gas.a.turbulence.octaves: 5 is out of range; allowed is from 1 to 4"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], look: {kelvin: [2000, 1000]}}}\n",
     ":2:65: gas.a.look.kelvin: the first must not be above the second"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], look: {scattering: 1}}}\n",
     ":2:69: gas.a.look.scattering: 1 is out of range; allowed is from -0.99 to 0.99"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], buoyancy: 3 m}}\n",
     ":2:60: gas.a.buoyancy: unit 'm' is wrong; allowed is m/s^2"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], use: b}}\n",
     ":2:55: gas.a.use: there is no entry 'b' (there are: a)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], cool: 1}}\n",
     ":2:50: gas.a.cool: unknown key (did you mean 'cell'?)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], collide: {}}}\n",
     ":2:59: gas.a.collide: expected true or false, found a mapping"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}]}, b: {box: {size: [1, 1, 1]}, "
     "sources: [{}]}, c: {box: {size: [1, 1, 1]}, sources: [{}]}, d: {box: {size: [1, 1, 1]}, "
     "sources: [{}]}, e: {box: {size: [1, 1, 1]}, sources: [{}]}}\n",
     ":2:6: gas: found 5 entries; at most 4 are allowed"},
    {"kiln: 1\ngas: [a]\n",
     ":2:6: gas: expected a mapping of up to 4 names to mappings of keys, found a list"},
};

BAD_TEST(domains)

static const struct bad sources[] = {
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{attach: n}]}}\n",
     ":2:54: gas.a.sources.0.attach: unknown node 'n' (there are none)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {system: s}}]}}\n",
     ":2:61: gas.a.sources.0.from.system: unknown system 's' (there are none)"},
    {"kiln: 1\nsystems: {sparks: {}}\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {system: "
     "spark}}]}}\n",
     ":3:61: gas.a.sources.0.from.system: unknown system 'spark' (did you mean 'sparks'?)"},
    {"kiln: 1\nnodes: {n: {}}\nsystems: {sparks: {}}\ngas: {a: {box: {size: [1, 1, 1]}, sources: "
     "[{from: {system: sparks}, attach: n}]}}\n",
     ":4:78: gas.a.sources.0.attach: must be none where the particles of a system are sources"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {system: 3}}]}}\n",
     ":2:61: gas.a.sources.0.from.system.name: expected the name of a system, found '3'"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {disc: {direction: [0, 0, "
     "0]}}}]}}\n",
     ":2:71: gas.a.sources.0.from.disc.direction: must not be [0, 0, 0]"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {ring: {direction: [0, 0, "
     "0]}}}]}}\n",
     ":2:71: gas.a.sources.0.from.ring.direction: must not be [0, 0, 0]"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {cone: {direction: [0, 0, "
     "0]}}}]}}\n",
     ":2:71: gas.a.sources.0.from.cone.direction: must not be [0, 0, 0]"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {cone: {angle: 181 deg}}}]}}\n",
     ":2:67: gas.a.sources.0.from.cone.angle: 181 deg is out of range; allowed is from 0 deg to "
     "180 deg"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {sphere: {radius: -1}}}]}}\n",
     ":2:70: gas.a.sources.0.from.sphere.radius: -1 is out of range; allowed is from 0 m to 100000 "
     "m"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {point: {surface: true}}}]}}\n",
     ":2:61: gas.a.sources.0.from.point.surface: unknown key (there are: origin)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {mesh: {}}}]}}\n",
     ":2:59: gas.a.sources.0.from.mesh: must have one of `file` and `object`, found neither"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {mesh: {object: x}}}]}}\n",
     ":2:68: gas.a.sources.0.from.mesh.object: unknown mesh 'x' in backdrop.objects (there are "
     "none)"},
    {"kiln: 1\nbackdrop: {objects: [sphere: {}]}\ngas: {a: {box: {size: [1, 1, 1]}, sources: "
     "[{from: {mesh: {object: 0}}}]}}\n",
     ":3:68: gas.a.sources.0.from.mesh.object: must name a mesh; backdrop.objects.0 is a sphere"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {image: {}}}]}}\n",
     ":2:60: gas.a.sources.0.from.image.file: must name an image file"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {path: {points: [[0, 0, 0], [1, "
     "0, 0]], closed: true}}}]}}\n",
     ":2:68: gas.a.sources.0.from.path.points: a closed path has 3 points at least"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{from: {path: {points: [[0, 0, 0], [1, "
     "0, 0], [0, 0, 0]], closed: true}}}]}}\n",
     ":2:68: gas.a.sources.0.from.path.points: the last point must not be the first; a closed path "
     "goes on to the first by itself"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{fuel: 2}]}}\n",
     ":2:52: gas.a.sources.0.fuel: 2 is out of range; allowed is from 0 to 1"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{fuel: {life: [0, 1]}}]}}\n",
     ":2:53: gas.a.sources.0.fuel.life: cannot vary over life here; allowed is a constant or a "
     "mapping with keys or noise"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{smoke: {random: [0, 1]}}]}}\n",
     ":2:54: gas.a.sources.0.smoke.random: cannot vary over random here; allowed is a constant or "
     "a mapping with keys or noise"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{velocity: {speed: {0: [0, 0, 0], 1: "
     "[1, 1, 1]}}}]}}\n",
     ":2:57: gas.a.sources.0.velocity.speed: cannot vary over speed here; allowed is a constant or "
     "a mapping with keys or noise"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{rate: {noise: [0, 1], per: "
     "particle}}]}}\n",
     ":2:73: gas.a.sources.0.rate: a noise of each particle is not possible here; allowed is per: "
     "system"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{noise: {amount: 2}}]}}\n",
     ":2:62: gas.a.sources.0.noise.amount: 2 is out of range; allowed is from 0 to 1"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{reach: -1}]}}\n",
     ":2:53: gas.a.sources.0.reach: -1 is out of range; allowed is from 0 m to 100000 m"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{color: grey-ish}]}}\n",
     ":2:53: gas.a.sources.0.color: expected [red, green, blue] or one number for grey, linear, "
     "each from 0 to 1, or in sRGB \"#e61e28\", \"#abc\" or a name of CSS, or albedo, or {keys: "
     "{time: value}}, found 'grey-ish'"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}, {}, {}, {}, {}, {}, {}, {}, {}]}}\n",
     ":2:44: gas.a.sources: found 9 entries; at most 8 are allowed"},
};

BAD_TEST(sources)

static const struct bad forces[] = {
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [limit: 3]}}\n",
     ":2:59: gas.a.forces.0.limit: unknown kind (there are: gravity, drag, curl, attract, vortex, "
     "wind)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [wind: {gas: a}]}}\n",
     ":2:66: gas.a.forces.0.wind.gas: unknown key (there are: velocity, pull, mode, attach, "
     "region)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [wind: {field: baked}]}}\n",
     ":2:65: gas.a.forces.0.wind.box: the key is missing and must be given"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [wind: {baked: {box: "
     "{size: "
     "[1, 1, 1]}, of: [limit: 3]}}]}}\n",
     ":2:103: gas.a.forces.0.wind.baked.of.0.limit: unknown kind (there are: gravity, drag, curl, "
     "attract, vortex, wind)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [wind: {baked: {box: "
     "{size: "
     "[1, 1, 1]}, of: [curl: {attach: n}]}}]}}\n",
     ":2:118: gas.a.forces.0.wind.baked.of.0.curl.attach: unknown node 'n' (there are none)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [wind: {field: gas, gas: "
     "a}]}}\n",
     ":2:73: gas.a.forces.0.wind.field: unknown word 'gas' (there are: uniform, curl, vortex, "
     "grid, baked)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [drag: {quadratic: 1}]}}\n",
     ":2:66: gas.a.forces.0.drag.quadratic: unknown key (there are: strength, attach, region)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [curl: {attach: n}]}}\n",
     ":2:74: gas.a.forces.0.curl.attach: unknown node 'n' (there are none)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [curl: {region: {}}]}}\n",
     ":2:74: gas.a.forces.0.curl.region: must have one of `box` and `sphere`, found neither"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [curl: {region: {attach: "
     "n, box: {}}}]}}\n",
     ":2:83: gas.a.forces.0.curl.region.attach: unknown node 'n' (there are none)"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [curl: {strength: {life: "
     "[0, 1]}}]}}\n",
     ":2:77: gas.a.forces.0.curl.strength.life: cannot vary over life here; allowed is a constant "
     "or a mapping with keys or noise"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [attract: {strength: "
     "{speed: {0: 1, 1: 2}}}]}}\n",
     ":2:80: gas.a.forces.0.attract.strength.speed: cannot vary over speed here; allowed is a "
     "constant or a mapping with keys or noise"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: {curl: 1}}}\n",
     ":2:58: gas.a.forces: expected a list of up to 32: {gravity, drag, curl, attract, vortex or "
     "wind: {...}}, found a mapping"},
    {"kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sources: [{}], forces: [drag, drag, drag, drag, "
     "drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, "
     "drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag]}}\n",
     ":2:58: gas.a.forces: found 33 entries; at most 32 are allowed"},
};

BAD_TEST(forces)

static const struct bad winds[] = {
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire}]}}\n",
     ":2:36: systems.s.forces.0.wind.gas: unknown gas 'fire' (there are none)"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fier}]}}\ngas: {fire: {box: {size: [1, 1, 1]}, "
     "sources: [{}]}}\n",
     ":2:36: systems.s.forces.0.wind.gas: unknown gas 'fier' (did you mean 'fire'?)"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: {}}]}}\n",
     ":2:36: systems.s.forces.0.wind.gas: expected the name of a domain of gas, found a mapping"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: 3}]}}\n",
     ":2:36: systems.s.forces.0.wind.gas: expected the name of a domain of gas, found '3'"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire, pul: 3}]}}\ngas: {fire: {box: {size: [1, "
     "1, 1]}, sources: [{}]}}\n",
     ":2:42: systems.s.forces.0.wind.pul: unknown key (did you mean 'pull'?)"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire, velocity: [1, 0, 0]}]}}\ngas: {fire: {box: "
     "{size: [1, 1, 1]}, sources: [{}]}}\n",
     ":2:42: systems.s.forces.0.wind.velocity: unknown key (there are: gas, pull, cells, region)"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire, pull: {life: [0, 1]}}]}}\ngas: {fire: "
     "{box: {size: [1, 1, 1]}, sources: [{}]}}\n",
     ":2:49: systems.s.forces.0.wind.pull.life: cannot vary over life here; allowed is a constant "
     "or a mapping with keys or noise"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire, region: {}}]}}\ngas: {fire: {box: {size: "
     "[1, 1, 1]}, sources: [{}]}}\n",
     ":2:50: systems.s.forces.0.wind.region: must have one of `box` and `sphere`, found neither"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire, cells: 256}]}}\ngas: {fire: {box: {size: "
     "[1, 1, 1]}, sources: [{}]}}\n",
     ":2:49: systems.s.forces.0.wind.cells: wind, terrain and meshes that move particles have "
     "16974593 samples altogether; a scene has at most 4194304"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {field: gas}]}}\ngas: {fire: {box: {size: [1, 1, 1]}, "
     "sources: [{}]}}\n",
     ":2:30: systems.s.forces.0.wind.gas: the key is missing and must be given"},
    {"kiln: 1\nsystems: {s: {forces: [wind: {gas: fire, cells: 1}, wind: {gas: fire, cells: 1}, "
     "wind: {gas: fire, cells: 1}, wind: {gas: fire, cells: 1}, wind: {gas: fire, cells: 1}, wind: "
     "{gas: fire, cells: 1}, wind: {gas: fire, cells: 1}, wind: {gas: fire, cells: 1}, wind: {gas: "
     "fire, cells: 1}]}}\ngas: {fire: {box: {size: [1, 1, 1]}, sources: [{}]}}\n",
     ":2:281: systems.s.forces.8.wind.cells: more than 8 baked winds; no more are allowed"},
};

BAD_TEST(winds)
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_domains),
        cmocka_unit_test(bad_sources),
        cmocka_unit_test(bad_forces),
        cmocka_unit_test(bad_winds),
    };
    return cmocka_run_group_tests_name("gas_errors", tests, NULL, NULL);
}
