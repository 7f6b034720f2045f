/* Flipbooks that kiln writes play back in kiln: by their layout, with green up or down, and nearer
 * to the truth between the cells than without motion. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kiln.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

enum { EDGE = 64, SAMPLES = EDGE * EDGE * 4, FRAMES = 16, FIRST = 4, STEP = 3 };

#define PICTURE(frames)                                                                            \
    "kiln: 1\n"                                                                                    \
    "output: {size: [64, 64], fps: 30, frames: " frames "}\n"                                      \
    "simulation: {rate: 60}\n"                                                                     \
    "camera: {position: [0, 0, 20], target: [0, 0, 0], fov: 11.42 deg}\n" /* 4 m at the target */  \
    "backdrop: {haze: 0, floor: none, sky: {top: [0, 0, 0], horizon: [0, 0, 0]}}\n"                \
    "post: {bloom: {strength: 0}, tonemap: none}\n"                                                \
    "systems:\n"
#define CARD(layout)                                                                               \
    "  card:\n"                                                                                    \
    "    emit: {bursts: {0 s: 1}, life: 0.3 s, speed: 0}\n"                                        \
    "    look:\n"                                                                                  \
    "      {size: 4 m, soft: 0, rotation: 0 deg, spin: 0, fade: {in: 0, out: 0}, cells: [2, 2],\n" \
    "       atlas: " layout ".png, motion: " layout "_motion.png}\n"

/* A ball flies to the right and up at a constant velocity, by 3.5 pixels a cell. */
static const char moving[] =
    PICTURE("16") "  ball:\n"
                  "    emit:\n"
                  "      bursts: {0 s: 1}\n"
                  "      life: 10 s\n"
                  "      speed: 3 m/s\n"
                  "      from: {point: {origin: [-0.9, -0.6, 0], direction: [1, 0.8, 0],\n"
                  "                     angle: 0 deg}}\n"
                  "    look: {atlas: \"builtin:puff\", cells: [1, 1], size: 1.2 m, soft: 0,\n"
                  "           rotation: 0 deg, spin: 0, fade: {in: 0, out: 0}}\n";

static struct kiln_device *device;
static float truth[FRAMES][SAMPLES];

static void keep(void *user, const struct kiln_frame_layer *layer)
{
    float(*frames)[SAMPLES] = user;
    const uint8_t *pixels = layer->pixels;
    for (size_t i = 0; i < SAMPLES; i++)
        frames[layer->frame][i] = (float)pixels[i] / 255.0f;
}

