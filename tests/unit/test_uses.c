/* Checks the masks by which kernels of GLSL leave out what no system uses (lib/sim/step/uses.h). If
 * this fails, GL moves particles otherwise than the host, or a kernel has code that its scene does
 * not need. */
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "shared/uses.h"
#include "sim/step/uses.h"
#include "sim/world/grids.h"
#include "sim/world/params.h"
#include "support/cmocka.h"
#include "support/scenes.h"

static const char BASE[] = "kiln: 1\n"
                           "output: {size: [64, 36], frames: 2}\n"
                           "backdrop: {floor: {collide: false}}\n"
                           "systems:\n"
                           "  a: {emit: {rate: 10}}\n";

/* Returns the number of a line "#define NAME 123u" of a scene's kernel. A semicolon stands between
 * two overrides. */
static unsigned long used(const char *override, const char *name, bool families)
{
    char first[256];
    const char *second = override ? strchr(override, ';') : NULL;
    snprintf(first, sizeof first, "%.*s", override ? (int)strcspn(override, ";") : 0,
             override ? override : "");
    const char *const overrides[] = {first, second ? second + 1 : NULL, NULL};
    struct kiln_scene *scene = load_scene(BASE, override ? overrides : NULL);
    struct kiln_sim_params *params = calloc(1, sizeof *params);
    struct kiln_sim_grids *grids = calloc(1, sizeof *grids);
    struct kiln_text defines = {0};
    char line[64];
    assert_true(params && grids);
    kiln_sim_params_init(params, scene, grids);
    kiln_sim_add_uses(&defines, scene, params, families);
    assert_false(defines.failed);
    snprintf(line, sizeof line, "#define %s ", name);
    const char *at = strstr(defines.data, line);
    assert_non_null(at);
    const unsigned long number = strtoul(at + strlen(line), NULL, 10);
    kiln_text_free(&defines);
    free(grids);
    free(params);
    kiln_scene_destroy(&scene);
    return number;
}

struct use {
    const char *override;
    unsigned long mask;
};

static void expect(const char *name, const struct use *uses, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (used(uses[i].override, name, false) != uses[i].mask)
            fail_msg("%s: %s is %#lx, not %#lx", uses[i].override ? uses[i].override : "nothing",
                     name, used(uses[i].override, name, false), uses[i].mask);
}

#define EXPECT(name, uses) expect(name, uses, sizeof(uses) / sizeof *(uses))
#define BIT(part)          (1ul << (part))
#define OVER_TIME          "{keys: {0 s: 1, 1 s: 2}}"
#define OVER_LIFE          "{life: [1, 2]}"

static void values_with_keys_are_known(void **state)
{
    (void)state;
    static const struct use uses[] = {
        {NULL, 0},
        {"systems.a.emit.life={keys: {0 s: 1 s, 1 s: 2 s}}", BIT(KEYED_LIFE)},
        {"systems.a.emit.life=[1 s, {keys: {0 s: 1 s, 1 s: 2 s}}]", BIT(KEYED_LIFE)},
        {"systems.a.emit.speed=" OVER_TIME, BIT(KEYED_SPEED)},
        {"systems.a.emit.inherit={keys: {0 s: 0, 1 s: 1}}", BIT(KEYED_INHERIT)},
        {"systems.a.emit.from=point: {origin: {keys: {0 s: [0, 0, 0], 1 s: [0, 0, 1]}}}",
         BIT(KEYED_ORIGIN)},
        {"systems.a.emit.from=cone: {direction: {keys: {0 s: [0, 1, 0], 1 s: [1, 1, 0]}}}",
         BIT(KEYED_DIRECTION)},
        {"systems.a.emit.from=box: {size: {keys: {0 s: [1, 1, 1], 1 s: [2, 1, 1]}}}",
         BIT(KEYED_SIZE)},
        {"systems.a.emit.from=cone: {angle: {keys: {0 s: 1 deg, 1 s: 2 deg}}}", BIT(KEYED_ANGLE)},
        {"systems.a.emit.from=sphere: {radius: " OVER_TIME "}", BIT(KEYED_RADIUS)},
        {"systems.a.emit.from=disc: {turn: {keys: {0 s: 1 deg/s, 1 s: 2 deg/s}}}", BIT(KEYED_TURN)},
        {"systems.a.collide={randomness: {life: [0, 1]}}", BIT(KEYED_RANDOMNESS)},
        {"systems.a.collide={slowdown: {life: [0, 1]}}", BIT(KEYED_SLOWDOWN)},
        {"systems.a.collide={restitution: {life: [0, 1]}}", BIT(KEYED_RESTITUTION)},
        {"systems.a.collide={friction: {life: [0, 1]}}", BIT(KEYED_FRICTION)},
        {"systems.a.forces=[gravity: {life: [[0, 1, 0], [0, 2, 0]]}]", BIT(KEYED_FORCE_VECTOR)},
        {"systems.a.forces=[curl: {strength: " OVER_LIFE "}]", BIT(KEYED_FORCE_STRENGTH)},
        {"systems.a.forces=[curl: {pull: " OVER_LIFE "}]", BIT(KEYED_FORCE_PULL)},
        {"systems.a.forces=[drag: {quadratic: " OVER_LIFE "}]", BIT(KEYED_FORCE_QUADRATIC)},
        {"systems.a.forces=[vortex: {radius: " OVER_LIFE "}]", BIT(KEYED_FORCE_SCALE)},
        /* values that the host evaluates in each step */
        {"systems.a.forces=[curl: {strength: " OVER_TIME "}]", 0},
        {"systems.a.collide={slowdown: {keys: {0 s: 1, 1 s: 0.5}}}", 0},
    };
    EXPECT("USES_KEYS", uses);
    /* a chance needs a `then`, with which a system is stepped as a family */
    assert_true(used("systems.a.collide={then: stop, chance: {life: [0, 1]}}", "USES_KEYS", true) ==
                BIT(KEYED_CHANCE));
}

