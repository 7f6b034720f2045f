/* lib/option: parameters and arithmetic. If one of these tests fails, a scene with parameters loads
 * as another scene, or a bad value is taken, or its error does not say what is wrong. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "option/sine.h"
#include "scene/scene.h"
#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"
#include "support/scenes.h"

#define EMIT "emit: {rate: 5, life: 1 s, speed: 1}"

/* ---- sines ----------------------------------------------------------------------------------- */

/* These are bits that every machine must find; the C library's function is near them. */
static void sines_are_exact(void **state)
{
    (void)state;
    assert_true(kiln_sine(0) == 0 && kiln_cosine(0) == 1);
    assert_true(kiln_sine(1) == 0x1.aed548f090ceep-1);
    assert_true(kiln_cosine(1) == 0x1.14a280fb5068cp-1);
    assert_true(kiln_sine(-1e6) == -kiln_sine(1e6));
    for (int i = -100000; i <= 100000; i++) {
        const double angle = i * 0.37;
        assert_true(fabs(kiln_sine(angle) - sin(angle)) < 0x1p-50);
        assert_true(fabs(kiln_cosine(angle) - cos(angle)) < 0x1p-50);
    }
}

/* ---- arithmetic ------------------------------------------------------------------------------ */

static double roll_of(const char *text)
{
    char scene_text[256];
    snprintf(scene_text, sizeof scene_text,
             "kiln: 1\nparams: {a: {number: 3 s}, b: {integer: 4}}\ncamera: {aperture: \"%s\"}\n",
             text);
    struct kiln_scene *scene = load_scene(scene_text, NULL);
    const double value = (double)scene->camera.aperture.constant;
    kiln_scene_destroy(&scene);
    return value;
}

static void arithmetic(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } cases[] = {
        {"= 1 + 2 * 3 - 1", 6},
        {"=(1 + 2) * 3", 9},
        {"= -(-2)", 2},
        {"= 7 / 2 / 2", 1.75},
        {"= 2 m + 50 cm", 2.5},
        {"= 50 % * 3", 1.5},
        {"= 2 m/s * $a", 6},
        {"= $b * 1 m / 8", 0.5},
        {"= min(3, 1, 2) + max(1 m/s, 100 cm/s) * 1 s / 1 m", 2},
        {"= sqrt(4 m * 1 m)", 2},
        {"= floor(2.7)", 2},
        {"= sin(30 deg) * 2 + cos(0 rad)", 2},
        {"= 20 1/m * 0.1 m * 1 m / 2", 1},
        {"= 6 m / 2", 3},
        {"= 6 m/2", 3},
        {"= 1e-3 * 1000 m", 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double found = roll_of(cases[i].text);
        if (!(fabs(found - cases[i].value) < 1e-6))
            fail_msg("%s: %g", cases[i].text, found);
    }
}

#define APERTURE(text) "kiln: 1\ncamera: {aperture: \"" text "\"}\n"

