/* Checks depth of field and antialiasing by several samples a pixel: all techniques draw the same
 * picture, and the blur of objects out of focus is that of a thin lens. If this fails, blur depends
 * on the technique, or a lens of a given aperture blurs too much or too little. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "scene/instant.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/scenes.h"

enum { WIDTH = 96, HEIGHT = 64, VALUES = WIDTH * HEIGHT * 4 };

/* A scene with one of each kind of object that has drawing code of its own: a box, a mesh, a floor,
 * spheres, meshes as particles, billboards parallel to the picture and at an angle to it, points
 * and lines. */
static const char ALL[] =
    "kiln: 1\n"
    "output: {size: [96, 64], frames: 30, fps: 30, samples: 8}\n"
    "camera: {position: [0.3, 1.2, 4], target: [0, 0.8, 0], aperture: 12 cm, focus: 3.4 m,\n"
    "         shutter: {samples: 4}}\n"
    "backdrop:\n"
    "  floor: {color: 0.3, checker: 0.5 m}\n"
    "  sun: {direction: [1, 2, 1], color: 2}\n"
    "  objects:\n"
    "    - box: {center: [-1, 0.5, -1], rotation: [0, 30 deg, 0]}\n"
    "    - mesh: {file: meshes/plinth.obj, scale: 0.5, position: [1, 0, -1]}\n"
    "systems:\n"
    "  balls: {emit: {rate: 20, speed: 2}, look: {shape: sphere, size: 0.2 m}}\n"
    "  bodies: {emit: {rate: 10, speed: 3, from: {cone: {angle: 30 deg}}},\n"
    "           look: {shape: mesh, mesh: {file: meshes/plinth.obj}, size: 0.2 m}}\n"
    "  smoke: {emit: {rate: 60, speed: 3}, look: {size: 0.3 m}}\n"
    "  leaves: {emit: {rate: 60, speed: 3, from: {cone: {angle: 40 deg}}},\n"
    "           look: {facing: axial, size: 0.3 m}}\n"
    "  sparks: {emit: {rate: 100, speed: 4, from: {cone: {angle: 40 deg}}},\n"
    "           look: {shape: line, stretch: 0.02, blend: add, size: 2 cm, intensity: 2}}\n"
    "  dots: {emit: {rate: 100, speed: 3, from: {cone: {angle: 40 deg}}},\n"
    "         look: {shape: point, point: {size: 3 px}, blend: add, size: 2 cm}}\n";

/* Renders frame 15 of a scene and returns its layer `beauty`, which the caller destroys. overrides:
 * settings of keys of the scene, in a list that ends with NULL, or NULL for none; techniques:
 * "STAGE=NAME". */
static struct kiln_asset_image *draw(struct kiln_device *device, const char *text,
                                     const char *const *overrides, const char *const *techniques,
                                     size_t technique_count)
{
    char folder[] = "/tmp/kiln-lens-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/frame.exr", folder);
    struct kiln_error error = {0};
    struct kiln_scene_params of_scene = kiln_scene_defaults();
    of_scene.asset_root = KILN_SOURCE_DIR "/scenes";
    of_scene.overrides = overrides;
    while (overrides && overrides[of_scene.override_count])
        of_scene.override_count++;
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), SCENE_NAME, &of_scene, &error);
    if (!scene)
        fail_msg("%s", error.message);
    struct kiln_render_params params = kiln_render_defaults();
    const struct kiln_frame_range range = {15, 15};
    params.output = path;
    params.ranges = &range;
    params.range_count = 1;
    params.exr_bits = 32;
    params.techniques = techniques;
    params.technique_count = technique_count;
    if (!kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
    struct kiln_asset_image *image = kiln_asset_image_load_layer(NULL, path, "beauty", &error);
    if (!image)
        fail_msg("%s", error.message);
    unlink(path);
    rmdir(folder);
    assert_true(image && image->width == WIDTH && image->height == HEIGHT);
    return image;
}

/* Returns the relative difference of two pictures: the sum of |a - b| over all values, divided by
 * the sum of |a|. */
static double difference(const struct kiln_asset_image *a, const struct kiln_asset_image *b)
{
    double sum = 0, off = 0;
    for (int i = 0; i < VALUES; i++) {
        const double one = (double)((const float *)a->pixels)[i];
        sum += fabs(one);
        off += fabs(one - (double)((const float *)b->pixels)[i]);
    }
    return off / sum;
}

static void techniques_agree(void **state)
{
    static const char *const HOST[] = {"raster=cpu", "backdrop=cpu", "composite=cpu"};
    static const char *const WAYS[][3] = {
        {"raster=geometry", "backdrop=gl", "composite=gl"},
        {"raster=instanced", "backdrop=gl", "composite=cpu"},
        {"raster=tiled", "backdrop=cpu", "composite=gl"},
    };
    static const char *const SHARP[] = {"camera.aperture=0", "output.samples=1", NULL};
    struct kiln_asset_image *host = draw(*state, ALL, NULL, HOST, 3);
    for (size_t i = 0; i < sizeof WAYS / sizeof *WAYS; i++) {
        struct kiln_asset_image *other = draw(*state, ALL, NULL, WAYS[i], 3);
        const double off = difference(host, other);
        if (!(off < 2e-3))
            fail_msg("%s, %s: off by %g", WAYS[i][0], WAYS[i][1], off);
        kiln_asset_image_destroy(&other);
    }
    struct kiln_asset_image *sharp = draw(*state, ALL, SHARP, HOST, 3);
    const double blur = difference(host, sharp);
    if (!(blur > 0.01)) /* otherwise the scene has no visible blur, and the test shows nothing */
        fail_msg("blurred by %g", blur);
    kiln_asset_image_destroy(&sharp);
    kiln_asset_image_destroy(&host);
}

