/* lib/scene: --set key=value. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scenes.h"

static const char text[] = "kiln: 1\n"
                           "seed: 7\n"
                           "backdrop: {objects: [{box: {center: [4, 1, 0]}}, {box: {}}]}\n"
                           "systems:\n"
                           "  smoke:\n"
                           "    emit: {rate: 100, from: {cone: {angle: 8 deg}}}\n"
                           "    forces: [{gravity: [0, 0.4, 0]}, {drag: 0.2}]\n"
                           "    look: {size: {life: [0.1, 1.2]}}\n"
                           "  fire:\n"
                           "    emit: {rate: 100}\n";

/* A scene with overrides is the scene that says the same itself: both print alike. */
static void expect_same(const char *const *overrides, const char *written)
{
    struct kiln_scene *scene = load_scene(text, overrides);
    struct kiln_scene *other = load_scene(written, NULL);
    char *found = print_scene(scene), *expected = print_scene(other);
    assert_string_equal(found, expected);
    assert_string_equal(scene->hash, other->hash);
    free(found);
    free(expected);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&other);
}

static void overrides_change_what_they_name(void **state)
{
    (void)state;
    static const char *const overrides[] = {
        "seed=9",
        "output.size=[640, 360]",  /* a mapping that the file lacks */
        "post.bloom.strength=0.5", /* two of them */
        "camera.position={keys: {0 s: [1, 2, 3], 1 s: [4, 5, 6]}}",
        "systems.smoke.emit.rate=5",
        "systems.smoke.emit.from.cone.angle=45 deg",
        "systems.smoke.forces.0.gravity=[0, 1, 0]",
        "systems.smoke.forces.1.drag.strength=0.5", /* from the short form */
        "systems.smoke.look.size.life.1=3",
        "systems.fire.collide.randomness=0.25", /* from none */
        "backdrop.objects.1.box.color=0.5",
        "systems.fire.emit.bursts.1 s=50",
        "systems.fire.emit.life=[1 s,\n 2 s] # as in a file",
        NULL,
    };
    expect_same(overrides,
                "kiln: 1\n"
                "seed: 9\n"
                "output: {size: [640, 360]}\n"
                "camera: {position: {keys: {0 s: [1, 2, 3], 1 s: [4, 5, 6]}}}\n"
                "backdrop: {objects: [{box: {center: [4, 1, 0]}}, {box: {color: 0.5}}]}\n"
                "systems:\n"
                "  smoke:\n"
                "    emit: {rate: 5, from: {cone: {angle: 45 deg}}}\n"
                "    forces: [{gravity: [0, 1, 0]}, {drag: 0.5}]\n"
                "    look: {size: {life: [0.1, 3]}}\n"
                "  fire:\n"
                "    emit: {rate: 100, life: [1, 2], bursts: {1 s: 50}}\n"
                "    collide: {randomness: 0.25}\n"
                "post: {bloom: {strength: 0.5}}\n");
}

static void stars_name_every_entry(void **state)
{
    (void)state;
    static const char *const overrides[] = {
        "systems.*.look={size: 2}",
        "systems.fire.look.size=3", /* of fire alone, though both got one text */
        "systems.*.forces.*.drag=0.5",
        "systems.*.emit.rate=7",
        "backdrop.objects.*.box.collide=false",
        NULL,
    };
    expect_same(overrides,
                "kiln: 1\n"
                "seed: 7\n"
                "backdrop:\n"
                "  objects: [{box: {center: [4, 1, 0], collide: false}}, {box: {collide: false}}]\n"
                "systems:\n"
                "  smoke:\n"
                "    emit: {rate: 7, from: {cone: {angle: 8 deg}}}\n"
                "    forces: [{gravity: [0, 0.4, 0]}, {drag: 0.5}]\n"
                "    look: {size: 2}\n"
                "  fire:\n"
                "    emit: {rate: 7}\n"
                "    look: {size: 3}\n");
}

static void later_overrides_win(void **state)
{
    (void)state;
    static const char *const overrides[] = {"seed=8", "seed=9", "systems={}", "backdrop={}", NULL};
    expect_same(overrides, "kiln: 1\nseed: 9\n");
}