static const struct bad bad_arithmetic[] = {
    {APERTURE("= 1 s + 2 m"),
     ":2:20: camera.aperture: \"= 1 s + 2 m\": s + m: both need the same unit"},
    {APERTURE("= 1 + 2 m"),
     ":2:20: camera.aperture: \"= 1 + 2 m\": no unit + m: both need the same unit"},
    {APERTURE("= 1 s"),
     ":2:20: camera.aperture: \"= 1 s\": the result has s; allowed is m, cm or mm"},
    {APERTURE("= 2 m * 1 m"),
     ":2:20: camera.aperture: \"= 2 m * 1 m\": the result has m^2; allowed is m, cm or mm"},
    {APERTURE("= 1 / 0"), ":2:20: camera.aperture: \"= 1 / 0\": division by 0"},
    {APERTURE("= 1e200 * 1e200"),
     ":2:20: camera.aperture: \"= 1e200 * 1e200\": the result is not a finite number"},
    {APERTURE("= 1e400"),
     ":2:20: camera.aperture: \"= 1e400\": expected a number, a $name, a function or '(', found "
     "'1e400'"},
    {APERTURE("= nan"), ":2:20: camera.aperture: \"= nan\": expected a number, a $name, min, max, "
                        "sin, cos, sqrt or floor, found 'nan'"},
    {APERTURE("= 3 * 4"), ":2:20: camera.aperture: = 3 * 4, which is 12 m, is out of range; "
                          "allowed is from 0 m to 10 m"},
    {APERTURE("= (1"), ":2:20: camera.aperture: \"= (1\": expected ')', found the end"},
    {APERTURE("= 1 2"), ":2:20: camera.aperture: \"= 1 2\": expected +, -, * or /, found '2'"},
    {APERTURE("="),
     ":2:20: camera.aperture: \"=\": expected a number, a $name, min, max, sin, cos, "
     "sqrt or floor, found the end"},
    {APERTURE("= sqrt(2 m)"),
     ":2:20: camera.aperture: \"= sqrt(2 m)\": sqrt takes squares of units, and found m"},
    {APERTURE("= sqrt(0 - 1)"),
     ":2:20: camera.aperture: \"= sqrt(0 - 1)\": sqrt takes a number of at least 0"},
    {APERTURE("= sin(1)"), ":2:20: camera.aperture: \"= sin(1)\": sin takes an angle, in deg or "
                           "rad, and found no unit"},
    {APERTURE("= sin(1e9 rad)"),
     ":2:20: camera.aperture: \"= sin(1e9 rad)\": sin takes at most 1000000 rad"},
    {APERTURE("= min(1, 2 s)"), ":2:20: camera.aperture: \"= min(1, 2 s)\": min of no unit and s"},
    {APERTURE("= $x"), ":2:20: camera.aperture: there is no parameter 'x' (there are none)"},
    {"kiln: 1\ncamera: {fov: \"= 40\"}\n",
     ":2:15: camera.fov: \"= 40\": the result has no unit; allowed is deg or rad"},
    {"kiln: 1\nseed: \"= 5 / 2\"\n",
     ":2:7: seed: expected a whole number from 0 to 4294967295, found the text \"= 5 / 2\""},
    {"kiln: 1\noutput: {fps: \"= 100 / 3\"}\n",
     ":2:15: output.fps: expected a rate like 30, 29.97 or 30000/1001 from 1 to 1000, found the "
     "text \"= 100 / 3\""},
};

static void arithmetic_fails(void **state)
{
    (void)state;
    expect_all(bad_arithmetic, sizeof bad_arithmetic / sizeof *bad_arithmetic);
}

