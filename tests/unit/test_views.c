/* What a program is told of each frame: the pixels of a PNG and the layers of an EXR, with and
 * without an output. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

enum { WIDTH = 96, HEIGHT = 54, MOST_VIEWS = 8 };

struct seen {
    size_t count;
    struct kiln_frame_layer views[MOST_VIEWS];
    void *pixels[MOST_VIEWS]; /* copies */
};

static struct kiln_device *device;
static struct kiln_scene *scene;

static int set_up(void **state)
{
    (void)state;
    static const char *const small[] = {"output.size=[96, 54]"};
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_device_params cpu = kiln_device_defaults();
    params.overrides = small;
    params.override_count = 1;
    cpu.wanted = KILN_DEVICE_CPU;
    device = kiln_device_open(&cpu, &error);
    scene = kiln_scene_load(KILN_SOURCE_DIR "/scenes/fire_beam.yaml", &params, &error);
    return device && scene ? 0 : 1;
}

static int tear_down(void **state)
{
    (void)state;
    kiln_scene_destroy(&scene);
    kiln_device_close(&device);
    return 0;
}

static void see(void *user, const struct kiln_frame_layer *view)
{
    struct seen *seen = user;
    const size_t bytes = view->row_bytes * view->height;
    assert_true(seen->count < MOST_VIEWS);
    seen->pixels[seen->count] = malloc(bytes);
    assert_non_null(seen->pixels[seen->count]);
    memcpy(seen->pixels[seen->count], view->pixels, bytes);
    seen->views[seen->count++] = *view;
}

static void forget(struct seen *seen)
{
    for (size_t i = 0; i < seen->count; i++)
        free(seen->pixels[i]);
}

/* Renders frame 10 of a scene and shows these layers of it. */
static struct seen show_scene(struct kiln_scene *of, const char *output, const char *const *layers,
                              size_t count)
{
    struct seen seen = {.count = 0};
    struct kiln_error error = kiln_error_empty();
    const struct kiln_frame_range range = {10, 10};
    struct kiln_render_params params = kiln_render_defaults();
    params.output = output;
    params.overwrite = true;
    params.ranges = &range;
    params.range_count = 1;
    params.exr_bits = 32;
    params.layers = layers;
    params.layer_count = count;
    params.picture = see;
    params.user = &seen;
    if (!kiln_render(device, of, &params, NULL, &error))
        fail_msg("%s", error.message);
    for (size_t i = 0; i < seen.count; i++) {
        const struct kiln_frame_layer *view = &seen.views[i];
        assert_true(view->size == sizeof *view && view->frame == 10);
        assert_true(view->width == WIDTH && view->height == HEIGHT);
    }
    return seen;
}

static struct seen show(const char *output, const char *const *layers, size_t count)
{
    return show_scene(scene, output, layers, count);
}

static void nothing_named_is_the_display(void **state)
{
    (void)state;
    struct seen alone = show(NULL, NULL, 0), beside = show("a.png", NULL, 0);
    struct kiln_error error = kiln_error_empty();
    struct kiln_asset_image *file = kiln_asset_image_load(NULL, "a.png", &error);
    assert_non_null(file);
    assert_true(alone.count == 1 && beside.count == 1);
    assert_string_equal(alone.views[0].layer, "display");
    assert_true(alone.views[0].samples == KILN_SAMPLES_UINT8 && alone.views[0].channels == 4);
    assert_int_equal(alone.views[0].row_bytes, 4 * WIDTH);
    assert_memory_equal(alone.pixels[0], beside.pixels[0], 4 * WIDTH * HEIGHT);
    const uint8_t *told = alone.pixels[0], *written = file->pixels;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) /* an opaque picture has no alpha in its file */
        assert_memory_equal(told + 4 * i, written + 4 * i, 3);
    kiln_asset_image_destroy(&file);
    forget(&alone);
    forget(&beside);
}

static void layers_come_in_the_order_of_their_names(void **state)
{
    (void)state;
    static const char *const layers[] = {"depth", "display", "beauty", "fire", "smoke", "bloom"};
    struct seen alone = show(NULL, layers, 6), beside = show("a.exr", layers, 6);
    struct seen display = show(NULL, NULL, 0);
    assert_true(alone.count == 6 && beside.count == 6);
    for (size_t i = 0; i < 6; i++) {
        const struct kiln_frame_layer *view = &alone.views[i];
        assert_string_equal(view->layer, layers[i]);
        assert_int_equal(view->channels, i == 0 ? 1 : 4);
        assert_int_equal(view->samples, i == 1 ? KILN_SAMPLES_UINT8 : KILN_SAMPLES_FLOAT);
        assert_memory_equal(alone.pixels[i], beside.pixels[i], view->row_bytes * HEIGHT);
    }
    /* What else is asked for changes no pixel. */
    assert_memory_equal(alone.pixels[1], display.pixels[0], 4 * WIDTH * HEIGHT);
    for (size_t i = 2; i < 6; i++) { /* as the file has them */
        struct kiln_error error = kiln_error_empty();
        struct kiln_asset_image *file =
            kiln_asset_image_load_layer(NULL, "a.exr", layers[i], &error);
        if (!file)
            fail_msg("%s", error.message);
        const float *told = alone.pixels[i], *written = file->pixels;
        for (size_t k = 0; k < WIDTH * HEIGHT; k++)
            assert_memory_equal(told + 4 * k, written + 4 * k, 3 * sizeof(float));
        kiln_asset_image_destroy(&file);
    }
    forget(&alone);
    forget(&beside);
    forget(&display);
}

