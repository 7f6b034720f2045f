/* Checks the reflections of a glossy floor of the backdrop against formulas in double precision:
 * sky and objects by Fresnel's law, lamps by a rough specular lobe, and moving waves. If this
 * fails, water and wet ground show reflections of the wrong place or brightness. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "draw/backdrop/backdrop.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"

enum { WIDTH = 96, HEIGHT = 54 };

/* The beginning of each scene's text. The eye is at (0, 2, 5) and looks horizontally along -z; the
 * tangent of half of the vertical field of view is 0.5. */
#define START                                                                                      \
    "kiln: 1\n"                                                                                    \
    "output: {size: [96, 54], frames: 60}\n"                                                       \
    "camera: {position: [0, 2, 5], target: [0, 2, 0], fov: 53.1301024 deg}\n"                      \
    "backdrop:\n"                                                                                  \
    "  haze: 0\n"                                                                                  \
    "  sun: {color: 0}\n"

struct picture {
    struct kiln_scene *scene;
    struct kiln_image color, depth;
    struct kiln_moment moment;
    struct kiln_backdrop_stage *stage;
    const float *colors;
};

static void draw_at(struct picture *p, uint32_t step)
{
    struct kiln_error error = {0};
    if (!kiln_moment_fill(&p->moment, NULL, kiln_instant_at_step(step), false, &error) ||
        !backdrop_draw_by_lamps(p->stage, &p->moment, &error))
        fail_msg("%s", error.message);
    p->colors = kiln_image_host(&p->color, KILN_READ, &error);
    assert_non_null(p->colors);
}

static void start(struct picture *p, void *device, const char *text)
{
    struct kiln_error error = {0};
    p->scene = kiln_scene_parse(text, strlen(text), "test", NULL, &error);
    if (!p->scene)
        fail_msg("%s", error.message);
    kiln_image_init(&p->color, device, WIDTH, HEIGHT, GL_RGBA32F, "color");
    kiln_image_init(&p->depth, device, WIDTH, HEIGHT, GL_R32F, "depth");
    assert_true(kiln_moment_init(&p->moment, device, p->scene, NULL, &error));
    p->stage = backdrop_create(device, &p->moment, &p->color, &p->depth, &error);
    if (!p->stage)
        fail_msg("%s", error.message);
    draw_at(p, 0);
}

static void finish(struct picture *p)
{
    kiln_backdrop_destroy(&p->stage);
    kiln_moment_finish(&p->moment);
    kiln_image_finish(&p->color);
    kiln_image_finish(&p->depth);
    kiln_scene_destroy(&p->scene);
}

/* Computes the ray through the place (px, py) of the picture, px from the top left, below the
 * horizon: its unit direction `way`, and the point where it meets the floor, m. */
static void floor_ray(double px, double py, double way[3], double point[3])
{
    double d[3] = {(2 * px / WIDTH - 1) * 0.5 * WIDTH / HEIGHT, (1 - 2 * py / HEIGHT) * 0.5, -1};
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + 1), t = -2 / d[1];
    for (int i = 0; i < 3; i++)
        way[i] = d[i] / length;
    point[0] = t * d[0];
    point[1] = 0;
    point[2] = 5 - t;
}

static double fresnel(double cosine)
{
    return 0.02 + 0.98 * pow(1 - cosine, 5);
}

/* Returns whether the box of the scene MIRRORS is reflected at `point` of the floor. way: unit
 * direction from the eye to the point. */
static bool meets_box(const double way[3], const double point[3])
{
    const double low[3] = {-1, 0.5, -4}, high[3] = {1, 1.5, -3}, d[3] = {way[0], -way[1], way[2]};
    double in = 0, out = 1e30;
    for (int i = 0; i < 3; i++) {
        double a = (low[i] - point[i]) / d[i], b = (high[i] - point[i]) / d[i];
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    return in < out;
}

static const char MIRRORS[] =
    START "  sky: {top: 0.1, horizon: 0.8}\n"
          "  floor: {color: 0, gloss: 0.75}\n"
          "  objects: [box: {center: [0, 1, -3.5], size: [2, 1, 1], color: 0}]\n";

/* A black floor reflects the sky by Fresnel's law, and where a black box is reflected, the floor
 * stays black. Pixels on the outline of the reflected box are skipped. */
static void sky_and_objects_are_mirrored(void **state)
{
    struct picture p;
    start(&p, *state, MIRRORS);
    int of_box = 0, of_sky = 0;
    for (int y = HEIGHT / 2 + 12; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            double way[3], point[3];
            int corners = 0;
            for (int k = 0; k < 4; k++) {
                floor_ray(x + (k & 1 ? 0.9 : 0.1), y + (k & 2 ? 0.9 : 0.1), way, point);
                corners += meets_box(way, point);
            }
            if (corners % 4 != 0)
                continue;
            floor_ray(x + 0.5, y + 0.5, way, point);
            double sky = 0.8 + (0.1 - 0.8) * (1 - exp(4 * way[1]));
            double expected = corners ? 0 : 0.75 * fresnel(-way[1]) * sky;
            of_box += corners != 0;
            of_sky += corners == 0;
            double found = (double)p.colors[4 * (y * WIDTH + x)];
            if (fabs(found - expected) > 1e-3 * expected + 1e-5)
                fail_msg("pixel %d,%d: %g, expected %g", x, y, found, expected);
        }
    }
    assert_true(of_box > 20 && of_sky > 500);
    finish(&p);
}

