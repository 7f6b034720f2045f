/* lib/scene/look_defaults.c: keys of a look whose default depends on other keys. If it failed, a
 * logo would lie askew or be mirrored, or spheres would not be lit, unless the scene says so. */
#include <math.h>
#include <string.h>

#include "scene/look_defaults.h"
#include "support/cmocka.h"

static struct kiln_scene *load(const char *look)
{
    char text[512];
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    params.asset_root = KILN_SOURCE_DIR "/scenes/textures";
    snprintf(text, sizeof text, "kiln: 1\nsystems:\n  a:\n    emit: {rate: 1}\n    look: {%s}\n",
             look);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "looks.yaml", &params, &error);
    if (!scene)
        fail_msg("%s: %s", look, error.message);
    return scene;
}

static void defaults_follow_from_other_keys(void **state)
{
    (void)state;
    static const struct {
        const char *look;
        bool is_picture;
        double largest_turn; /* deg */
        float lit;
    } cases[] = {
        {"", false, 360, 0},
        {"atlas: card.png, cells: [1, 1]", true, 0, 0},
        {"atlas: [card.png, leaf_red.png], cells: [1, 1]", true, 0, 0},
        {"atlas: card.png, cells: [2, 1]", false, 360, 0},
        {"atlas: [card.png, 'builtin:puff'], cells: [1, 1]", false, 360, 0},
        {"atlas: 'builtin:puff', cells: [1, 1]", false, 360, 0},
        {"atlas: card.png, cells: [1, 1], rotation: auto, lit: auto", true, 0, 0},
        {"atlas: card.png, cells: [1, 1], rotation: [0 deg, 90 deg], lit: 0.5", true, 90, 0.5f},
        {"rotation: -10 deg", false, -10, 0},
        {"shape: point", false, 360, 0},
        {"shape: sphere", false, 360, 1},
        {"shape: sphere, lit: 0", false, 360, 0},
        {"shape: sphere, atlas: card.png, cells: [1, 1]", false, 360, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_scene *scene = load(cases[i].look);
        const struct kiln_look *look = &scene->systems[0].look;
        const double turn = (double)look->rotation.max.constant * 180 / 3.14159265358979;
        if (kiln_look_is_picture(look) != cases[i].is_picture ||
            fabs(turn - cases[i].largest_turn) > 1e-4 || look->lit.constant != cases[i].lit)
            fail_msg("%s: turned by up to %g deg, lit %g", cases[i].look, turn,
                     (double)look->lit.constant);
        kiln_scene_destroy(&scene);
    }
}

static void a_printed_scene_has_the_values(void **state)
{
    (void)state;
    static const struct {
        const char *look, *rotation, *lit;
    } cases[] = {
        {"", "\n      rotation: [0 deg, 360 deg]\n", "\n      lit: 0\n"},
        {"atlas: card.png, cells: [1, 1]", "\n      rotation: 0 deg\n", "\n      lit: 0\n"},
        {"shape: sphere", "\n      rotation: [0 deg, 360 deg]\n", "\n      lit: 1\n"},
        {"rotation: -10 deg", "\n      rotation: -10 deg\n", "\n      lit: 0\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_scene *scene = load(cases[i].look);
        struct kiln_text text;
        assert_true(kiln_print_scene(scene, 0, &text));
        assert_non_null(strstr(text.data, cases[i].rotation));
        assert_non_null(strstr(text.data, cases[i].lit));
        kiln_text_free(&text);
        kiln_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_follow_from_other_keys),
        cmocka_unit_test(a_printed_scene_has_the_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