static struct kiln_scene *load_cloud(const char *const *overrides, size_t count)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides;
    params.override_count = count;
    struct kiln_scene *cloud =
        kiln_scene_load(KILN_SOURCE_DIR "/scenes/bench/cloud.yaml", &params, &error);
    if (!cloud)
        fail_msg("%s", error.message);
    return cloud;
}

/* The glow of fire alone is kept apart from smoke, so that the smoke layer needs no pass of its
 * own. Smoke that glows does. */
static void smoke_is_the_same_in_a_pass_of_its_own(void **state)
{
    (void)state;
    static const char *const layers[] = {"smoke", "fire"};
    const char *overrides[] = {"output.size=[96, 54]", "systems.*.look.size=0.6 m",
                               "systems.smoke.look.bloom=[0, 0, 0]"};
    struct seen seen[2];
    for (int i = 0; i < 2; i++) {
        struct kiln_scene *cloud = load_cloud(overrides, 3);
        seen[i] = show_scene(cloud, NULL, layers, 2);
        kiln_scene_destroy(&cloud);
        overrides[2] = "systems.smoke.look.bloom=[1, 0.5, 0.25]";
    }
    const float *smoke = seen[0].pixels[0];
    float most = 0.0f;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        most = smoke[4 * i + 3] > most ? smoke[4 * i + 3] : most;
    assert_true(most > 0.5f);
    for (size_t i = 0; i < 2; i++)
        assert_memory_equal(seen[0].pixels[i], seen[1].pixels[i],
                            seen[0].views[i].row_bytes * HEIGHT);
    forget(&seen[0]);
    forget(&seen[1]);
}

/* The fire layer comes with the frame, but has fire behind smoke, too: the light that a pass of its
 * own sums with post.compose: separate. */
static void fire_is_the_same_in_a_pass_of_its_own(void **state)
{
    (void)state;
    static const char *const layers[] = {"fire", "bloom"};
    const char *overrides[] = {"output.size=[96, 54]", "systems.*.look.size=0.6 m",
                               "systems.smoke.look.opacity=1", "backdrop.haze=0",
                               "post.compose=merged"};
    struct seen seen[2];
    for (int i = 0; i < 2; i++) {
        struct kiln_scene *cloud = load_cloud(overrides, 5);
        seen[i] = show_scene(cloud, NULL, layers, 2);
        kiln_scene_destroy(&cloud);
        overrides[4] = "post.compose=separate";
    }
    const float *merged = seen[0].pixels[0], *separate = seen[1].pixels[0];
    const float *visible = seen[0].pixels[1];
    size_t hidden = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        for (size_t c = 4 * i; c < 4 * i + 3; c++) /* sums in another order */
            assert_true(fabsf(merged[c] - separate[c]) <= 4e-6f * separate[c]);
        assert_true(merged[4 * i + 3] == 0.0f);
        hidden += merged[4 * i] > 0.1f && visible[4 * i] < 0.01f * merged[4 * i];
    }
    assert_true(hidden > WIDTH * HEIGHT / 10);
    forget(&seen[0]);
    forget(&seen[1]);
}

static void of_sixteen_bits_the_display_has_as_many(void **state)
{
    (void)state;
    struct seen seen = {.count = 0};
    struct kiln_error error = kiln_error_empty();
    const struct kiln_frame_range range = {10, 10};
    struct kiln_render_params params = kiln_render_defaults();
    params.output = "b.png";
    params.png_bits = 16;
    params.ranges = &range;
    params.range_count = 1;
    params.picture = see;
    params.user = &seen;
    assert_true(kiln_render(device, scene, &params, NULL, &error));
    assert_true(seen.count == 1 && seen.views[0].samples == KILN_SAMPLES_UINT16);
    assert_int_equal(seen.views[0].row_bytes, 8 * WIDTH);
    forget(&seen);
}

static void other_names_are_refused_before_anything_is_written(void **state)
{
    (void)state;
    static const char *const layers[] = {"beuaty"};
    struct seen seen = {.count = 0};
    struct kiln_error error = kiln_error_empty();
    struct kiln_render_params params = kiln_render_defaults();
    params.output = "folder/c.png";
    params.layers = layers;
    params.layer_count = 1;
    params.picture = see;
    params.user = &seen;
    assert_false(kiln_render(device, scene, &params, NULL, &error));
    expect_error(&error, KILN_USAGE,
                 "there is no layer 'beuaty', did you mean 'beauty'?; there "
                 "are display, beauty, depth, fire, smoke, bloom");
    assert_int_equal(seen.count, 0);
    assert_int_equal(access("folder", F_OK), -1);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(nothing_named_is_the_display),
        IN_FOLDER(layers_come_in_the_order_of_their_names),
        IN_FOLDER(smoke_is_the_same_in_a_pass_of_its_own),
        IN_FOLDER(fire_is_the_same_in_a_pass_of_its_own),
        IN_FOLDER(of_sixteen_bits_the_display_has_as_many),
        IN_FOLDER(other_names_are_refused_before_anything_is_written),
    };
    return cmocka_run_group_tests_name("views", tests, set_up, tear_down);
}
