/* The layers of gas of an EXR file: its depth would be found in the wrong place, a second domain or
 * an object would be forgotten, or layers would depend on threads, on the width of vectors, or on
 * whether they are asked for. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/instant.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/gas_fixture.h"
#include "support/gas_view.h"
#include "support/scenes.h"

enum { SIZE = GAS_VIEW_SIZE, MIDDLE = GAS_VIEW_MIDDLE, FLOATS = GAS_VIEW_FLOATS };

static const double HALF = 0.69314718055994531; /* optical depth of half opacity */

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most))
        fail_msg("found %.6f, expected %.6f within %g", found, expected, most);
}

static void open_view(struct gas_view *f)
{
    gas_view_open(f);
    f->layers = true;
}

/* Adds a box of 2 m, from 9 to 11 m away, of which each metre has this optical depth. */
static void add_box(struct gas_view *f, float extinction)
{
    const struct kiln_gas_look look = {.extinction = gas_view_value(extinction)};
    gas_fixture_full(gas_view_add(f, look), 32, 2.0f / 32.0f, 1.0f, 0.0f, 0.0f);
}

/* Draws the view, and returns the depths of half opacity. */
static const float *draw(struct gas_view *f)
{
    struct kiln_error error = {0};
    gas_view_draw(f);
    return kiln_image_host(&f->halfway, KILN_READ, &error);
}

/* ---- where gas is half opaque ---------------------------------------------------------------- */

/* Returns the length of a pixel's ray for a metre of depth. */
static double slant(const struct gas_view *f, int x, int y)
{
    const double a = 2.0 * (double)f->moment.view.frustum.x / SIZE * (x - SIZE / 2);
    const double b = 2.0 * (double)f->moment.view.frustum.y / SIZE * (y - SIZE / 2);
    return sqrt(1.0 + a * a + b * b);
}

static void an_even_box_is_half_opaque_behind_its_face(void **state)
{
    (void)state;
    static const float extinctions[] = {0.36f, 0.7f, 3.0f, 90.0f};
    for (size_t i = 0; i < sizeof extinctions / sizeof *extinctions; i++) {
        struct gas_view f;
        open_view(&f);
        add_box(&f, extinctions[i]);
        const float *halfway = draw(&f);
        for (int y = 12; y < SIZE - 12; y++)
            for (int x = 12; x < SIZE - 12; x++) {
                const double way = HALF / (double)extinctions[i] / slant(&f, x, y);
                assert_near((double)halfway[y * SIZE + x], 9.0 + way, 1e-5);
            }
        assert_true(halfway[0] == 1e9f); /* no gas is seen in the corner */
        gas_view_close(&f);
    }
}

static void thin_gas_is_never_half_opaque(void **state)
{
    (void)state;
    struct gas_view f;
    open_view(&f);
    add_box(&f, 0.34f); /* 2 m of it have 0.68 */
    const float *halfway = draw(&f);
    for (int i = 0; i < SIZE * SIZE; i++)
        assert_true(halfway[i] == 1e9f);
    gas_view_close(&f);
}

static void flames_that_absorb_count(void **state)
{
    (void)state;
    struct gas_view f;
    open_view(&f);
    const struct kiln_gas_look look = {.extinction = gas_view_value(0.5f),
                                       .absorption = gas_view_value(0.8f),
                                       .intensity = gas_view_value(1.0f)};
    gas_fixture_full(gas_view_add(&f, look), 32, 2.0f / 32.0f, 1.0f, 0.5f, 0.25f);
    assert_near((double)draw(&f)[MIDDLE / 4], 9.0 + HALF / 0.7, 1e-5);
    gas_view_close(&f);
}

static void an_object_before_that_place_hides_it(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    open_view(&f);
    add_box(&f, 1.0f);
    float *depth = kiln_image_host(&f.depth, KILN_READ_WRITE, &error);
    depth[MIDDLE / 4] = 9.69f;     /* the place is 0.0031 m behind */
    depth[MIDDLE / 4 + 1] = 9.70f; /* and here before the object, within the same step */
    const float *halfway = draw(&f) + MIDDLE / 4;
    assert_true(halfway[0] == 1e9f);
    assert_near((double)halfway[1], 9.0 + HALF, 1e-4);
    gas_view_close(&f);
}

static void the_camera_may_be_inside(void **state)
{
    (void)state;
    struct gas_view f;
    open_view(&f);
    add_box(&f, 2.0f);
    f.moment.view.eye.z = 0.25f;
    assert_near((double)draw(&f)[MIDDLE / 4], (double)f.moment.view.eye.w + HALF / 2.0, 1e-5);
    gas_view_close(&f);
}