static void forces_are_known(void **state)
{
    (void)state;
    static const struct use uses[] = {
        {NULL, 0},
        {"systems.a.forces=[gravity: {}, limit: 5]", BIT(FORCE_GRAVITY) | BIT(FORCE_LIMIT)},
        {"systems.a.forces=[drag: 1, wind: {}]", BIT(FORCE_DRAG) | BIT(FORCE_WIND)},
        {"systems.a.forces=[curl: {}, attract: {}]", BIT(FORCE_CURL) | BIT(FORCE_ATTRACT)},
        {"systems.a.forces=[vortex: 1]", BIT(FORCE_VORTEX)},
        /* the forces of a baked wind are for the kernel that writes it */
        {"systems.a.forces=[wind: {baked: {box: {size: [1, 1, 1]}, of: [vortex: 1, curl: 1]}}]",
         BIT(FORCE_BAKED)},
        /* kernels read the wind of gas as a baked one */
        {"gas={g: {box: {size: [1, 1, 1]}}};systems.a.forces=[wind: {gas: g}]", BIT(FORCE_BAKED)},
        {"systems.a.forces=[drag: {region: {sphere: {}}}]", BIT(FORCE_DRAG) | BIT(FORCE_IN_REGION)},
        {"nodes={n: {}};systems.a.forces=[drag: {attach: n}]",
         BIT(FORCE_DRAG) | BIT(FORCE_IN_NODE)},
        {"nodes={n: {}};systems.a.forces=[drag: {region: {attach: n, sphere: {}}}]",
         BIT(FORCE_DRAG) | BIT(FORCE_IN_NODE) | BIT(FORCE_IN_REGION)},
    };
    EXPECT("USES_FORCES", uses);
    static const struct use ends[] = {
        {NULL, 0},
        {"systems.a.demitters=[{min: [0, 0, 0], max: [1, 1, 1]}]", 0},
        {"nodes={n: {}};systems.a.demitters=[{min: [0, 0, 0], max: [1, 1, 1], attach: n}]",
         BIT(DEMITTER_IN_NODE)},
    };
    EXPECT("USES_DEMITTERS", ends);
}

/* Returns the forces that the kernel has which writes the baked winds of BASE with this override;
 * *all: whether it needs FORCES_ALL. */
static unsigned long baked(const char *forces, bool *all)
{
    static const char name[] = "#define USES_FORCES ";
    const char *const overrides[] = {"nodes={n: {}}", forces, NULL};
    struct kiln_error error = {0};
    struct kiln_scene *scene = load_scene(BASE, overrides);
    struct kiln_sim_grids *grids = calloc(1, sizeof *grids);
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_text defines = {0};
    assert_true(grids && threads);
    assert_true(kiln_sim_grids_init(grids, NULL, scene, threads, &error));
    kiln_sim_add_bake_uses(&defines, scene, grids);
    *all = kiln_sim_bakes_need_all_forces(scene, grids);
    assert_false(defines.failed);
    const unsigned long mask = strtoul(strstr(defines.data, name) + strlen(name), NULL, 10);
    kiln_text_free(&defines);
    kiln_sim_grids_finish(grids);
    free(grids);
    kiln_threads_destroy(&threads);
    kiln_scene_destroy(&scene);
    return mask;
}

#define OF(forces) "systems.a.forces=[wind: {baked: {box: {size: [1, 1, 1]}, of: [" forces "]}}]"