/* A text of a megabyte, and brackets without end. */
static void arithmetic_is_limited(void **state)
{
    (void)state;
    struct kiln_text text = {0};
    struct kiln_error error = {0};
    kiln_text_add(&text, "kiln: 1\ncamera: {aperture: \"= ");
    for (int i = 0; i < 100000; i++)
        kiln_text_add(&text, "1 + 1 + 1 +");
    kiln_text_add(&text, "1\"}\n");
    assert_null(try_scene(text.data, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:2:20: camera.aperture: arithmetic of 1100003 bytes; at most 1000 are "
                 "allowed");
    kiln_text_free(&text);
    kiln_text_add(&text, "kiln: 1\ncamera: {aperture: \"= ");
    for (int i = 0; i < 900; i++)
        kiln_text_add(&text, i % 2 ? "(" : "-");
    kiln_text_add(&text, "\"}\n");
    assert_null(try_scene(text.data, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:2:20: camera.aperture: \"= -(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-(-"
                 "(-(...\": nested deeper than the 32 levels that are allowed");
    kiln_text_free(&text);
}

/* ---- parameters ------------------------------------------------------------------------------ */

/* Arithmetic stands wherever a row takes numbers: in colours, lists, short forms and curves. */
static void arithmetic_in_all_places(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\n"
        "params: {a: {number: 0.25}}\n"
        "output: {size: [\"= 32 * 2\", 32], fps: \"= 50 * $a\"}\n"
        "simulation: {rate: \"= 100 * $a\", bounds: {min: [\"= -4 * $a\", 0, 0], max: [1, 1, 1]}}\n"
        "systems:\n"
        "  s:\n"
        "    emit: {rate: 1, life: [\"= 4 * $a\", \"= 8 s * $a\"], speed: 1, bursts: {\"= 2 s * "
        "$a\": "
        "\"= 12 * $a\"}}\n"
        "    forces: [drag: \"= 8 * $a\", gravity: [0, \"= -$a\", 0]]\n"
        "    look: {color: \"= 2 * $a\", size: {life: [\"= $a\", \"= 2 * $a\"]}}\n",
        NULL);
    const struct kiln_system *system = &scene->systems[0];
    assert_int_equal(scene->width, 64);
    assert_true(scene->fps.num == 25 && scene->fps.den == 2);
    assert_int_equal(scene->steps_per_frame, 2);
    assert_true(scene->bounds.min[0] == -1);
    assert_true(system->emit.life.min.constant == 1 && system->emit.life.max.constant == 2);
    assert_true(system->forces[0].pull.constant == 2);
    assert_true(system->forces[1].acceleration.y.constant == -0.25f);
    assert_true(system->look.color.z.constant == 0.5f);
    assert_true(scene->keys[system->look.size.first + 1].y == 0.5f);
    kiln_scene_destroy(&scene);
}

static const char TEMPLATE[] = "kiln: 1\n"
                               "params:\n"
                               "  brand: {color: \"#ff0000\", help: colour of the sparks}\n"
                               "  length: {number: 2 s, min: 1 s, max: 30 s}\n"
                               "  half: {number: \"= $length / 2\"}\n"
                               "  amount: {number: 1, min: 0, max: 3}\n"
                               "  count: {integer: 3, min: 1}\n"
                               "  place: {vector: [0, \"= 2 * $amount\", 1 m]}\n"
                               "  shape: {choice: sphere, of: [billboard, sphere]}\n"
                               "  on: {switch: true}\n"
                               "  clip: {text: $$title}\n"
                               "  seed: {integer: $count}\n"
                               "output: {duration: $length, size: [64, 32]}\n"
                               "seed: $seed\n"
                               "camera:\n"
                               "  position: $place\n"
                               "  fov: {keys: {0 s: 30 deg, 50 %: 40 deg, $length: 50 deg}}\n"
                               "  roll: {keys: {0 s: 0 deg, \"= 75 % + 0.25 s\": 1 deg}}\n"
                               "systems:\n"
                               "  sparks:\n"
                               "    enabled: $on\n"
                               "    emit: {rate: \"= 400 * $amount\", life: $half, speed: 1}\n"
                               "    look: {color: $brand, shape: $shape}\n";

static void parameters_stand_for_values(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(TEMPLATE, NULL);
    assert_int_equal(scene->frames, 60);
    assert_int_equal(scene->seed, 3);
    assert_true(scene->camera.position.y.constant == 2);
    assert_true(scene->systems[0].emit.rate.constant == 400);
    assert_true(scene->systems[0].emit.life.min.constant == 1);
    assert_true(scene->systems[0].look.color.x.constant == 1);
    assert_int_equal(scene->systems[0].look.shape, KILN_SHAPE_SPHERE);
    assert_true(scene->keys[scene->camera.fov.first + 1].x == 1);
    assert_true(scene->keys[scene->camera.fov.first + 2].x == 2);
    assert_true(scene->keys[scene->camera.roll.first + 1].x == 1.75f);
    char *text = print_scene(scene);
    assert_null(strstr(text, "params"));
    assert_null(strstr(text, "duration"));
    struct kiln_scene *again = load_scene(text, NULL);
    assert_string_equal(scene->hash, again->hash);
    free(text);
    kiln_scene_destroy(&again);
    kiln_scene_destroy(&scene);
}

static void parameters_take_values(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        TEMPLATE, (const char *const[]){"params.length=10", "params.amount=2",
                                        "params.brand=#00ff00", "params.shape=billboard",
                                        "params.on=false", "params.place=[1, 2, 300 cm]",
                                        "systems.sparks.emit.speed== $amount * 3", NULL});
    assert_int_equal(scene->frames, 300);
    assert_true(scene->systems[0].emit.life.min.constant == 5);
    assert_true(scene->systems[0].look.color.y.constant == 1);
    assert_true(scene->camera.position.z.constant == 3);
    assert_false(scene->systems[0].enabled);
    kiln_scene_destroy(&scene);
}