/* A scene with a small disc at a distance of 4 m from a lens that has an aperture of 10 cm and is
 * focused at 4 m. A test moves the disc to a distance of 2 m. */
static const char DISC[] =
    "kiln: 1\n"
    "output: {size: [96, 64], frames: 30, fps: 30, samples: 64}\n"
    "camera: {position: [0, 0, 4], target: [0, 0, 0], aperture: 10 cm, fov: 40 deg}\n"
    "backdrop: {sky: {top: 0, horizon: 0}, floor: none}\n"
    "systems:\n"
    "  disc: {emit: {bursts: {0 s: 1}, life: 100 s, speed: 0,\n"
    "                from: {point: {origin: [0, 0, 0]}}},\n"
    "         look: {shape: point, point: {size: 2 px}, blend: add, size: 2 cm, fade: {in: 0, out: "
    "0}}}\n";

/* Returns how widely the light of a picture is spread: the variance of its x plus that of its y,
 * px^2. */
static double spread(const struct kiln_asset_image *image)
{
    double sum = 0, x = 0, y = 0, squares = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double light = (double)((const float *)image->pixels)[4 * i + 1];
        const double px = i % WIDTH + 0.5, py = (double)(i / WIDTH) + 0.5;
        sum += light;
        x += light * px;
        y += light * py;
        squares += light * (px * px + py * py);
    }
    assert_true(sum > 0);
    return squares / sum - (x * x + y * y) / (sum * sum);
}

/* A disc in focus is as wide as through a pinhole. A disc at the distance d, half of the focus
 * distance, is blurred over its circle of confusion, whose diameter in the plane of focus is
 * aperture * |d - focus| / d. The variance of an evenly filled circle is half of the square of its
 * radius. */
static void the_circle_of_confusion_is_that_of_a_thin_lens(void **state)
{
    static const char *const WAYS[] = {"raster=cpu", "raster=geometry"};
    static const char *const NEAR[] = {"systems.disc.emit.from.point.origin=[0, 0, 2]", NULL};
    static const char *const PINHOLE[] = {"camera.aperture=0", NULL};
    for (int i = 0; i < 2; i++) {
        struct kiln_asset_image *sharp = draw(*state, DISC, PINHOLE, &WAYS[i], 1);
        struct kiln_asset_image *in_focus = draw(*state, DISC, NULL, &WAYS[i], 1);
        struct kiln_asset_image *near = draw(*state, DISC, NEAR, &WAYS[i], 1);
        const double pixels_per_m = 0.5 * HEIGHT / tan(20 * 3.14159265358979 / 180) / 4;
        const double radius = 0.5 * 0.1 * (4.0 - 2.0) / 2 * pixels_per_m; /* 1.1 px */
        assert_true(fabs(spread(in_focus) - spread(sharp)) < 0.01);
        const double wider = spread(near) - spread(sharp);
        if (fabs(wider - 0.5 * radius * radius) > 0.03 * radius * radius)
            fail_msg("%s: %g px^2 instead of %g", WAYS[i], wider, 0.5 * radius * radius);
        kiln_asset_image_destroy(&sharp);
        kiln_asset_image_destroy(&in_focus);
        kiln_asset_image_destroy(&near);
    }
}

static void keep_warning(void *user, enum kiln_log_level level, const char *line)
{
    if (level == KILN_LOG_WARNING)
        snprintf(user, KILN_MESSAGE_SIZE, "%s", line);
}

/* Depth of field is a mean over several moments of a frame, which are the instants that are drawn.
 * So a lens with only one moment a frame is a pinhole, which its author should know. */
static void a_lens_with_one_moment_is_a_pinhole(void **state)
{
    (void)state;
    static const char text[] = "kiln: 1\ncamera: {aperture: 3 mm}\n";
    struct kiln_error error = {0};
    char warning[KILN_MESSAGE_SIZE] = "";
    struct kiln_scene_params params = kiln_scene_defaults();
    params.log = (struct kiln_log){keep_warning, warning};
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), SCENE_NAME, &params, &error);
    assert_non_null(scene);
    assert_string_equal(warning, SCENE_NAME
                        ":2:20: camera.aperture: a lens is drawn by moments, and a frame has one: "
                        "it shows what a pinhole does; output.samples: 16 shows the lens");
    const struct kiln_instant instant = kiln_scene_instant(scene, 0, 0);
    assert_true(instant.lens_x == 0.0f && instant.lens_y == 0.0f);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(techniques_agree),
        test_on_device(the_circle_of_confusion_is_that_of_a_thin_lens),
        test_on_device(a_lens_with_one_moment_is_a_pinhole),
    };
    return cmocka_run_group_tests_name("lens", tests, test_device_open, test_device_close);
}