static void forces_of_baked_winds_are_known(void **state)
{
    (void)state;
    bool all;
    assert_int_equal(baked(OF("curl: 1, gravity: {}"), &all), BIT(FORCE_CURL) | BIT(FORCE_GRAVITY));
    assert_false(all);
    assert_int_equal(baked(OF("drag: {attach: n, region: {sphere: {}}}"), &all),
                     BIT(FORCE_DRAG) | BIT(FORCE_IN_NODE) | BIT(FORCE_IN_REGION));
    assert_false(all);
    assert_int_equal(baked(OF("vortex: 1"), &all), BIT(FORCE_VORTEX));
    assert_true(all);
}

static void shapes_of_emitters_are_known(void **state)
{
    (void)state;
    static const struct use uses[] = {
        {NULL, BIT(EMIT_POINT)},
        {"systems.a.emit.from=sphere: {}", BIT(EMIT_SPHERE)},
        {"systems.a.emit.from=box: {}", BIT(EMIT_BOX)},
        {"systems.a.emit.from=disc: {}", BIT(EMIT_DISC)},
        {"systems.a.emit.from=ring: {}", BIT(EMIT_DISC)},
        {"systems.a.emit.from=cone: {}", BIT(EMIT_CONE)},
        {"systems.a.emit.from=line: {}", BIT(EMIT_LINE)},
        {"systems={a: {emit: {rate: 1}}, b: {emit: {rate: 1, from: {box: {}}}}}",
         BIT(EMIT_POINT) | BIT(EMIT_BOX)},
    };
    EXPECT("USES_EMITTERS", uses);
}

#define OBJECT(text) "backdrop.objects=[" text "]"

static void colliders_are_known(void **state)
{
    (void)state;
    static const struct use uses[] = {
        {NULL, 0},
        {"backdrop.floor.collide=true", BIT(COLLIDER_BOX)},
        {OBJECT("box: {collide: true}"), BIT(COLLIDER_BOX)},
        {OBJECT("box: {collide: false}"), 0},
        {OBJECT("box: {rotation: [0, 1 deg, 0], collide: true}"), BIT(COLLIDER_ORIENTED_BOX)},
        {OBJECT("sphere: {collide: true}"), BIT(COLLIDER_SPHERE)},
        {OBJECT("cylinder: {collide: true}"), BIT(COLLIDER_CYLINDER)},
        {OBJECT("capsule: {collide: true}"), BIT(COLLIDER_CAPSULE)},
        {OBJECT("plane: {collide: true}"), BIT(COLLIDER_PLANE)},
        {OBJECT("cone: {collide: true}"), BIT(COLLIDER_CONE)},
        {OBJECT("sphere: {collide: true}, capsule: {collide: true}"),
         BIT(COLLIDER_SPHERE) | BIT(COLLIDER_CAPSULE)},
    };
    EXPECT("USES_COLLIDERS", uses);
}

static void modes_of_collision_are_known(void **state)
{
    (void)state;
    static const struct use uses[] = {
        {"systems.a.collide={mode: clamp}", 0}, /* there is nothing to collide with */
        {"backdrop.floor.collide=true", BIT(COLLIDE_OFF)},
        {"backdrop.floor.collide=true;systems.a.collide={}", BIT(COLLIDE_SWEPT)},
        {"backdrop.floor.collide=true;systems.a.collide={mode: clamp}", BIT(COLLIDE_CLAMP)},
    };
    EXPECT("USES_COLLIDE", uses);
    assert_int_equal(used(NULL, "USES_BIRTHS", false), BIT(BORN_OF_CLOCK));
    assert_int_equal(used(NULL, "USES_BIRTHS", true), 0);
    assert_int_equal(
        used("systems={a: {emit: {rate: 1}}, b: {emit: {parent: {system: a, on: {death: 2}}}}}",
             "USES_BIRTHS", true),
        BIT(BORN_OF_CLOCK) | BIT(BORN_OF_DEATH));
    assert_int_equal(used("systems.a.collide={then: stick}", "USES_THEN", true), BIT(THEN_STICK));
    assert_int_equal(used("simulation.integration=rk4", "USES_INTEGRATION", false), INTEGRATE_RK4);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_with_keys_are_known),
        cmocka_unit_test(forces_are_known),
        cmocka_unit_test(shapes_of_emitters_are_known),
        cmocka_unit_test(colliders_are_known),
        cmocka_unit_test(modes_of_collision_are_known),
        cmocka_unit_test(forces_of_baked_winds_are_known),
    };
    return cmocka_run_group_tests_name("uses", tests, NULL, NULL);
}