static const struct {
    const char *override, *message;
} bad_values[] = {
    {"params.length=40 s",
     "--set params.length: 40 s is out of range; allowed is from 1 s to 30 s; declared at "
     "test.yaml:4:3"},
    {"params.length=3 m",
     "--set params.length: unit 'm' is wrong; allowed is s, ms, min or h; declared at "
     "test.yaml:4:3"},
    {"params.length=nan",
     "--set params.length: nan is not a finite number; declared at test.yaml:4:3"},
    {"params.length=1e400", "--set params.length: expected a number from 1 s to 30 s, found "
                            "'1e400'; declared at test.yaml:4:3"},
    {"params.length=$amount", "--set params.length: expected a number from 1 s to 30 s, found "
                              "'$amount'; declared at test.yaml:4:3"},
    {"params.length== 2 s", "--set params.length: expected a number from 1 s to 30 s, found '= 2 "
                            "s'; declared at test.yaml:4:3"},
    {"params.count=0", "--set params.count: 0 is out of range; allowed is from 1 to 4294967295; "
                       "declared at test.yaml:7:3"},
    {"params.shape=cube", "--set params.shape: expected billboard or sphere, found 'cube'; "
                          "declared at test.yaml:9:3"},
    {"params.on=1", "--set params.on: expected true or false, found '1'; declared at "
                    "test.yaml:10:3"},
    {"params.lenght=1", "--set params.lenght: there is no parameter 'lenght' (did you mean "
                        "'length'?)"},
    {"params.place=[0, 1e6, 2 s]",
     "--set params.place: params.place.2: unit 's' is wrong; allowed is m, cm or mm; "
     "declared at test.yaml:8:3"},
    {"params={}", "--set params: this key must stand in the file"},
    {"params.length={life: [1, 2]}",
     "--set params.length: expected a number from 1 s to 30 s, found a mapping; declared at "
     "test.yaml:4:3"},
};

static void bad_values_are_named(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad_values / sizeof *bad_values; i++) {
        struct kiln_error error = {0};
        if (try_scene(TEMPLATE, (const char *const[]){bad_values[i].override, NULL}, &error))
            fail_msg("accepted: %s", bad_values[i].override);
        expect_error(&error, KILN_INVALID_INPUT, "%s", bad_values[i].message);
    }
}

#define PARAMS(text) "kiln: 1\nparams:\n  " text "\n"