/* Two boxes of 1 m lie one behind the other, at depths of 8 and 11 m. */
static void domains_add_up(void **state)
{
    (void)state;
    for (uint32_t nearer = 0; nearer < 2; nearer++) {
        struct gas_view f;
        open_view(&f);
        for (uint32_t i = 0; i < 2; i++) {
            const float extinction = i == nearer ? 0.4f : 0.8f;
            const struct kiln_gas_look look = {.extinction = gas_view_value(extinction)};
            struct kiln_gas *gas = gas_view_add(&f, look);
            gas_fixture_full(gas, 16, 1.0f / 16.0f, 1.0f, 0.0f, 0.0f);
            gas->shape.corner.y = 0.5f;
            gas->shape.corner.z = i == nearer ? 1.0f : -2.0f;
        }
        assert_near((double)draw(&f)[MIDDLE / 4], 11.0 + (HALF - 0.4) / 0.8, 1e-5);
        f.scene->gas[nearer].look.extinction = gas_view_value(1.0f); /* enough alone */
        assert_near((double)draw(&f)[MIDDLE / 4], 8.0 + HALF, 1e-5);
        f.scene->gas[nearer].look.extinction =
            gas_view_value(0.4f); /* and both together too thin */
        f.scene->gas[1 - nearer].look.extinction = gas_view_value(0.29f);
        assert_true(draw(&f)[MIDDLE / 4] == 1e9f);
        gas_view_close(&f);
    }
}

static void without_gas_all_is_far(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    open_view(&f);
    const struct kiln_gas_look look = {.extinction = gas_view_value(1.0f)};
    struct kiln_gas *gas = gas_view_add(&f, look);
    kiln_gas_init(gas, &(struct kiln_gas_shape){.cells = {32, 32, 32}, .cell = 0.1f});
    const float *halfway = draw(&f), *layer = kiln_image_host(&f.layer, KILN_READ, &error);
    for (int i = 0; i < SIZE * SIZE; i++)
        assert_true(halfway[i] == 1e9f);
    for (int i = 0; i < FLOATS; i++)
        assert_true(layer[i] == 0.0f);
    gas_view_close(&f);
}

/* ---- the gas alone --------------------------------------------------------------------------- */

static void flames_are_apart_from_smoke(void **state)
{
    (void)state;
    struct gas_view f;
    struct kiln_error error = {0};
    open_view(&f);
    const struct kiln_gas_look look = {.extinction = gas_view_value(0.7f),
                                       .albedo = gas_view_value3(0.9f, 0.9f, 0.9f),
                                       .intensity = gas_view_value(3.0f),
                                       .lights = true};
    gas_fixture_full(gas_view_add(&f, look), 32, 2.0f / 32.0f, 1.0f, 1.0f, 0.5f);
    f.light.sky_top = f.light.sky_horizon = FLOAT4(0.2f, 0.3f, 5.0f, 0);
    const float *all = gas_view_draw(&f) + MIDDLE;
    const float *layer = (const float *)kiln_image_host(&f.layer, KILN_READ, &error) + MIDDLE;
    const double opacity = 1.0 - exp(-1.4);
    const double luminance =
        0.2126 * (double)layer[0] + 0.7152 * (double)layer[1] + 0.0722 * (double)layer[2];
    assert_near(luminance, 1.5 / 0.7 * opacity, 3e-3); /* dimmed by the smoke before them */
    assert_near((double)layer[3], opacity, 1e-4);
    assert_true(all[2] > layer[2] + 0.5f); /* the picture has the sky's light in the smoke, too */
    gas_view_close(&f);
}

/* ---- bits ------------------------------------------------------------------------------------ */

/* Adds a ball of smoke and fire, and for two domains a second one behind it. */
static void add_balls(struct gas_view *f, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct kiln_gas_look look = {.extinction = gas_view_value(1.0f + (float)i),
                                           .intensity = gas_view_value(5.0f),
                                           .absorption = gas_view_value(1.0f)};
        struct kiln_gas *gas = gas_view_add(f, look);
        gas_fixture_ball(gas, 48, 2.0f / 48.0f, 0.4f, 1.0f, 0.9f);
        gas->shape.corner.z -= 2.5f * (float)i;
    }
}

