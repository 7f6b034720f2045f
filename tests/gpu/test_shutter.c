/* Checks motion blur by frame blending. While the shutter is open, kiln draws the scene at several
 * instants, which it calls moments, and the frame is the mean of these pictures in linear light. A
 * moment may lie within a simulation step. If this fails, moving particles are blurred too much or
 * too little, or their streaks have gaps. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "scene/instant.h"
#include "scene/work.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/scenes.h"

enum { WIDTH = 48, HEIGHT = 32, MOMENTS = 4, FRAME = 12 };

/* A scene with a moving camera, smoke, and fire with bloom. The four %s are, in this order: the
 * frame rate, Hz; the step rate, Hz; a setting of the camera; and settings of `post`. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [48, 32], frames: 120, fps: %s}\n"
    "simulation: {rate: %s}\n"
    "camera: {position: {keys: {0 s: [0, 1, 4], 1 s: [2, 1, 4]}}, target: [0, 1, 0], %s}\n"
    "backdrop: {objects: [{box: {}}]}\n"
    "systems:\n"
    "  smoke: {emit: {rate: 60, speed: 4}, look: {size: 0.3 m}}\n"
    "  fire: {emit: {rate: 60, speed: 8},\n"
    "         look: {atlas: \"builtin:spark\", blend: add, size: 0.2 m, intensity: 4,\n"
    "                bloom: [1, 1, 1]}}\n"
    "post: {%s}\n";

static const char *const LAYERS[] = {"beauty", "fire", "smoke", "bloom"};

/* Renders the frames `first` to `last` of SCENE into EXR files at the path `output`. The other
 * arguments replace the %s of SCENE. */