static const struct bad bad_declarations[] = {
    {PARAMS("a: {number: $b}\n  b: {number: $a}"),
     ":3:3: params.a: the parameter depends on itself"},
    {PARAMS("a: {number: \"= 2 * $a\"}"), ":3:3: params.a: the parameter depends on itself"},
    {PARAMS("a: 1"),
     ":3:6: params.a: expected a mapping such as {number: 1, min: 0, max: 2}, found "
     "'1'"},
    {PARAMS("a: {min: 1}"), ":3:6: params.a: expected a kind with the default: number, integer, "
                            "color, vector, choice, switch, text or file"},
    {PARAMS("a: {number: 1, color: red}"),
     ":3:18: params.a: expected one kind, found 'number' and 'color'"},
    {PARAMS("a: {numbre: 1}"), ":3:7: params.a.numbre: unknown key (did you mean 'number'?)"},
    {PARAMS("a-b: {number: 1}"),
     ":3:3: params.a-b: the name of a parameter starts with a letter and "
     "has at most 32 letters, digits and '_'"},
    {PARAMS("a: {number: 5, max: 3}"),
     ":3:15: params.a: 5 is out of range; allowed is from -1e+30 to 3"},
    {PARAMS("a: {number: 5 s, max: 3 m}"),
     ":3:25: params.a.max: unit 'm' is wrong; allowed is s, ms, min or h"},
    {PARAMS("a: {number: 5, min: 6, max: 3}"), ":3:6: params.a: min is above max"},
    {PARAMS("a: {number: red}"), ":3:15: params.a: expected a number from -1e+30 to 1e+30, found "
                                 "'red'"},
    {PARAMS("a: {color: red, min: 3}"), ":3:19: params.a.min: a color has no range"},
    {PARAMS("a: {choice: x}"),
     ":3:6: params.a: a choice needs a list of its words, `of: [one, two]`"},
    {PARAMS("a: {choice: x, of: [y]}"), ":3:15: params.a: expected y, found 'x'"},
    {PARAMS("a: {text: x, of: [y]}"), ":3:16: params.a: only a choice has `of`"},
    {PARAMS("a: {file: ../x.png}"), ":3:13: params.a: '../x.png' is outside the asset root; a path "
                                    "starts at the scene's folder and "
                                    "stays below it"},
    {PARAMS("a: {file: /etc/passwd}"), ":3:13: params.a: '/etc/passwd' is outside the asset root; "
                                       "a path starts at the scene's folder "
                                       "and stays below it"},
    {PARAMS("a: {number: 5 m}\noutput: {duration: $a}"),
     ":3:15: output.duration: unit 'm' is wrong; allowed is s, ms, min or h; as $a at "
     "test.yaml:4:20"},
    {PARAMS("a: {color: red}\noutput: {duration: \"= 2 * $a\"}"),
     ":4:20: output.duration: $a is a color, and arithmetic takes numbers"},
    {PARAMS("ab: {number: 1}\noutput: {duration: $ba}"),
     ":4:20: there is no parameter 'ba' (did you mean 'ab'?); $$ba is the text $ba"},
    {"kiln: 1\nparams: [a]\n", ":2:9: params: expected a mapping of names, found a list"},
    {"kiln: 1\noutput: {duration: 2 s, frames: 3}\n",
     ":2:10: output.duration: cannot be given together with `frames`"},
    {"kiln: 1\noutput: {duration: 1 ms}\n",
     ":2:20: output.duration: 0 frames are out of range; allowed is from 1 to 1000000"},
};

static void bad_declarations_are_named(void **state)
{
    (void)state;
    expect_all(bad_declarations, sizeof bad_declarations / sizeof *bad_declarations);
}

