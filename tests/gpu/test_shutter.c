/* Motion blur: a frame with a shutter is the mean, in linear light, of the pictures at the moments
 * while it is open, which a clip of a higher rate shows one by one. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "scene/scene.h"
#include "scene/work.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/scenes.h"

enum { WIDTH = 48, HEIGHT = 32, MOMENTS = 4, FRAME = 12 };

/* A moving camera, fire and smoke, and bloom; 240 steps a second. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [48, 32], frames: 120, fps: %s}\n"
    "simulation: {rate: 240}\n"
    "camera: {position: {keys: {0 s: [0, 1, 4], 1 s: [2, 1, 4]}}, target: [0, 1, 0], %s}\n"
    "backdrop: {objects: [{box: {}}]}\n"
    "systems:\n"
    "  smoke: {emit: {rate: 60, speed: 4}, look: {size: 0.3 m}}\n"
    "  fire: {emit: {rate: 60, speed: 8},\n"
    "         look: {atlas: \"builtin:spark\", blend: add, size: 0.2 m, intensity: 4,\n"
    "                bloom: [1, 1, 1]}}\n"
    "post: {%s}\n";

static const char *const LAYERS[] = {"beauty", "fire", "smoke", "bloom"};

static void render(struct kiln_device *device, const char *fps, const char *camera,
                   const char *post, const char *output, uint32_t first, uint32_t last)
{
    char text[2048];
    snprintf(text, sizeof text, SCENE, fps, camera, post);
    struct kiln_scene *scene = load_scene(text, NULL);
    struct kiln_error error = {0};
    struct kiln_render_params params = kiln_render_defaults();
    const struct kiln_frame_range range = {first, last};
    params.output = output;
    params.ranges = &range;
    params.range_count = 1;
    params.exr_bits = 32;
    params.overwrite = true;
    if (!kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
}

/* A layer of a picture, of WIDTH * HEIGHT * 4 floats. */
static struct kiln_asset_image *load_layer(const char *path, const char *layer)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_load_layer(NULL, path, layer, &error);
    if (!image)
        fail_msg("%s", error.message);
    assert_true(image && image->width == WIDTH && image->height == HEIGHT &&
                image->type == KILN_IMAGE_F32);
    return image;
}

static void check(void *device, const char *post)
{
    char folder[] = "/tmp/kiln-shutter-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    /* Half a frame of 8 steps is 4 moments, one a step. */
    snprintf(path, sizeof path, "%s/blurred.exr", folder);
    render(device, "30", "shutter: {samples: 4, angle: 180 deg}", post, path, FRAME, FRAME);
    snprintf(path, sizeof path, "%s/moment_%%02d.exr", folder);
    render(device, "240", "roll: 0 deg", post, path, 8 * FRAME, 8 * FRAME + MOMENTS - 1);

    double difference = 0;
    for (size_t l = 0; l < sizeof LAYERS / sizeof *LAYERS; l++) {
        static double sum[WIDTH * HEIGHT * 4];
        for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
            sum[i] = 0;
        for (int m = 0; m < MOMENTS; m++) {
            snprintf(path, sizeof path, "%s/moment_%02d.exr", folder, 8 * FRAME + m);
            struct kiln_asset_image *image = load_layer(path, LAYERS[l]);
            for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
                sum[i] += (double)((const float *)image->pixels)[i] / MOMENTS;
            if (m == 0) { /* a picture that does not move would prove nothing */
                snprintf(path, sizeof path, "%s/blurred.exr", folder);
                struct kiln_asset_image *blurred = load_layer(path, LAYERS[l]);
                for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
                    difference += fabs((double)((const float *)image->pixels)[i] -
                                       (double)((const float *)blurred->pixels)[i]);
                kiln_asset_image_destroy(&blurred);
            }
            kiln_asset_image_destroy(&image);
        }
        snprintf(path, sizeof path, "%s/blurred.exr", folder);
        struct kiln_asset_image *blurred = load_layer(path, LAYERS[l]);
        for (int i = 0; i < WIDTH * HEIGHT * 4; i++) {
            double found = (double)((const float *)blurred->pixels)[i];
            if (fabs(found - sum[i]) > 2e-5 * (1 + sum[i]))
                fail_msg("%s, value %d: %g instead of %g", LAYERS[l], i, found, sum[i]);
        }
        kiln_asset_image_destroy(&blurred);
    }
    assert_true(difference > 10);
    for (int m = 0; m < MOMENTS; m++) {
        snprintf(path, sizeof path, "%s/moment_%02d.exr", folder, 8 * FRAME + m);
        unlink(path);
    }
    snprintf(path, sizeof path, "%s/blurred.exr", folder);
    unlink(path);
    rmdir(folder);
}

static void a_frame_is_the_mean_of_its_moments(void **state)
{
    check(*state, "bloom: {kind: gaussian}");
    check(*state, "bloom: {kind: pyramid}, compose: alpha");
}

/* A frame by itself is the bytes of the full run, with a shutter, too; and so is the state. */
static void a_shutter_has_its_steps(void **state)
{
    (void)state;
    char text[2048];
    snprintf(text, sizeof text, SCENE, "30", "shutter: {samples: 4, angle: 180 deg}", "");
    struct kiln_scene *scene = load_scene(text, NULL);
    for (uint32_t m = 0; m < MOMENTS; m++)
        assert_int_equal(kiln_scene_moment_step(scene, 5, m), 40 + m);
    kiln_scene_destroy(&scene);

    static const char automatic[] = "kiln: 1\noutput: {fps: 30}\n"
                                    "camera: {shutter: {samples: 5, angle: 120 deg}}\n";
    scene = load_scene(automatic, NULL);
    assert_int_equal(kiln_scene_facts(scene).steps_per_frame, 15);
    for (uint32_t m = 0; m < 5; m++)
        assert_int_equal(kiln_scene_moment_step(scene, 2, m), 30 + m);
    kiln_scene_destroy(&scene);

    static const char *const overrides[] = {"simulation.rate=120", NULL};
    struct kiln_error error = {0};
    assert_null(try_scene(automatic, overrides, &error));
    assert_string_equal(error.message,
                        SCENE_NAME ":3:29: camera.shutter.samples: the 5 moments of the shutter "
                                   "need a step each: simulation.rate must be at least 450");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_frame_is_the_mean_of_its_moments),
        test_on_device(a_shutter_has_its_steps),
    };
    return cmocka_run_group_tests_name("shutter", tests, test_device_open, test_device_close);
}
