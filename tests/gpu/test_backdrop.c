/* Checks how each technique draws the backdrop (floor, sky and solid objects;
 * lib/draw/backdrop/backdrop.c) of small scenes. The depth must equal that of a ray caster in C,
 * floor and sky must have the computed light, bright edges must be antialiased, and a frame in
 * which something moved must be drawn again. If this fails, objects lie in the wrong place, have
 * the wrong brightness or jagged edges, or an earlier frame stays in the picture. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/backdrop/backdrop.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"

enum { WIDTH = 96, HEIGHT = 54 };

static const struct kiln_lighting NO_LIGHTING = {0};

static const char SCENE[] = "kiln: 1\n"
                            "output: {size: [96, 54], frames: 3, fps: 60}\n"
                            "camera:\n"
                            "  position: {keys: {0 s: [3, 2, 6], 1 s: [3.5, 2, 6]}}\n"
                            "  target: [0.5, 1, 0]\n"
                            "  fov: 50 deg\n"
                            "backdrop:\n"
                            "  haze: 0\n"
                            "  sky: {top: [0.1, 0.2, 0.4], horizon: [0.4, 0.3, 0.2]}\n"
                            "  sun: {direction: [0, 1, 0], color: [2, 1, 0.5]}\n"
                            "  floor: {color: [0.5, 0.4, 0.3], height: -0.5 m}\n"
                            "  objects:\n"
                            "    - box: {center: [0, 0.75, 0], size: [1, 1.5, 1]}\n"
                            "    - box: {center: [1.5, 0, -1], size: [0.5, 1, 2]}\n";

struct fixture {
    struct kiln_scene *scene;
    struct kiln_image color, depth;
    struct kiln_moment moment;
    struct kiln_backdrop_stage *stage;
};

static struct fixture fixture_of(const char *scene)
{
    struct kiln_error error = {0};
    struct fixture f = {.scene = kiln_scene_parse(scene, strlen(scene), "test", NULL, &error)};
    if (!f.scene)
        fail_msg("%s", error.message);
    return f;
}

static struct fixture fixture_create(void)
{
    return fixture_of(SCENE);
}

static void fixture_start(struct fixture *f, void *device)
{
    struct kiln_error error = {0};
    kiln_image_init(&f->color, device, WIDTH, HEIGHT, GL_RGBA32F, "color");
    kiln_image_init(&f->depth, device, WIDTH, HEIGHT, GL_R32F, "depth");
    assert_true(kiln_moment_init(&f->moment, device, f->scene, NULL, &error));
    f->stage = backdrop_create(device, &f->moment, &f->color, &f->depth, &error);
    if (!f->stage)
        fail_msg("%s", error.message);
}

static void fixture_end(struct fixture *f)
{
    kiln_backdrop_destroy(&f->stage);
    kiln_moment_finish(&f->moment);
    kiln_image_finish(&f->color);
    kiln_image_finish(&f->depth);
    kiln_scene_destroy(&f->scene);
}

/* Computes the direction, in the world, of the ray from `eye`, m, through the place (px, py) of the
 * picture, px from the top left. The camera is that of SCENE. The point eye + t * direction has the
 * view depth t, m. */
static void camera_ray(double px, double py, const double eye[3], double direction[3])
{
    const double target[3] = {0.5, 1, 0};
    double f[3], length = 0;
    for (int i = 0; i < 3; i++) {
        f[i] = target[i] - eye[i];
        length += f[i] * f[i];
    }
    for (int i = 0; i < 3; i++)
        f[i] /= sqrt(length);
    double flat = sqrt(f[0] * f[0] + f[2] * f[2]);
    const double right[3] = {-f[2] / flat, 0, f[0] / flat};
    const double up[3] = {right[1] * f[2] - right[2] * f[1], right[2] * f[0] - right[0] * f[2],
                          right[0] * f[1] - right[1] * f[0]};
    double tan_y = tan(25.0 * acos(-1.0) / 180.0);
    double x = (2 * px / WIDTH - 1) * tan_y * WIDTH / HEIGHT, y = (1 - 2 * py / HEIGHT) * tan_y;
    for (int i = 0; i < 3; i++)
        direction[i] = f[i] + x * right[i] + y * up[i];
}