static void parameters_are_limited(void **state)
{
    (void)state;
    struct kiln_text text = {0};
    struct kiln_error error = {0};
    kiln_text_add(&text, "kiln: 1\nparams:\n");
    for (int i = 0; i < 257; i++)
        kiln_text_add(&text, "  p%d: {number: %d}\n", i, i);
    assert_null(try_scene(text.data, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:3:3: params: found 257 parameters; at most 256 are allowed");
    kiln_text_free(&text);
    kiln_text_add(&text, "kiln: 1\nparams:\n");
    for (int i = 0; i < 200; i++)
        kiln_text_add(&text, "  p%d: {number: \"= $p%d + 1\"}\n", i, i + 1);
    assert_null(try_scene(text.data, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "test.yaml:19:3: params.p16: more than 16 parameters depend on each other");
    kiln_text_free(&text);
    kiln_text_add(&text, "params.clip=");
    for (int i = 0; i < 1000000; i++)
        kiln_text_add(&text, "0123456789");
    assert_null(try_scene(TEMPLATE, (const char *const[]){text.data, NULL}, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "--set params.clip: the text has 10000000 bytes; at most 4000 are allowed; "
                 "declared at test.yaml:11:3");
    kiln_text_free(&text);
}

/* ---- the list of parameters ------------------------------------------------------------------ */

static void parameters_are_listed(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        TEMPLATE, (const char *const[]){"params.length=10 s", "params.shape=billboard", NULL});
    struct kiln_scene_param list[20];
    memset(list, '#', sizeof list);
    for (size_t i = 0; i < 20; i++)
        list[i].size = sizeof *list;
    assert_int_equal(kiln_scene_list_params(scene, NULL, 0, 0), 10);
    assert_int_equal(kiln_scene_list_params(scene, list, sizeof *list, 20), 10);
    assert_string_equal(list[0].name, "brand");
    assert_string_equal(list[0].value, "\"#ff0000\"");
    assert_string_equal(list[0].help, "colour of the sparks");
    assert_string_equal(list[0].place, "test.yaml:3:3");
    assert_string_equal(kiln_param_kind_name(list[0].kind), "color");
    assert_int_equal(list[1].kind, KILN_PARAM_NUMBER);
    assert_string_equal(list[1].value, "10");
    assert_string_equal(list[1].fallback, "2");
    assert_string_equal(list[1].unit, "s");
    assert_true(list[1].has_min && list[1].min == 1 && list[1].has_max && list[1].max == 30);
    assert_string_equal(list[2].value, "5"); /* half of the length */
    assert_string_equal(list[5].value, "[0, 2, 1]");
    assert_string_equal(list[6].value, "\"billboard\"");
    assert_int_equal(list[6].word_count, 2);
    assert_string_equal(list[6].words[1], "sphere");
    assert_string_equal(list[6].schema, "{\"enum\": [\"billboard\", \"sphere\"]}");
    assert_string_equal(list[7].value, "true");
    assert_string_equal(list[8].value, "\"$title\"");
    assert_false(list[8].has_min || list[8].has_max);
    /* An older caller has less room for each. */
    struct older {
        size_t size;
        const char *name;
    } older[2] = {{sizeof *older, NULL}, {sizeof *older, NULL}};
    assert_int_equal(
        kiln_scene_list_params(scene, (struct kiln_scene_param *)older, sizeof *older, 2), 10);
    assert_string_equal(older[1].name, "length");
    kiln_scene_destroy(&scene);
}

/* ---- files of parameters --------------------------------------------------------------------- */

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void files_of_parameters(void **state)
{
    (void)state;
    char folder[32], path[64], message[256];
    struct kiln_error error = {0};
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/values.yaml", folder);
    const char *const files[] = {path}, *const overrides[] = {"params.amount=2"};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.params_files = files;
    params.params_file_count = 1;
    params.overrides = overrides;
    params.override_count = 1;
    write_text(path, "{\"length\": 4, \"amount\": 3, \"brand\": \"#0000ff\"}\n");
    struct kiln_scene *scene =
        kiln_scene_parse(TEMPLATE, strlen(TEMPLATE), "test.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    assert_int_equal(scene->frames, 120);
    assert_true(scene->systems[0].emit.rate.constant == 800); /* --set wins */
    assert_true(scene->systems[0].look.color.z.constant == 1);
    assert_non_null(scene->files->status);
    kiln_scene_destroy(&scene);
    write_text(path, "length: 4 s\namount: 9\n");
    params.override_count = 0;
    assert_null(kiln_scene_parse(TEMPLATE, strlen(TEMPLATE), "test.yaml", &params, &error));
    snprintf(message, sizeof message,
             "%s:2:9: params.amount: 9 is out of range; allowed is from 0 to 3; declared at "
             "test.yaml:6:3",
             path);
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
    write_text(path, "lenght: 4 s\n");
    assert_null(kiln_scene_parse(TEMPLATE, strlen(TEMPLATE), "test.yaml", &params, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s:1:1: there is no parameter 'lenght' (did you mean 'length'?)", path);
    test_remove_folder(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sines_are_exact),
        cmocka_unit_test(arithmetic),
        cmocka_unit_test(arithmetic_fails),
        cmocka_unit_test(arithmetic_in_all_places),
        cmocka_unit_test(arithmetic_is_limited),
        cmocka_unit_test(parameters_stand_for_values),
        cmocka_unit_test(parameters_take_values),
        cmocka_unit_test(bad_values_are_named),
        cmocka_unit_test(bad_declarations_are_named),
        cmocka_unit_test(parameters_are_limited),
        cmocka_unit_test(parameters_are_listed),
        cmocka_unit_test(files_of_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
