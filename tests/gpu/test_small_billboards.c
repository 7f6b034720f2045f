/* Checks that a billboard smaller than a few pixels adds the same total light to the picture,
 * proportional to its area, wherever its centre lies between the pixels. If this fails, moving
 * stars and streaks twinkle. */
#include <stddef.h>
#include <stdint.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, STEP = 30, PLACES = 4 };

/* The particles are 5 m from the camera and a wall is at 10 m. The soft-particle fade, (wall -
 * depth) * 0.08, thus gives them an alpha of 0.4. System b draws nothing. While it is enabled,
 * system a is drawn by the shader program for all shapes instead of the one for billboards. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [64, 48], fps: 30, frames: 100}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 13.173551 deg, near: 0.1}\n"
    "backdrop: {haze: 0}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 1, life: 10 s}\n"
    "    look: {size: 1 m, rotation: 0 deg, soft: 0.08, fade: {in: 0, out: 0}, near_fade: 0 m,\n"
    "           bloom: [0.5, 0.25, 0.125]}\n"
    "  b: {enabled: true, emit: {rate: 1}, look: {shape: point}}\n";

/* HALF_VIEW: the tangent of half of the vertical field of view; ALPHA: alpha of the particles. */
static const double HALF_VIEW = 0.11547005, DISTANCE_M = 5, WALL_M = 10, ALPHA = 0.4;

struct small {
    double width_px, length_px;
    double angle_deg; /* anticlockwise; facing=velocity takes it from the velocity */
    const char *facing;
    double tolerance; /* largest allowed relative error of the sum of alpha */
};

/* Returns the sum of a channel over all pixels of an image. */
static double sum_of(const struct kiln_image *image, int channel)
{
    double sum = 0;
    for (int p = 0; p < PIXELS; p++)
        sum += (double)image->host[4 * p + channel];
    return sum;
}

/* Draws a billboard at places that differ by fractions of a pixel, and checks the sums of alpha,
 * blue and bloom over the picture. The texture is opaque everywhere. dims: look.stretch_dims is
 * set, so that a stretched billboard has only the light of a square of its width; all_shapes: the
 * shader program for all shapes draws it. */
static void check_small(struct kiln_device *device, const struct small *s, bool dims,
                        bool all_shapes)
{
    const double pixel_m = 2 * DISTANCE_M * HALF_VIEW / HEIGHT;
    const double turn = s->angle_deg * acos(-1) / 180, longer_px = s->length_px - s->width_px;
    char size[64], angle[64], facing[64], stretch[64];
    snprintf(size, sizeof size, "systems.a.look.size=%.9g m", s->width_px * pixel_m);
    snprintf(angle, sizeof angle, "systems.a.look.rotation=%.9g deg", s->angle_deg);
    snprintf(facing, sizeof facing, "systems.a.look.facing=%s", s->facing);
    snprintf(stretch, sizeof stretch, "systems.a.look.stretch=%.9g s", longer_px * pixel_m);
    const char *spreads = dims ? "systems.a.look.stretch_dims=true" : "seed=1";
    const char *overrides[] = {size, angle, facing, stretch, spreads, "systems.b.enabled=false"};
    struct drawing d;
    drawing_init(&d, device, SCENE, overrides, all_shapes ? 5 : 6);
    const float3 velocity = {(float)-sin(turn), (float)cos(turn), 0.0f}; /* 1 m/s */
    const double want = s->width_px * (dims ? s->width_px : s->length_px) * ALPHA;
    for (int i = 0; i < PLACES * PLACES; i++) {
        const double x = (i % PLACES + 0.13) / PLACES, y = (i / PLACES + 0.29) / PLACES;
        const float3 at = {(float)(x * pixel_m), (float)(y * pixel_m), 0.0f};
        const struct kiln_particle particle = drawing_particle(0, at, velocity);
        drawing_place(&d, &particle, 1, STEP);
        drawing_run(&d, 1, (float)WALL_M);
        const double alpha = sum_of(&d.color, 3), blue = sum_of(&d.color, 2);
        if (fabs(alpha / want - 1) > s->tolerance)
            print_message("%g x %g px, %g deg, %s: sum %g for %g\n", s->width_px, s->length_px,
                          s->angle_deg, s->facing, alpha, want);
        assert_true(fabs(alpha / want - 1) <= s->tolerance);
        assert_true(fabs(blue / alpha - 1) < 1e-3); /* the texture's blue is 1 */
        assert_true(fabs(sum_of(&d.bloom, 2) / (0.125 * blue) - 1) < 1e-3);
    }
    drawing_finish(&d);
}