static struct kiln_scene *load(const char *path, const char *const *overrides, size_t count)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides;
    params.override_count = count;
    struct kiln_scene *scene = kiln_scene_load(path, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* Renders a scene; frames get what is drawn, unless NULL. */
static void render(const struct kiln_scene *scene, struct kiln_render_params params,
                   float frames[][SAMPLES])
{
    struct kiln_error error = kiln_error_empty();
    params.picture = frames ? keep : NULL;
    params.user = frames;
    if (!kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
}

/* Writes every third frame from the fifth on as cells. */
static void write_flipbook(const char *path, bool green_down)
{
    struct kiln_scene *scene = load("moving.yaml", NULL, 0);
    struct kiln_error error = kiln_error_empty();
    struct kiln_flipbook flipbook = kiln_flipbook_empty();
    flipbook.columns = flipbook.rows = 2;
    flipbook.motion = true;
    flipbook.green_down = green_down;
    const struct kiln_frame_range last = {FIRST, FIRST + 4 * STEP - 1};
    struct kiln_frame_range cells[4];
    assert_true(kiln_flipbook_sample(&flipbook, &last, 1, cells, &error));
    struct kiln_render_params params = kiln_render_defaults();
    params.output = path;
    params.flipbook = &flipbook;
    params.ranges = cells;
    params.range_count = 4;
    render(scene, params, NULL);
    kiln_scene_destroy(&scene);
}

static int set_up(void **state)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    device = kiln_device_open(&cpu, &error);
    if (!device || test_enter_folder(state) != 0)
        return 1;
    test_write_file("moving.yaml", moving);
    test_write_file("up.yaml", PICTURE("10") CARD("up"));
    test_write_file("down.yaml", PICTURE("10") CARD("down"));
    struct kiln_scene *scene = load("moving.yaml", NULL, 0);
    render(scene, kiln_render_defaults(), truth);
    kiln_scene_destroy(&scene);
    write_flipbook("up.png", false);
    write_flipbook("down.png", true);
    return 0;
}

static int tear_down(void **state)
{
    kiln_device_close(&device);
    return test_leave_folder(state);
}

/* Plays a flipbook at the rate at which it was drawn, and returns the root of the mean squared
 * difference from the truth of the frames between its cells. override: may be NULL. */
static double play(const char *path, const char *override)
{
    static float frames[FRAMES][SAMPLES];
    struct kiln_scene *scene = load(path, &override, override ? 1 : 0);
    render(scene, kiln_render_defaults(), frames);
    kiln_scene_destroy(&scene);
    double sum = 0;
    size_t count = 0;
    for (size_t k = 1; k < 3 * STEP; k++) {
        for (size_t i = 0; k % STEP != 0 && i < SAMPLES; i++, count++) {
            const double off = (double)(frames[k][i] - truth[FIRST + k][i]);
            sum += off * off;
        }
    }
    return sqrt(sum / (double)count);
}

static void exported_motion_plays_back(void **state)
{
    (void)state;
    const double moved = play("up.yaml", NULL);
    const double mixed = play("up.yaml", "systems.card.look.motion=none");
    const double flipped = play("up.yaml", "systems.card.look.motion_green=down");
    print_message("off by %.4f with motion, %.4f without, %.4f with green flipped\n", moved, mixed,
                  flipped);
    assert_true(moved < 0.4 * mixed);
    assert_true(mixed < flipped);
}

static void both_directions_of_green_play_alike(void **state)
{
    (void)state;
    const double up = play("up.yaml", NULL), down = play("down.yaml", NULL);
    assert_true(fabs(up - down) < 1e-4);
    assert_true(play("down.yaml", "systems.card.look.motion_green=up") > 2 * down);
    char *layout = test_read_file("up.json");
    assert_non_null(strstr(layout, "\"kiln_flipbook\": 2,\n"));
    assert_non_null(strstr(layout, "\"green\": \"up\",\n"));
    free(layout);
    layout = test_read_file("down.json");
    assert_non_null(strstr(layout, "\"green\": \"down\",\n"));
    free(layout);
}

/* Gives the layout of down.png another text in place of `old`. */
static void change_layout(const char *old, const char *text)
{
    char *layout = test_read_file("down.json"), changed[16384];
    char *place = strstr(layout, old);
    assert_non_null(place);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(place - layout), layout, text,
             place + strlen(old));
    free(layout);
    test_write_file("down.json", changed);
}

/* Layouts of kiln 0.1, which have green down and say so. */
static void old_layouts_play(void **state)
{
    (void)state;
    const double before = play("down.yaml", NULL);
    change_layout("\"kiln_flipbook\": 2", "\"kiln_flipbook\": 1");
    assert_true(play("down.yaml", NULL) == before);
    change_layout("\"kiln_flipbook\": 1", "\"kiln_flipbook\": 2");
}

/* A layout lists its cells, of which a scene plays up to 2048. */
static void layouts_of_many_cells_are_read(void **state)
{
    (void)state;
    static char many[8192];
    const double before = play("down.yaml", NULL);
    size_t length = (size_t)snprintf(many, sizeof many, "\"frames\": [0");
    for (size_t i = 1; i < 2048; i++)
        length += (size_t)snprintf(many + length, sizeof many - length, ", 0");
    snprintf(many + length, sizeof many - length, "]");
    change_layout("\"frames\": [4, 7, 10, 13]", many);
    assert_true(play("down.yaml", NULL) == before);
    change_layout(many, "\"frames\": [4, 7, 10, 13]");
}