static void render(struct kiln_device *device, const char *fps, const char *rate,
                   const char *camera, const char *post, const char *output, uint32_t first,
                   uint32_t last)
{
    char text[2048];
    snprintf(text, sizeof text, SCENE, fps, rate, camera, post);
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

/* Reads a layer of an EXR file: WIDTH * HEIGHT pixels of 4 floats. The caller destroys it. */
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

/* Checks that every layer of a blurred frame is the mean of 4 sharp frames of a clip that has eight
 * times the frame rate. */
static void check(void *device, const char *post)
{
    char folder[] = "/tmp/kiln-shutter-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    /* At 30 frames and 240 steps a second, a frame has 8 steps. The shutter is open during half of
     * them, so its 4 moments lie one step apart. */
    snprintf(path, sizeof path, "%s/blurred.exr", folder);
    render(device, "30", "240", "shutter: {samples: 4, angle: 180 deg}", post, path, FRAME, FRAME);
    snprintf(path, sizeof path, "%s/moment_%%02d.exr", folder);
    render(device, "240", "240", "roll: 0 deg", post, path, 8 * FRAME, 8 * FRAME + MOMENTS - 1);

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
            if (m == 0) { /* a sharp frame must differ from the blurred one */
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
            if (fabs(found - sum[i]) > (2e-5 + test_rounding()) * (1 + sum[i]))
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

/* Every layer is the mean of its moments, for two kinds of bloom and two ways to compose. */
static void a_frame_is_the_mean_of_its_moments(void **state)
{
    check(*state, "bloom: {kind: gaussian}");
    check(*state, "bloom: {kind: pyramid}, compose: alpha");
}

/* A shutter's phase delays the picture. 135 degrees are 3/8 of a frame, so frame 12 at 30 frames a
 * second shows what frame 8 * 12 + 3 shows at 240 frames a second. */
static void a_phase_shows_a_later_moment(void **state)
{
    char folder[] = "/tmp/kiln-shutter-XXXXXX", path[3][64];
    assert_non_null(mkdtemp(folder));
    static const char *const names[] = {"phase", "moment", "frame"};
    for (int i = 0; i < 3; i++)
        snprintf(path[i], sizeof path[i], "%s/%s.exr", folder, names[i]);
    const char *post = "bloom: {kind: gaussian}";
    render(*state, "30", "240", "shutter: {phase: 135 deg}", post, path[0], FRAME, FRAME);
    render(*state, "240", "240", "roll: 0 deg", post, path[1], 8 * FRAME + 3, 8 * FRAME + 3);
    render(*state, "30", "240", "roll: 0 deg", post, path[2], FRAME, FRAME);
    const size_t bytes = WIDTH * HEIGHT * 4 * sizeof(float);
    for (size_t l = 0; l < sizeof LAYERS / sizeof *LAYERS; l++) {
        struct kiln_asset_image *images[3];
        for (int i = 0; i < 3; i++)
            images[i] = load_layer(path[i], LAYERS[l]);
        assert_memory_equal(images[0]->pixels, images[1]->pixels, bytes);
        assert_memory_not_equal(images[0]->pixels, images[2]->pixels, bytes);
        for (int i = 0; i < 3; i++)
            kiln_asset_image_destroy(&images[i]);
    }
    for (int i = 0; i < 3; i++)
        unlink(path[i]);
    rmdir(folder);
}

/* The moments divide the time during which the shutter is open into equal parts. */
static void moments_lie_where_the_shutter_is_open(void **state)
{
    (void)state;
    char text[2048];
    snprintf(text, sizeof text, SCENE, "30", "240", "shutter: {samples: 4, angle: 180 deg}", "");
    struct kiln_scene *scene = load_scene(text, NULL);
    for (uint32_t m = 0; m < MOMENTS; m++) {
        const struct kiln_instant instant = kiln_scene_instant(scene, 5, m);
        assert_int_equal(instant.step, 40 + m);
        assert_true(instant.back == 0.0f);
    }
    assert_false(kiln_scene_has_instants_between(scene));
    kiln_scene_destroy(&scene);

    /* A shutter does not change the number of steps: here a frame has two. The shutter is open
     * during the first step, which the 16 moments divide into equal parts. */
    scene = load_scene("kiln: 1\noutput: {fps: 30}\ncamera: {shutter: {samples: 16}}\n", NULL);
    assert_int_equal(kiln_scene_facts(scene).steps_per_frame, 2);
    assert_true(kiln_scene_has_instants_between(scene));
    for (uint32_t m = 0; m < 16; m++) {
        const struct kiln_instant instant = kiln_scene_instant(scene, 3, m);
        assert_int_equal(instant.step, m == 0 ? 6 : 7);
        assert_true(instant.back == (m == 0 ? 0.0f : 1.0f - (float)m / 16));
        const double time_s = (6 + m / 16.0) / 60;
        assert_true(fabs((double)kiln_scene_instant_time(scene, instant) - time_s) < 1e-7);
    }
    assert_int_equal(kiln_scene_last_step(scene, 3), 7);
    kiln_scene_destroy(&scene);

    /* A frame has two steps, so a phase of 45 degrees, an eighth of a frame, is a quarter of a
     * step. */
    scene = load_scene("kiln: 1\noutput: {fps: 30}\ncamera: {shutter: {phase: 45 deg}}\n", NULL);
    assert_true(kiln_scene_has_instants_between(scene));
    const struct kiln_instant sharp = kiln_scene_instant(scene, 3, 0);
    assert_true(sharp.step == 7 && sharp.back == 0.75f);
    kiln_scene_destroy(&scene);
}

/* A shutter whose phase and angle together exceed a frame, 360 degrees, is an error. */
static void phase_and_angle_fit_into_a_frame(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    static const char text[] = "kiln: 1\ncamera: {shutter: {phase: 200 deg, samples: 2}}\n";
    assert_null(try_scene(text, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 SCENE_NAME ":2:27: camera.shutter.phase: phase and angle together are "
                            "more than the 360 deg of a frame");
    /* With a single sample the picture is sharp, so only the phase must fit into a frame. */
    struct kiln_scene *scene = load_scene("kiln: 1\ncamera: {shutter: {phase: 360 deg}}\n", NULL);
    assert_int_equal(kiln_scene_instant(scene, 3, 0).step, kiln_scene_frame_step(scene, 4));
    kiln_scene_destroy(&scene);
}

/* A scene with balls that spin and bounce, a fountain of sparks, and short-lived smoke. The shutter
 * has 5 moments a frame, some of which lie within simulation steps. */
static const char BUSY[] =
    "kiln: 1\n"
    "output: {size: [48, 32], frames: 120, fps: 30}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [0, 1, 4], target: [0, 0.8, 0], shutter: {samples: 5, angle: 300 deg}}\n"
    "backdrop: {floor: {color: 0.3}, sun: {color: 1}}\n"
    "systems:\n"
    "  balls: {emit: {rate: 20, life: 1 s, speed: 3, from: {cone: {angle: 20 deg}}},\n"
    "          forces: [gravity: {}], collide: {friction: 0.5},\n"
    "          interact: [collide: {as_drawn: true, spin: true, friction: 0.5}],\n"
    "          look: {shape: sphere, size: 0.2 m, sphere: {pattern: stripe}}}\n"
    "  smoke: {emit: {rate: 60, life: 0.3 s, speed: 2}, look: {size: 0.3 m}}\n"
    "  sparks: {emit: {rate: 300, life: 0.4 s, speed: 5, from: {cone: {angle: 30 deg}}},\n"
    "           forces: [gravity: {}], collide: {},\n"
    "           look: {shape: line, stretch: 0.01, blend: add, size: 1 cm, intensity: 4}}\n";

/* Renders the frames `first` to FRAME of BUSY with a technique of stage `simulate`. Returns the
 * picture of frame FRAME, which the caller destroys. */
static struct kiln_asset_image *draw_busy(struct kiln_device *device, const char *technique,
                                          uint32_t first)
{
    char folder[] = "/tmp/kiln-shutter-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/%%04d.exr", folder);
    struct kiln_scene *scene = load_scene(BUSY, NULL);
    struct kiln_error error = {0};
    struct kiln_render_params params = kiln_render_defaults();
    const struct kiln_frame_range range = {first, FRAME};
    params.output = path;
    params.ranges = &range;
    params.range_count = 1;
    params.exr_bits = 32;
    params.techniques = &technique;
    params.technique_count = 1;
    if (!kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
    struct kiln_asset_image *image = NULL;
    for (uint32_t frame = first; frame <= FRAME; frame++) {
        snprintf(path, sizeof path, "%s/%04u.exr", folder, frame);
        if (frame == FRAME)
            image = load_layer(path, "beauty");
        unlink(path);
    }
    rmdir(folder);
    return image;
}

/* A frame with moments within steps has the same bytes with every simulation technique that
 * supports them, and whichever frame the clip is rendered from. */
static void techniques_and_chunks_draw_the_same(void **state)
{
    struct kiln_asset_image *images[] = {draw_busy(*state, "simulate=cpu", FRAME),
                                         draw_busy(*state, "simulate=cpu", FRAME - 2),
                                         draw_busy(*state, "simulate=inplace", FRAME),
                                         draw_busy(*state, "simulate=pingpong", FRAME - 1)};
    for (size_t i = 1; i < sizeof images / sizeof *images; i++)
        assert_memory_equal(images[0]->pixels, images[i]->pixels,
                            WIDTH * HEIGHT * 4 * sizeof(float));
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        kiln_asset_image_destroy(&images[i]);
}

/* Moments within a step equal moments at the ends of shorter steps: four moments in one step of
 * 1/60 s show what four steps of 1/240 s show, since the particles fly straight. The pictures
 * differ by at most 0.1 %, since births are rounded to 1/64 of a step. */
static void moments_need_no_steps_of_their_own(void **state)
{
    static const char *const RATES[] = {"240", "60"};
    char folder[] = "/tmp/kiln-shutter-XXXXXX", path[2][64];
    assert_non_null(mkdtemp(folder));
    for (int i = 0; i < 2; i++) {
        snprintf(path[i], sizeof path[i], "%s/%d.exr", folder, i);
        render(*state, "30", RATES[i], "shutter: {samples: 4, angle: 180 deg}",
               "bloom: {kind: none}", path[i], FRAME, FRAME);
    }
    for (int layer = 1; layer <= 2; layer++) { /* fire and smoke */
        double sum = 0, off = 0;
        struct kiln_asset_image *images[] = {load_layer(path[0], LAYERS[layer]),
                                             load_layer(path[1], LAYERS[layer])};
        for (int i = 0; i < WIDTH * HEIGHT * 4; i++) {
            const double one = (double)((const float *)images[0]->pixels)[i];
            sum += fabs(one);
            off += fabs(one - (double)((const float *)images[1]->pixels)[i]);
        }
        if (!(off < 0.001 * sum))
            fail_msg("%s: off by %g of %g", LAYERS[layer], off, sum);
        kiln_asset_image_destroy(&images[0]);
        kiln_asset_image_destroy(&images[1]);
    }
    unlink(path[0]);
    unlink(path[1]);
    rmdir(folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_frame_is_the_mean_of_its_moments),
        test_on_device(a_phase_shows_a_later_moment),
        test_on_device(moments_lie_where_the_shutter_is_open),
        test_on_device(phase_and_angle_fit_into_a_frame),
        test_on_device(techniques_and_chunks_draw_the_same),
        test_on_device(moments_need_no_steps_of_their_own),
    };
    return cmocka_run_group_tests_name("shutter", tests, test_device_open, test_device_close);
}