static const char LIGHT[] =
    START "  sky: {top: 0, horizon: 0}\n"
          "  floor: {color: 0, gloss: 2, roughness: 0.5}\n"
          "  lights: [point: {position: [0.5, 1.5, -3], color: 4, radius: 0.001 m}]\n";

/* Returns the GGX microfacet model of Walter and others (2007) with height-correlated Smith
 * shadowing, times the cosine of the light's angle of incidence. eye, to_light: unit vectors from
 * the surface; a: the roughness squared. */
static double lobe(const double eye[3], const double to_light[3], double a)
{
    double half_way[3], length = 0;
    for (int i = 0; i < 3; i++) {
        half_way[i] = eye[i] + to_light[i];
        length += half_way[i] * half_way[i];
    }
    double nh = half_way[1] / sqrt(length), nv = eye[1], nl = to_light[1];
    double vh = 0;
    for (int i = 0; i < 3; i++)
        vh += eye[i] * half_way[i] / sqrt(length);
    double a2 = a * a, d = nh * nh * (a2 - 1) + 1, pi = acos(-1.0);
    double shadowing = nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2);
    return fresnel(vh) * a2 / (pi * d * d) * nl / (2 * shadowing);
}

static void lights_are_mirrored_by_a_lobe(void **state)
{
    struct picture p;
    start(&p, *state, LIGHT);
    for (int y = HEIGHT / 2 + 2; y < HEIGHT; y += 3) {
        for (int x = 1; x < WIDTH; x += 3) {
            double way[3], point[3], towards[3], d2 = 0;
            floor_ray(x + 0.5, y + 0.5, way, point);
            const double light[3] = {0.5, 1.5, -3};
            for (int i = 0; i < 3; i++)
                d2 += (light[i] - point[i]) * (light[i] - point[i]);
            for (int i = 0; i < 3; i++)
                towards[i] = (light[i] - point[i]) / sqrt(d2);
            const double eye[3] = {-way[0], -way[1], -way[2]};
            double expected = 2 * acos(-1.0) * 4 / d2 * lobe(eye, towards, 0.25);
            double found = (double)p.colors[4 * (y * WIDTH + x)];
            if (fabs(found - expected) > 0.02 * expected + 1e-5)
                fail_msg("pixel %d,%d: %g, expected %g", x, y, found, expected);
        }
    }
    finish(&p);
}

static const char WAVES[] = START "  sky: {top: 0.1, horizon: 0.8}\n"
                                  "  floor: {color: 0, gloss: 1, wave_height: 5 cm}\n";

/* With waves, the reflected sky differs from place to place and changes with time. Without waves it
 * does not change with time. */
static void waves_move(void **state)
{
    struct picture p;
    start(&p, *state, WAVES);
    float before[WIDTH], low = 1, high = 0;
    const float *row = p.colors + 4 * WIDTH * (HEIGHT - 4);
    for (int x = 0; x < WIDTH; x++) {
        before[x] = row[4 * x];
        low = fminf(low, before[x]);
        high = fmaxf(high, before[x]);
    }
    assert_true(low > 0 && high > 1.1f * low);
    draw_at(&p, 30);
    int moved = 0;
    row = p.colors + 4 * WIDTH * (HEIGHT - 4);
    for (int x = 0; x < WIDTH; x++)
        moved += fabsf(row[4 * x] - before[x]) > 0.01f * before[x];
    assert_true(moved > WIDTH / 2);
    finish(&p);

    start(&p, *state, MIRRORS);
    float still = p.colors[4 * (WIDTH * (HEIGHT - 4))];
    draw_at(&p, 30);
    assert_true(p.colors[4 * (WIDTH * (HEIGHT - 4))] == still);
    finish(&p);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(sky_and_objects_are_mirrored),
        test_on_device(lights_are_mirrored_by_a_lobe),
        test_on_device(waves_move),
    };
    return backdrops_run("floor gloss", tests, sizeof tests / sizeof *tests, false, argc, argv);
}
