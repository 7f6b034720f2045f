/* lib/scene/family, emit_way: bad families of systems, births by the metre and looks of parents,
 * and the exact words that say so. */
#include <stddef.h>
#include <stdint.h>

#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/scenes.h"

#define CHILD(name, of, on) "  " name ": {emit: {parent: {system: " of ", on: " on "}}}\n"

static const struct bad families[] = {
    {"kiln: 1\n"
     "systems:\n"
     "  rockets: {emit: {rate: 1}}\n" CHILD("stars", "rokets", "{death: 5}"),
     ":4:35: systems.stars.emit.parent.system: unknown system 'rokets' (did you mean 'rockets'?)"},
    {"kiln: 1\n"
     "systems: {a: {emit: {parent: {on: {death: 5}}}}}\n",
     ":2:30: systems.a.emit.parent.system: the key is missing and must be given"},
    {"kiln: 1\n"
     "systems: {a: {emit: {parent: {system: 3}}}}\n",
     ":2:39: systems.a.emit.parent.system: expected the name of another system, found '3'"},
    {"kiln: 1\n"
     "systems: {a: {emit: {parent: b}}}\n",
     ":2:30: systems.a.emit.parent: expected a mapping of keys, or none, found 'b'"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{birth: 5}"),
     ":4:39: systems.b.emit.parent.on.birth: unknown kind (there are: death, bounce, trail)"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{death: {count: 5, align: normal}}"),
     ":4:64: systems.b.emit.parent.on.death.align: expected world or velocity, found 'normal'"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{death: 0}"),
     ":4:46: systems.b.emit.parent.on.death.count: 0 is out of range; allowed is from 1 to 65536"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{trail: {life: [0, 0]}}"),
     ":4:38: systems.b.emit.parent.on: the rate is 0 at all times; it must be above 0"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{trail: {age: {0 s: 1}}}"),
     ":4:47: systems.b.emit.parent.on.trail.rate.age: cannot vary over age here; allowed is a "
     "constant or a mapping with keys, life, random or choose"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{bounce: 5}"),
     ":4:38: systems.b.emit.parent.on: particles of 'a' never bounce: set systems.a.collide"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1}}, b: {emit: {rate: 5, parent: {system: a}}}}\n",
     ":2:50: systems.b.emit.rate: must be 0 for a system with a parent; emit.parent.on sets the "
     "number of births"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1}}, b: {emit: {bursts: {1 s: 3}, parent: {system: a}}}}\n",
     ":2:52: systems.b.emit.bursts: must be {} for a system with a parent; emit.parent.on sets the "
     "number of births"},
    {"kiln: 1\n"
     "systems:\n" CHILD("a", "c", "{death: 5}") CHILD("b", "a", "{death: 5}")
         CHILD("c", "b", "{death: 5}"),
     ":3:31: systems.a.emit.parent.system: the system is born of its own descendants; the first "
     "system of a family has no parent"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1}}\n" CHILD("b", "a", "{death: 5}") CHILD("c", "b", "{death: 5}")
         CHILD("d", "c", "{death: 5}") CHILD("e", "d", "{death: 5}"),
     ":7:31: systems.e.emit.parent.system: found 5 generations of systems; at most 4 are allowed"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1000}}\n" CHILD("b", "a", "{death: 60000}"),
     ":4:13: systems.b.emit: up to 123000000 particles at once need 3753 MiB; the systems of a "
     "scene may have 33554432 in all (1024 MiB), of which 2050 are taken: lower children, or the "
     "parents' rate or life"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {emit: {rate: 1, life: 10000 s}}\n" CHILD("b", "a", "{trail: 100000}"),
     ":4:38: systems.b.emit.parent.on: up to 1000001931 particles are born of one particle; at "
     "most 33554432 are allowed"},
    {"kiln: 1\n"
     "output: {frames: 30000}\n"
     "systems:\n"
     "  a: {emit: {rate: 1000, life: 0.01 s}}\n"
     "  b: {emit: {life: 0.01 s, parent: {system: a, on: {death: 10000}}}}\n",
     ":5:13: systems.b.emit: the run has 9999670000 births; at most 4294967295 are allowed"},
    {"kiln: 1\n"
     "systems: {a: {look: {rotation: [{life: [0, 0]}, {keys: {0 s: 0}}]}}}\n",
     ":2:32: systems.a.look.rotation: both must vary over time, or both over life"},
    {"kiln: 1\n"
     "systems: {a: {}, b: {emit: {parent: {system: a}, per_metre: 9}}}\n",
     ":2:61: systems.b.emit.per_metre: must be 0 for a system with a parent; emit.parent.on sets "
     "the number of births"},
    {"kiln: 1\n"
     "output: {frames: 1e6, fps: 60}\n"
     "simulation: {rate: 240}\n"
     "systems: {a: &a {emit: {per_metre: 9}}, b: *a, c: *a, d: *a, e: *a}\n",
     ":4:10: systems: the ways of emitters by the metre have 19999980 steps; at most 16777216 are "
     "allowed: shorten the clip, or write `rate` instead"},
    {"kiln: 1\n"
     "output: {frames: 600, fps: 60}\n"
     "systems: {a: {emit: {per_metre: 1e5, from: {point: {origin: {keys: {0 s: [-4e4, 0, 0],\n"
     "  9 s: [4e4, 0, 0]}}}}}}}\n",
     ":3:33: systems.a.emit.per_metre: the run has more than 4294967295 births by the metre"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n"
     "  b: {emit: {parent: {system: a, inherit: {size: true}}}}\n"
     "  c: {emit: {parent: {system: b, inherit: {size: true}}}}\n",
     ":5:50: systems.c.emit.parent.inherit.size: must be false, since particles of 'b' have no "
     "size of their own"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {look: {color: {keys: {0 s: red, 1 s: blue}}}}\n"
     "  b: {emit: {parent: {system: a, inherit: {color: true}}}}\n",
     ":4:51: systems.b.emit.parent.inherit.color: systems.a.look.color must be constant or vary "
     "over life, age or random numbers, since others inherit it"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {look: {temperature: {speed: {0: 900, 9: 1800}}}}\n"
     "  b: {emit: {parent: {system: a, inherit: {temperature: true}}}}\n",
     ":4:57: systems.b.emit.parent.inherit.temperature: systems.a.look.temperature must be "
     "constant or vary over life, age or random numbers, since others inherit it"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n"
     "  b: {emit: {parent: {system: a, inherit: {size: true}}},\n"
     "      interact: [collide: {as_drawn: true}]}\n",
     ":4:50: systems.b.emit.parent.inherit.size: must be false where particles collide as they are "
     "drawn"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n"
     "  b: {emit: {parent: {system: a, inherit: {color: true}}}, paint: {},\n"
     "      collide: {}}\n",
     ":4:51: systems.b.emit.parent.inherit.color: must be false for a system that paints with its "
     "own color"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n"
     "  b: {emit: {parent: {system: a, inherit: {temperature: true}}}}\n",
     ":4:57: systems.b.emit.parent.inherit.temperature: particles of 'a' have no temperature: set "
     "systems.a.look.temperature"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {look: {temperature: {life: [900, 0]}}}\n"
     "  b: {emit: {parent: {system: a, inherit: {temperature: true}}}}\n"
     "  c: {emit: {parent: {system: b, inherit: {temperature: true}}}}\n",
     ":5:57: systems.c.emit.parent.inherit.temperature: must be false, since particles of 'b' have "
     "no temperature of their own"},
};