static void layers_change_no_bit_of_the_picture(void **state)
{
    (void)state;
    static float expected[FLOATS];
    for (uint32_t count = 1; count <= 2; count++) {
        struct gas_view f;
        gas_view_open(&f);
        add_balls(&f, count);
        memcpy(expected, gas_view_draw(&f), sizeof expected);
        f.layers = true;
        assert_memory_equal(gas_view_draw(&f), expected, sizeof expected);
        gas_view_close(&f);
    }
}

static void threads_and_vectors_make_no_difference(void **state)
{
    (void)state;
    static float expected[FLOATS / 4];
    for (uint32_t count = 1; count <= 2; count++) {
        struct gas_view f;
        open_view(&f);
        add_balls(&f, count);
        memcpy(expected, draw(&f), sizeof expected);
        assert_true(expected[MIDDLE / 4] > 9.0f && expected[MIDDLE / 4] < 11.0f);
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            f.moment.simd = simd;
            for (f.threads = 1; f.threads <= 3; f.threads++)
                assert_memory_equal(draw(&f), expected, sizeof expected);
        }
        gas_view_close(&f);
    }
}

/* ---- jobs ------------------------------------------------------------------------------------ */

enum { WIDTH = 48, HEIGHT = 32, MOMENTS = 4, LAYERS = 5, FRAME = 12 };

/* Smoke and flames before a camera that moves sideways. */
static const char SCENE[] = "kiln: 1\n"
                            "output: {size: [48, 32], frames: 120, fps: 30}\n"
                            "simulation: {rate: 240}\n"
                            "camera: {position: {keys: {0 s: [-0.4, 0.5, 4], 1 s: [2, 0.5, 3]}},\n"
                            "         target: [0, 0.5, 0]}\n"
                            "gas:\n"
                            "  fire:\n"
                            "    box: {size: [1, 1.6, 1]}\n"
                            "    cells: 32\n"
                            "    sources:\n"
                            "      - {from: {disc: {radius: 0.3 m}}, smoke: 1, rate: 60,\n"
                            "         velocity: [0, 1, 0]}\n"
                            "    look: {extinction: 30, intensity: 900}\n";

static const char *const NAMES[LAYERS] = {"gas.density", "gas.emission", "gas.depth", "beauty",
                                          "smoke"};

struct seen {
    uint32_t count;
    float layers[LAYERS][4 * WIDTH * HEIGHT];
};

static void see(void *user, const struct kiln_frame_layer *view)
{
    struct seen *seen = user;
    assert_string_equal(view->layer, NAMES[seen->count]);
    assert_int_equal(view->channels, seen->count % 2 == 0 && seen->count < 4 ? 1 : 4);
    assert_true(view->samples == KILN_SAMPLES_FLOAT);
    memcpy(seen->layers[seen->count++], view->pixels, view->row_bytes * HEIGHT);
}

static bool render(const char *text, const char *const *overrides, uint32_t frame,
                   struct seen *seen, struct kiln_error *error)
{
    struct kiln_scene *scene = load_scene(text, overrides);
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    struct kiln_device *device = kiln_device_open(&cpu, error);
    const struct kiln_frame_range range = {frame, frame};
    struct kiln_render_params params = kiln_render_defaults();
    params.ranges = &range;
    params.range_count = 1;
    params.layers = NAMES;
    params.layer_count = LAYERS;
    params.picture = see;
    params.user = seen;
    seen->count = 0;
    const bool ok = device && kiln_render(device, scene, &params, NULL, error);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
    return ok;
}

/* With a shutter of 180 degrees, the four moments of a frame are a step apart. A clip of 240
 * frames a second draws each of them. */
static void moments_are_averaged_but_for_depths(void **state)
{
    (void)state;
    static const char *const open[] = {"camera.shutter.samples=4", NULL};
    static const char *const fast[] = {"output.fps=240", NULL};
    static struct seen blurred, sharp[MOMENTS];
    struct kiln_error error = {0};
    if (!render(SCENE, open, FRAME, &blurred, &error))
        fail_msg("%s", error.message);
    for (uint32_t i = 0; i < MOMENTS; i++)
        if (!render(SCENE, fast, 8 * FRAME + i, &sharp[i], &error))
            fail_msg("%s", error.message);
    float opaque = 0.0f, bright = 0.0f;
    size_t halves = 0;
    for (size_t i = 0; i < 4 * (size_t)WIDTH * HEIGHT; i++) {
        double sums[2] = {0.0, 0.0};
        for (size_t k = 0; k < 2 * MOMENTS; k++)
            sums[k / MOMENTS] += (double)sharp[k % MOMENTS].layers[k / MOMENTS][i] / MOMENTS;
        assert_near((double)blurred.layers[1][i], sums[1], 1e-5);
        bright = fmaxf(bright, blurred.layers[1][i]);
        if (i >= (size_t)WIDTH * HEIGHT)
            continue;
        assert_near((double)blurred.layers[0][i], sums[0], 1e-5);
        opaque = fmaxf(opaque, blurred.layers[0][i]);
        const float depth = blurred.layers[2][i];
        assert_true(depth == sharp[MOMENTS - 1].layers[2][i]);
        halves += depth < 1e9f && sharp[0].layers[2][i] != depth;
    }
    assert_true(opaque > 0.6f && bright > 0.5f && halves > 15);
}