static void small_billboards_shed_a_steady_light(void **state)
{
    static const struct small all[] = {
        {0.33, 0.33, 0, "screen", 0.01},    {0.33, 0.33, 30, "screen", 0.05},
        {1, 1, 0, "screen", 0.01},          {1.5, 1.5, 0, "screen", 0.01},
        {1.5, 1.5, 45, "screen", 0.05},     {2.7, 2.7, 0, "screen", 0.01},
        {0.33, 0.33, 0, "viewpoint", 0.01}, {2.7, 2.7, 20, "viewplane", 0.05},
        {0.4, 14, 0, "velocity", 0.01},     {0.4, 14, 33, "velocity", 0.03},
        {1.3, 14, 71, "velocity", 0.03},    {0.4, 14, 0, "axial", 0.02},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        check_small(*state, &all[i], false, true);
        check_small(*state, &all[i], false, false);
    }
}

static void a_stretch_that_dims_keeps_the_light(void **state)
{
    static const struct small all[] = {
        {2.7, 2.7, 0, "screen", 0.01},    {0.33, 14, 0, "screen", 0.01},
        {1.3, 14, 71, "velocity", 0.03},  {0.4, 14, 0, "axial", 0.02},
        {0.4, 14, 20, "viewplane", 0.03},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        check_small(*state, &all[i], true, true);
        check_small(*state, &all[i], true, false);
    }
}

/* The light of a billboard that is seen nearly edge-on stays steady as it moves by a pixel. Its
 * axis misses the camera by 6 degrees, so that its length of 6 pixels is foreshortened to 0.6
 * pixels. The foreshortening itself changes by 4 % over the movement. */
static void thin_slivers_are_faint(void **state)
{
    static const char *const overrides[] = {"systems.a.look.facing=axial",
                                            "systems.a.look.axis=[0.1, 0, 1]",
                                            "systems.a.look.size=0.15 m"};
    struct drawing d;
    drawing_init(&d, *state, SCENE, overrides, 3);
    const double pixel_m = 2 * DISTANCE_M * HALF_VIEW / HEIGHT;
    double least = 1e9, most = 0;
    for (int i = 0; i < 10; i++) {
        const float3 at = {(float)(i * 0.1 * pixel_m), 0.0f, 0.0f};
        const struct kiln_particle particle = drawing_particle(0, at, (float3){0.0f, 0.0f, 0.0f});
        drawing_place(&d, &particle, 1, STEP);
        drawing_run(&d, 1, (float)WALL_M);
        const double sum = sum_of(&d.color, 3);
        least = fmin(least, sum);
        most = fmax(most, sum);
    }
    print_message("a sliver has sums from %g to %g\n", least, most);
    assert_true(least > 0 && most < 1.12 * least);
    drawing_finish(&d);
}

/* Returns the mean of the texture's green in the rows `from` to `to` - 1 of the picture, which has
 * a billboard of 40 px length in its middle. */
static double green_between(const struct kiln_image *image, int from, int to)
{
    double green = 0, alpha = 0;
    for (int p = from * WIDTH; p < to * WIDTH; p++) {
        green += (double)image->host[4 * p + 1];
        alpha += (double)image->host[4 * p + 3];
    }
    assert_true(alpha > 0);
    return green / alpha;
}

/* A streak shows its texture over its whole length, although its width alone would choose the level
 * of detail with a single texel. The texture's green grows from 0 at the top to 1 at the bottom. */
static void long_thin_billboards_show_their_cell_from_end_to_end(void **state)
{
    static const char *const overrides[] = {"systems.a.look.facing=velocity",
                                            "systems.a.look.size=0.0205 m", /* 0.85 px */
                                            "systems.a.look.stretch=0.94 s"};
    struct drawing d;
    drawing_init(&d, *state, SCENE, overrides, 3);
    const struct kiln_particle particle =
        drawing_particle(0, (float3){0.0f, 0.0f, 0.0f}, (float3){0.0f, 1.0f, 0.0f});
    drawing_place(&d, &particle, 1, STEP);
    drawing_run(&d, 1, (float)WALL_M);
    const double top = green_between(&d.color, 4, 9), middle = green_between(&d.color, 21, 27);
    const double bottom = green_between(&d.color, 39, 44);
    print_message("green %g, %g, %g\n", top, middle, bottom);
    assert_true(fabs(top - 0.07) < 0.03);
    assert_true(fabs(middle - 0.5) < 0.02);
    assert_true(fabs(bottom - 0.93) < 0.03);
    drawing_finish(&d);
}

int main(int argc, char **argv)
{
    (void)argc;
    static const struct CMUnitTest tests[] = {
        test_on_device(small_billboards_shed_a_steady_light),
        test_on_device(a_stretch_that_dims_keeps_the_light),
        test_on_device(thin_slivers_are_faint),
        test_on_device(long_thin_billboards_show_their_cell_from_end_to_end),
    };
    return drawing_run_rasters(tests, sizeof tests / sizeof *tests, argv);
}