/* Returns the scale that a layout has. */
static double scale_of(const char *path)
{
    char *layout = test_read_file(path);
    const char *text = strstr(layout, "\"scale\": ");
    assert_non_null(text);
    const double scale = strtod(text + strlen("\"scale\": "), NULL);
    free(layout);
    return scale;
}

/* Without a layout, or with one of another program, the options say what a layout would. A negative
 * scale of an axis flips it. */
static void options_take_the_place_of_a_layout(void **state)
{
    (void)state;
    char scale[64], flipped[96];
    const double s = scale_of("down.json"), before = play("down.yaml", NULL);
    snprintf(scale, sizeof scale, "systems.card.look.motion_scale=%.9g", s);
    snprintf(flipped, sizeof flipped, "systems.card.look.motion_scale=[%.9g, %.9g]", s, -s);
    char *layout = test_read_file("down.json");
    for (int i = 0; i < 2; i++) {
        if (i == 0)
            assert_int_equal(remove("down.json"), 0);
        else
            test_write_file("down.json", "{\"frames\": [1, 2]}\n");
        assert_true(play("down.yaml", NULL) > 2 * before);
        assert_true(play("down.yaml", scale) > 2 * before);
        assert_true(fabs(play("down.yaml", flipped) - before) < 1e-4);
    }
    test_write_file("down.json", layout);
    free(layout);
    assert_true(fabs(play("down.yaml", scale) - before) < 1e-4); /* green is the layout's */
}

static void expect_scene_error(const char *override, const char *message)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = &override;
    params.override_count = override ? 1 : 0;
    struct kiln_scene *scene = kiln_scene_load("down.yaml", &params, &error);
    if (scene)
        fail_msg("accepted: %s", message);
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
}

#define AT_MOTION "down.yaml:12:33: systems.card.look.motion: 'down.json': "
#define AT_SCALE  "--set systems.card.look.motion_scale: "

static void faulty_layouts_and_scales_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *old, *text, *message;
    } faults[] = {
        {"\"kiln_flipbook\": 2", "\"kiln_flipbook\": 3",
         AT_MOTION "2:20: kiln_flipbook: found '3'; allowed is 1 or 2, the versions that this kiln "
                   "reads"},
        {"\"green\": \"down\"", "\"green\": \"left\"",
         AT_MOTION "22:14: motion.green: found 'left'; allowed is up or down"},
        {"\"scale\": ", "\"scale\": 99, \"was\": ",
         AT_MOTION "19:14: motion.scale: found '99'; allowed is a number above 0 and up to 10"},
    };
    for (size_t i = 0; i < 3; i++) {
        change_layout(faults[i].old, faults[i].text);
        expect_scene_error(NULL, faults[i].message);
        change_layout(faults[i].text, faults[i].old);
    }
    expect_scene_error("systems.card.look.motion_scale=10.5",
                       AT_SCALE "10.5 is out of range; allowed is from -10 to 10");
    expect_scene_error("systems.card.look.motion_scale=[1, -11]",
                       AT_SCALE "-11 is out of range; allowed is from -10 to 10");
    expect_scene_error(
        "systems.card.look.motion_scale=[1, 2, 3]",
        AT_SCALE "expected auto, a number from -10 to 10, or two of these, [right, up], found "
                 "a list");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(exported_motion_plays_back),
        cmocka_unit_test(both_directions_of_green_play_alike),
        cmocka_unit_test(old_layouts_play),
        cmocka_unit_test(layouts_of_many_cells_are_read),
        cmocka_unit_test(options_take_the_place_of_a_layout),
        cmocka_unit_test(faulty_layouts_and_scales_are_refused),
    };
    return cmocka_run_group_tests_name("flipbook_motion", tests, set_up, tear_down);
}