static const struct {
    const char *override, *message;
    enum kiln_code code;
} bad[] = {
    {"seed", "--set seed: expected KEY=VALUE", KILN_USAGE},
    {"=5", "--set =5: expected KEY=VALUE", KILN_USAGE},
    {"a\x1b[3m=5", "--set a\\x1b[3m=5: expected KEY=VALUE", KILN_USAGE},
    {"seed=", "--set seed: the value after '=' is empty; '#' begins a comment", KILN_INVALID_INPUT},
    {"seed=[1", "--set seed: not valid YAML: flow sequence without a closing bracket",
     KILN_INVALID_INPUT},
    {"seed=\xff", "--set seed: not a text: invalid UTF-8 (byte 0xff)", KILN_INVALID_INPUT},
    {"seed=&x 1", "--set seed: anchors and aliases are not allowed", KILN_INVALID_INPUT},
    {"seed=1\n---\n2", "--set seed: a scene has one document; a second one starts here",
     KILN_INVALID_INPUT},
    {"seed={a: 1, a: 2}", "--set seed: duplicate key 'a'", KILN_INVALID_INPUT},
    {"sed=1", "--set sed: unknown key (did you mean 'seed'?)", KILN_INVALID_INPUT},
    {"seed.x=1",
     "--set seed.x: seed: expected a whole number from 0 to 4294967295, found a mapping",
     KILN_INVALID_INPUT},
    {"systems.smoke.emit.raet=1",
     "--set systems.smoke.emit.raet: unknown key (did you mean 'rate'?)", KILN_INVALID_INPUT},
    {"systems.smok.emit.rate=1",
     "--set systems.smok.emit.rate: there is no key 'smok' (did you mean 'smoke'?)",
     KILN_INVALID_INPUT},
    {"systems.*.emit.rate=-1",
     "--set systems.*.emit.rate: systems.smoke.emit.rate: -1 is out of range; allowed is from "
     "0 1/s to 10000000 1/s",
     KILN_INVALID_INPUT},
    {"systems.smoke.forces.7.drag=1",
     "--set systems.smoke.forces.7.drag: there is no entry 7; the list has 2", KILN_INVALID_INPUT},
    {"systems.smoke.forces.first.drag=1",
     "--set systems.smoke.forces.first.drag: 'first' is not an index into a list",
     KILN_INVALID_INPUT},
    {"systems.smoke.forces.0.drag=1",
     "--set systems.smoke.forces.0.drag: there is no key 'drag' (there are: gravity)",
     KILN_INVALID_INPUT},
    {"systems.fire.forces.0.drag=1",
     "--set systems.fire.forces.0.drag: there is no entry 0; the list is empty",
     KILN_INVALID_INPUT},
    {"systems.*.forces.*.curl=1",
     "--set systems.*.forces.*.curl: no key of the scene has this name", KILN_INVALID_INPUT},
    {"backdrop.lights.*.point.radius=1",
     "--set backdrop.lights.*.point.radius: no key of the scene has this name", KILN_INVALID_INPUT},
    {"systems.smoke.emit.from.sphere.radius=1",
     "--set systems.smoke.emit.from.sphere.radius: systems.smoke.emit.from: expected one kind, "
     "found 'cone' and 'sphere'",
     KILN_INVALID_INPUT},
    {"seed..x=1", "--set seed..x: a part of the key is empty", KILN_INVALID_INPUT},
    {"a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a=1",
     "--set a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a: a key has at "
     "most 32 parts",
     KILN_INVALID_INPUT},
};

static void bad_overrides_are_named(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const char *const overrides[] = {bad[i].override, NULL};
        struct kiln_error error = {0};
        struct kiln_scene *scene = try_scene(text, overrides, &error);
        if (scene)
            fail_msg("accepted: %s", bad[i].override);
        expect_error(&error, bad[i].code, "%s", bad[i].message);
    }
}

/* A baked wind has two spellings, and an override follows that of the scene. */
static void overrides_follow_the_spelling_of_a_wind(void **state)
{
    (void)state;
#define OF "box: {size: [1, 1, 1]}, of: [curl: 1]"
    static const struct {
        const char *wind, *override, *message;
    } cases[] = {
        {"{baked: {" OF "}}", "systems.a.forces.0.wind.every=2",
         "--set systems.a.forces.0.wind.every: must not stand beside `baked`, which chooses the "
         "kind; "
         "its keys stand inside of it, such as wind.baked.every"},
        {"{field: baked, " OF "}", "systems.a.forces.0.wind.baked.every=2",
         "--set systems.a.forces.0.wind.baked.every: systems.a.forces.0.wind.baked: must not stand "
         "beside `field`, which chooses the kind; its keys stand beside it, too, such as "
         "wind.every"},
        {"{baked: {" OF "}}", "systems.a.forces.0.wind.baked.every=2", NULL},
        {"{field: baked, " OF "}", "systems.a.forces.0.wind.every=2", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *const overrides[] = {cases[i].override, NULL};
        struct kiln_error error = {0};
        char whole[256];
        snprintf(whole, sizeof whole, "kiln: 1\nsystems: {a: {forces: [wind: %s]}}\n",
                 cases[i].wind);
        struct kiln_scene *scene = try_scene(whole, overrides, &error);
        if (cases[i].message)
            expect_error(&error, KILN_INVALID_INPUT, "%s", cases[i].message);
        else
            assert_int_equal(scene->systems[0].forces[0].every, 2);
        kiln_scene_destroy(&scene);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(overrides_change_what_they_name),
        cmocka_unit_test(stars_name_every_entry),
        cmocka_unit_test(later_overrides_win),
        cmocka_unit_test(bad_overrides_are_named),
        cmocka_unit_test(overrides_follow_the_spelling_of_a_wind),
    };
    return cmocka_run_group_tests_name("scene_override", tests, NULL, NULL);
}