/* Keys of events that would do nothing. */
static const struct bad events[] = {
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n" CHILD("b", "a", "{death: {impact: true}}"),
     ":4:55: systems.b.emit.parent.on.death.impact: no impact ends particles of 'a': set "
     "systems.a.collide.then to die"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {collide: {then: stop}}\n" CHILD("b", "a", "{death: {impact: true}}"),
     ":4:55: systems.b.emit.parent.on.death.impact: no impact ends particles of 'a': set "
     "systems.a.collide.then to die"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {collide: {then: die, chance: 0}}\n" CHILD("b", "a", "{death: {impact: true}}"),
     ":4:55: systems.b.emit.parent.on.death.impact: no impact ends particles of 'a': set "
     "systems.a.collide.then to die"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {collide: {}}\n" CHILD("b", "a", "{bounce: {count: 2, most: 4}}"),
     ":4:64: systems.b.emit.parent.on.bounce.most: needs `every: true`; without it, the first "
     "impact alone counts"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n" CHILD("b", "a", "{trail: {rate: 9, most: 4}}"),
     ":4:62: systems.b.emit.parent.on.trail.most: needs `per_metre`; by the rate, the life of a "
     "parent's particle bounds the number of its children"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n" CHILD("b", "a", "{trail: {rate: 9, per_metre: 4}}"),
     ":4:46: systems.b.emit.parent.on.trail: must have one of `rate` and `per_metre`, found both"},
    {"kiln: 1\n"
     "systems:\n"
     "  a: {}\n" CHILD("b", "a", "{trail: {rate: {random: [9, 20]}, per_metre: 4}}"),
     ":4:46: systems.b.emit.parent.on.trail: must have one of `rate` and `per_metre`, found both"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: [{count: 3}, {count: 3, most: 2}]}}}\n",
     ":2:60: systems.a.emit.bursts.1.most: needs `every`; without it, the burst is not repeated"},
};

/* What is refused with another value is not with its default, which a printed scene has. */
static void defaults_are_allowed(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\n"
        "systems:\n"
        "  a: {collide: {dies: true}, look: {temperature: {age: {0 s: 0, 1 s: 900}}}}\n"
        "  b: {collide: {then: die, chance: {life: [0, 1]}}}\n" CHILD(
            "c", "a", "{death: {impact: true}}") CHILD("d", "b", "{death: {impact: true}}")
            CHILD("e", "a", "{bounce: {every: false, most: 3}}")
                CHILD("f", "a", "{trail: {rate: 9, per_metre: 0, most: 256}}")
                    CHILD("g", "a",
                          "{trail: {rate: 20, per_metre: 9, most: 2}}") "  h: {emit: {parent: "
                                                                        "{system: a, inherit: "
                                                                        "{temperature: true}}}}\n",
        NULL);
    kiln_scene_destroy(&scene);
}

BAD_TEST(families)
BAD_TEST(events)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_families),
        cmocka_unit_test(bad_events),
        cmocka_unit_test(defaults_are_allowed),
    };
    return cmocka_run_group_tests_name("family_errors", tests, NULL, NULL);
}