/* Returns the t at which the ray o + t * d enters a box, or 1e9 if it misses the box. center, size:
 * of the box, m. */
static double box_hit(const double center[3], const double size[3], const double o[3],
                      const double d[3])
{
    double in = -1e30, out = 1e30;
    for (int i = 0; i < 3; i++) {
        double a = (center[i] - 0.5 * size[i] - o[i]) / d[i];
        double b = (center[i] + 0.5 * size[i] - o[i]) / d[i];
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    return in <= out && in > 0 ? in : 1e9;
}

/* Returns the view depth, m, of the surface of SCENE that is seen from `eye` at the place (px, py)
 * of the picture, px; 1e9 for the sky. */
static double scene_depth(const double eye[3], double px, double py)
{
    static const double centers[2][3] = {{0, 0.75, 0}, {1.5, 0, -1}};
    static const double sizes[2][3] = {{1, 1.5, 1}, {0.5, 1, 2}};
    double d[3];
    camera_ray(px, py, eye, d);
    double t = d[1] < 0 ? (-0.5 - eye[1]) / d[1] : 1e9;
    for (int i = 0; i < 2; i++)
        t = fmin(t, box_hit(centers[i], sizes[i], eye, d));
    return t;
}

/* The view depth of every pixel equals that of the ray caster, up to a relative error of 2e-4. */
static void depth_matches_c(void **state)
{
    struct kiln_error error = {0};
    struct fixture f = fixture_create();
    fixture_start(&f, *state);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    assert_true(kiln_backdrop_draw(f.stage, &f.moment, &NO_LIGHTING, &error));
    const float *depth = kiln_image_host(&f.depth, KILN_READ, &error);
    assert_non_null(depth);
    const double eye[3] = {3, 2, 6};
    int compared = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            double t = scene_depth(eye, x + 0.5, y + 0.5);
            /* Skips the pixel if its ray hits another surface at 0.01 px from its middle: rounding
             * decides which of the two surfaces the driver draws. */
            double near = scene_depth(eye, x + 0.51, y + 0.51);
            double far = scene_depth(eye, x + 0.49, y + 0.49);
            if (fabs(near - t) > 0.05 * t || fabs(far - t) > 0.05 * t)
                continue;
            compared++;
            if (fabs((double)depth[y * WIDTH + x] - t) > 2e-4 * t)
                fail_msg("pixel %d,%d: depth %g, expected %g", x, y, (double)depth[y * WIDTH + x],
                         t);
        }
    }
    assert_true(compared > WIDTH * HEIGHT * 9 / 10);
    fixture_end(&f);
}

/* The floor has the light that its albedo reflects of sky and sun, within 2 %, the sky's colour
 * changes towards the horizon, and alpha is 1 everywhere. */
static void sky_and_floor_have_their_colors(void **state)
{
    struct kiln_error error = {0};
    struct fixture f = fixture_create();
    fixture_start(&f, *state);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    assert_true(kiln_backdrop_draw(f.stage, &f.moment, &NO_LIGHTING, &error));
    const float *color = kiln_image_host(&f.color, KILN_READ, &error);
    assert_non_null(color);

    /* The last row shows the nearest floor, far from the boxes. The whole sky lights it with the
     * colour of the zenith, and so does the sun, which stands at the zenith. */
    const float *floor_pixel = color + 4 * ((HEIGHT - 1) * WIDTH + WIDTH - 3);
    const double pi = acos(-1.0);
    static const double albedo[3] = {0.5, 0.4, 0.3}, sun[3] = {2, 1, 0.5}, top[3] = {0.1, 0.2, 0.4};
    for (int c = 0; c < 3; c++) {
        double expected = albedo[c] * (top[c] + sun[c] / pi);
        assert_true(fabs((double)floor_pixel[c] - expected) < 0.02 * expected);
    }
    /* The sky is redder and less blue towards the horizon. */
    const float *zenith = color, *lower = color + 4 * (8 * WIDTH);
    assert_true(zenith[0] < lower[0] && zenith[2] > lower[2]);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(color[4 * i + 3] == 1.0f);
    fixture_end(&f);
}

