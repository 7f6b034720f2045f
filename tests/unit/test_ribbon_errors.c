/* lib/scene/ribbon: ribbons without an order would be drawn, or the words that refuse them would
 * not say why. */
#include <stddef.h>
#include <stdint.h>

#include "scene/ribbon.h"
#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/scenes.h"

static const struct bad ribbons[] = {
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1, bursts: {0 s: 5}}, look: {shape: ribbon}}}\n",
     ":2:39: systems.a.emit.bursts: ribbons are of a rate or of bursts, and this system has both"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: {0 s: 5, 1 s: 6}}, look: {shape: ribbon}}}\n",
     ":2:30: systems.a.emit.bursts: found bursts of 5 to 6 particles; all bursts of ribbons must "
     "have one number"},
    {"kiln: 1\n"
     "systems: {a: {emit: {bursts: {0 s: 1}}, look: {shape: ribbon}}}\n",
     ":2:30: systems.a.emit.bursts: found a burst of 1; a ribbon needs at least 2 particles"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1}, look: {shape: ribbon, ribbon: {texture: 1 m}}}}\n",
     ":2:72: systems.a.look.ribbon.texture: a length needs births by the metre: emit.per_metre, or "
     "per_metre of a trail"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1}, look: {shape: ribbon, atlas: [\"builtin:band\", "
     "\"builtin:trail\"]}}}\n",
     ":2:61: systems.a.look.atlas: found 2 textures; a ribbon has one, since it goes through many "
     "particles"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1}, look: {ribbon: {smooth: 17}}}}\n",
     ":2:56: systems.a.look.ribbon.smooth: 17 is out of range; allowed is from 1 to 16"},
    {"kiln: 1\n"
     "systems: {a: {emit: {rate: 1}, look: {ribbon: {facing: up}}}}\n",
     ":2:56: systems.a.look.ribbon.facing: expected camera or normal, found 'up'"},
};

/* Which particles one ribbon goes through follows from how they are born. */
static void runs_follow_from_births(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\n"
        "systems:\n"
        "  a: {emit: {rate: 5}, look: {shape: ribbon}}\n"
        "  b: {emit: {bursts: {0 s: 7, 1 s: 7}}, look: {shape: ribbon, ribbon: {smooth: 9}}}\n"
        "  c: {emit: {parent: {system: a, on: {trail: {per_metre: 4, most: 30}}}},\n"
        "      look: {shape: ribbon, ribbon: {texture: 2 m}}}\n"
        "  d: {emit: {parent: {system: a, on: {death: 6}}}, look: {shape: ribbon}}\n",
        NULL);
    const struct kiln_system *s = scene->systems;
    assert_int_equal(kiln_ribbon_run(&s[0]), 0);
    assert_int_equal(kiln_ribbon_run(&s[1]), 7);
    assert_int_equal(kiln_ribbon_run(&s[2]), 30);
    assert_int_equal(kiln_ribbon_run(&s[3]), 6);
    for (int i = 0; i < 4; i++) {
        assert_true(kiln_ribbon_joins_parent(&s[i]) == (i == 2));
        assert_true(kiln_ribbon_is_at_once(&s[i]) == (i == 1 || i == 3));
        assert_true(kiln_ribbon_per_metre(&s[i]) == (i == 2 ? 4.0 : 0.0));
    }
    assert_int_equal(kiln_ribbon_most_parts(scene), 9);
    kiln_scene_destroy(&scene);
}

BAD_TEST(ribbons)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_ribbons),
        cmocka_unit_test(runs_follow_from_births),
    };
    return cmocka_run_group_tests_name("ribbon_errors", tests, NULL, NULL);
}
