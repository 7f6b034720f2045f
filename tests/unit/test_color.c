/* lib/option/color: colours as the web writes them, alone and in scenes. */
#include <math.h>
#include <string.h>

#include "option/color.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scenes.h"

static void assert_color(const char *text, float red, float green, float blue)
{
    float linear[3] = {-1.0f, -1.0f, -1.0f};
    assert_true(kiln_color_parse(text, linear));
    assert_true(linear[0] == red && linear[1] == green && linear[2] == blue);
}

/* The curve of IEC 61966-2-1, in double precision. */
static double linear_of(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static void each_level_is_the_nearest_float(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 256; i++) {
        char text[8];
        float linear[3];
        snprintf(text, sizeof text, "#%02x%02X%02x", i, 255 - i, i);
        assert_true(kiln_color_parse(text, linear));
        const double exact = linear_of(i / 255.0);
        const double ulp = (double)(nextafterf(linear[0], 2.0f) - linear[0]);
        assert_true(fabs((double)linear[0] - exact) <= 0.5001 * ulp);
        assert_true(linear[2] == linear[0]);
    }
}

static void three_digits_stand_for_six(void **state)
{
    (void)state;
    float three[3], six[3];
    assert_true(kiln_color_parse("#a0F", three) && kiln_color_parse("#aa00ff", six));
    assert_memory_equal(three, six, sizeof three);
}

static void names_are_those_of_css(void **state)
{
    (void)state;
    assert_color("white", 1.0f, 1.0f, 1.0f);
    assert_color("Red", 1.0f, 0.0f, 0.0f);
    assert_color("black", 0.0f, 0.0f, 0.0f);
    float a[3], b[3];
    assert_true(kiln_color_parse("rebeccapurple", a) && kiln_color_parse("#663399", b));
    assert_memory_equal(a, b, sizeof a);
    assert_true(kiln_color_parse("grey", a) && kiln_color_parse("gray", b));
    assert_memory_equal(a, b, sizeof a);
    for (size_t i = 0; i < KILN_COLOR_NAMES; i++) { /* each is found, so they are sorted */
        assert_true(kiln_color_parse(kiln_color_name_at(i), a));
        if (i > 0)
            assert_true(strcmp(kiln_color_name_at(i - 1), kiln_color_name_at(i)) < 0);
    }
}

static void other_texts_are_no_colours(void **state)
{
    (void)state;
    static const char *const texts[] = {"",     "#",           "#ff",    "#ffff",   "#fffffff",
                                        "#ggg", "#+12",        "ff0000", "0xfff",   "redd",
                                        "red ", "transparent", "# fff",  "#12345 ", "none"};
    float linear[3];
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_false(kiln_color_parse(texts[i], linear));
}

#define LOOK(color)                                                                                \
    "kiln: 1\nsystems: {a: {emit: {rate: 1}, look: {shape: sphere, opacity: 1, color: " color      \
    "}}}\n"

static void scenes_take_them_wherever_a_colour_stands(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {LOOK("red"), LOOK("[1, 0, 0]")},
        {LOOK("'#00f'"), LOOK("[0, 0, 1]")},
        {LOOK("{keys: {0 s: white, 1 s: \"#000000\"}}"), LOOK("{keys: {0 s: [1, 1, 1], 1 s: 0}}")},
        {LOOK("{life: [lime, [0, 0.5, 1], black]}"),
         LOOK("{life: [[0, 1, 0], [0, 0.5, 1], [0, 0, 0]]}")},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        struct kiln_scene *named = load_scene(pairs[i][0], NULL);
        struct kiln_scene *numbers = load_scene(pairs[i][1], NULL);
        assert_string_equal(named->hash, numbers->hash);
        kiln_scene_destroy(&named);
        kiln_scene_destroy(&numbers);
    }
}

static void overrides_take_them_without_quotes(void **state)
{
    (void)state;
    static const char *const overrides[] = {"systems.a.look.color=#0000ff", NULL};
    struct kiln_scene *set = load_scene(LOOK("red"), overrides);
    struct kiln_scene *numbers = load_scene(LOOK("[0, 0, 1]"), NULL);
    assert_string_equal(set->hash, numbers->hash);
    kiln_scene_destroy(&set);
    kiln_scene_destroy(&numbers);
}

static void errors_say_what_a_colour_is(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {LOOK("redd"),
         "test.yaml:2:73: systems.a.look.color: 'redd' is not a colour; did you mean 'red'?"},
        {"kiln: 1\nsystems:\n  a:\n    emit: {rate: 1}\n    look:\n      color: #ff0000\n",
         "test.yaml:6:7: systems.a.look.color: found nothing; a colour that begins with '#', which "
         "also begins a comment, is in quotes: \"#e61e28\""},
        {LOOK("'#ff000'"),
         "test.yaml:2:73: systems.a.look.color: expected [red, green, blue] or one number for "
         "grey, "
         "linear, each from 0 to 1000, or in sRGB \"#e61e28\", \"#abc\" or a name of CSS, or "
         "source, or {keys: {time: value}}, or {life: [...]}, found the text \"#ff000\""},
        {LOOK("[red, 0, 0]"), "test.yaml:2:74: systems.a.look.color.0: expected a number from 0 to "
                              "1000, found 'red'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error = {0};
        assert_null(try_scene(cases[i][0], NULL, &error));
        assert_true(is_error(&error, KILN_INVALID_INPUT, "%s", cases[i][1]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_level_is_the_nearest_float),
        cmocka_unit_test(three_digits_stand_for_six),
        cmocka_unit_test(names_are_those_of_css),
        cmocka_unit_test(other_texts_are_no_colours),
        cmocka_unit_test(scenes_take_them_wherever_a_colour_stands),
        cmocka_unit_test(overrides_take_them_without_quotes),
        cmocka_unit_test(errors_say_what_a_colour_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