/* The edge of a black ball before a bright sky is antialiased on the display (shared/edge_mean.h).
 * A pixel has four samples, so all five steps between black and white must occur. The sky's light
 * 2, exposed by two stops, is 8 times as bright as white: with a plain mean, a pixel of which a
 * quarter is sky would be white, and the edge would be jagged. Therefore a sample of the sky has
 * the weight 1 / (1 + 8), and a black one 1. */
static void bright_edges_have_all_steps(void **state)
{
    static const char scene[] = "kiln: 1\n"
                                "output: {size: [96, 54], frames: 3, fps: 60}\n"
                                "camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 50 deg}\n"
                                "backdrop:\n"
                                "  haze: 0\n"
                                "  sky: {top: [2, 2, 2], horizon: [2, 2, 2]}\n"
                                "  floor: none\n"
                                "  objects: [sphere: {radius: 1.7 m, color: 0}]\n"
                                "post: {exposure: 2}\n";
    struct kiln_error error = {0};
    struct fixture f = fixture_of(scene);
    fixture_start(&f, *state);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    assert_true(kiln_backdrop_draw(f.stage, &f.moment, &NO_LIGHTING, &error));
    const float *color = kiln_image_host(&f.color, KILN_READ, &error);
    assert_non_null(color);
    int steps[5] = {0}, other = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double shown = 4 * (double)color[4 * i];
        bool known = false;
        for (int k = 0; k < 5; k++) {
            const double part = k / 4.0, weight = part / 9;
            const bool is = fabs(shown - 8 * weight / (weight + 1 - part)) < 0.01;
            known |= is;
            steps[k] += is;
        }
        other += !known;
        assert_true(color[4 * i + 3] == 1.0f);
    }
    assert_int_equal(other, 0);
    for (int k = 0; k < 5; k++)
        assert_true(steps[k] >= 8);
    fixture_end(&f);
}

/* The backdrop is drawn again only if something changed: not for the same moment, but after the
 * camera moved. The test writes the depth -1 into the picture to see whether it is drawn over. */
static void only_changes_are_drawn_again(void **state)
{
    struct kiln_error error = {0};
    struct fixture f = fixture_create();
    fixture_start(&f, *state);
    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(0), false, &error));
    assert_true(kiln_backdrop_draw(f.stage, &f.moment, &NO_LIGHTING, &error));
    float *depth = kiln_image_host(&f.depth, KILN_READ_WRITE, &error);
    assert_non_null(depth);
    float before = depth[0];
    depth[0] = -1.0f;
    assert_true(kiln_backdrop_draw(f.stage, &f.moment, &NO_LIGHTING, &error));
    depth = kiln_image_host(&f.depth, KILN_READ_WRITE, &error);
    assert_true(depth[0] == -1.0f);

    assert_true(kiln_moment_fill(&f.moment, NULL, kiln_instant_at_step(30), false, &error));
    assert_true(kiln_backdrop_draw(f.stage, &f.moment, &NO_LIGHTING, &error));
    depth = kiln_image_host(&f.depth, KILN_READ, &error);
    assert_true(depth[0] == before);
    fixture_end(&f);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(depth_matches_c),
        test_on_device(sky_and_floor_have_their_colors),
        test_on_device(bright_edges_have_all_steps),
        test_on_device(only_changes_are_drawn_again),
    };
    return backdrops_run("backdrop", tests, sizeof tests / sizeof *tests, false, argc, argv);
}