/* Gas has no moments between steps: those within a step show the gas at its end. */
static void moments_within_a_step_show_its_gas(void **state)
{
    (void)state;
    static const char *const open[] = {"camera.position=[0, 0.5, 4]", "simulation.rate=60",
                                       "camera.shutter.samples=4", NULL};
    static const char *const fast[] = {"camera.position=[0, 0.5, 4]", "simulation.rate=60",
                                       "output.fps=60", NULL};
    static struct seen blurred, sharp[2];
    struct kiln_error error = {0};
    if (!render(SCENE, open, FRAME, &blurred, &error) ||
        !render(SCENE, fast, 2 * FRAME, &sharp[0], &error) ||
        !render(SCENE, fast, 2 * FRAME + 1, &sharp[1], &error))
        fail_msg("%s", error.message);
    double changes = 0.0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const double first = (double)sharp[0].layers[0][i], second = (double)sharp[1].layers[0][i];
        assert_near((double)blurred.layers[0][i], 0.25 * first + 0.75 * second, 1e-5);
        changes = fmax(changes, fabs(first - second));
    }
    assert_true(changes > 0.02);
}

/* A scene whose gas has the picture to itself. */
static void the_layers_make_the_picture(void **state)
{
    (void)state;
    static const char *const modes[] = {"post.compose=merged", "post.compose=separate",
                                        "post.compose=alpha", "post.compose=oit"};
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        static struct seen seen;
        const char *const overrides[] = {modes[i], "backdrop.transparent=true",
                                         "backdrop.floor=none", "post.bloom.kind=none", NULL};
        struct kiln_error error = {0};
        if (!render(SCENE, overrides, FRAME, &seen, &error))
            fail_msg("%s", error.message);
        float brightest = 0.0f;
        for (size_t k = 0; k < 4 * (size_t)WIDTH * HEIGHT; k++) {
            const float *emission = seen.layers[1], *beauty = seen.layers[3];
            const float *smoke = seen.layers[4];
            if (k % 4 == 3)
                assert_true(beauty[k] == seen.layers[0][k / 4] && smoke[k] == beauty[k]);
            else
                assert_true(beauty[k] == smoke[k] + emission[k]);
            brightest = fmaxf(brightest, emission[k]);
        }
        assert_true(brightest > 0.5f);
    }
}

static void scenes_without_gas_have_no_such_layers(void **state)
{
    (void)state;
    static struct seen seen;
    struct kiln_error error = {0};
    static const char *const off[] = {"gas.fire.enabled=false", NULL};
    assert_false(render("kiln: 1\n", NULL, 0, &seen, &error));
    expect_error(&error, KILN_USAGE,
                 "the layer 'gas.density' needs gas, of which 'test.yaml' draws none");
    assert_false(render(SCENE, off, 0, &seen, &error));
    expect_error(&error, KILN_USAGE,
                 "the layer 'gas.density' needs gas, of which 'test.yaml' draws none");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_box_is_half_opaque_behind_its_face),
        cmocka_unit_test(thin_gas_is_never_half_opaque),
        cmocka_unit_test(flames_that_absorb_count),
        cmocka_unit_test(an_object_before_that_place_hides_it),
        cmocka_unit_test(the_camera_may_be_inside),
        cmocka_unit_test(domains_add_up),
        cmocka_unit_test(without_gas_all_is_far),
        cmocka_unit_test(flames_are_apart_from_smoke),
        cmocka_unit_test(layers_change_no_bit_of_the_picture),
        cmocka_unit_test(threads_and_vectors_make_no_difference),
        cmocka_unit_test(moments_are_averaged_but_for_depths),
        cmocka_unit_test(moments_within_a_step_show_its_gas),
        cmocka_unit_test(the_layers_make_the_picture),
        cmocka_unit_test(scenes_without_gas_have_no_such_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
