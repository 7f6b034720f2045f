/* lib/draw/moment/view.c: the camera. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "draw/moment/view.h"
#include "support/cmocka.h"

static struct kiln_scene *scene_of(const char *camera, uint32_t samples)
{
    char text[512];
    int length = snprintf(text, sizeof text,
                          "kiln: 1\noutput: {size: [200, 100], fps: 60, frames: 61, samples: %u}\n"
                          "camera: {%s}\n",
                          samples, camera);
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, (size_t)length, "test", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static struct kiln_view view_of(const char *camera, uint32_t step)
{
    struct kiln_scene *scene = scene_of(camera, 1);
    struct kiln_view view = kiln_view_compute(scene, kiln_instant_at_step(step));
    kiln_scene_destroy(&scene);
    return view;
}

/* A world position in view space. */
static float3 seen(const struct kiln_view *view, float x, float y, float z)
{
    const float4 *m = view->world_to_view;
    return (float3){m[0].x * x + m[0].y * y + m[0].z * z + m[0].w,
                    m[1].x * x + m[1].y * y + m[1].z * z + m[1].w,
                    m[2].x * x + m[2].y * y + m[2].z * z + m[2].w};
}

static void assert_at(float3 p, float x, float y, float z)
{
    if (!(fabsf(p.x - x) < 1e-5f && fabsf(p.y - y) < 1e-5f && fabsf(p.z - z) < 1e-5f))
        fail_msg("at %g, %g, %g; expected %g, %g, %g", (double)p.x, (double)p.y, (double)p.z,
                 (double)x, (double)y, (double)z);
}

static void what_is_ahead_has_negative_z(void **state)
{
    (void)state;
    struct kiln_view view = view_of("position: [0, 1, 5], target: [0, 1, 0], fov: 90 deg", 0);
    assert_at(seen(&view, 0, 1, 0), 0, 0, -5);
    assert_at(seen(&view, 2, 1, 5), 2, 0, 0);
    assert_at(seen(&view, 0, 4, 5), 0, 3, 0);
    assert_true(fabsf(view.frustum.y - 1.0f) < 1e-6f && fabsf(view.frustum.x - 2.0f) < 1e-6f);
    float3 forward = kiln_view_forward(&view);
    assert_at(forward, 0, 0, -1);
}

static void a_roll_turns_the_picture(void **state)
{
    (void)state;
    struct kiln_view view = view_of("position: [0, 0, 5], target: [0, 0, 0], roll: 90 deg", 0);
    float3 right = seen(&view, 1, 0, 0);
    assert_true(fabsf(right.x) < 1e-5f && fabsf(fabsf(right.y) - 1.0f) < 1e-5f);
}

/* Straight down, and where keys lead the eye through its target: finite, and of unit length. */
static void every_direction_is_a_direction(void **state)
{
    (void)state;
    struct kiln_view down = view_of("position: [0, 9, 0], target: [0, 0, 0]", 0);
    assert_at(seen(&down, 0, 0, 0), 0, 0, -9);
    struct kiln_view through =
        view_of("position: {keys: {0 s: [0, 0, 1], 1 s: [0, 0, -1]}}, target: [0, 0, 0]", 30);
    assert_at(seen(&through, 0, 0, -2), 0, 0, -2);
    struct kiln_view after =
        view_of("position: {keys: {0 s: [0, 0, 1], 1 s: [0, 0, -1]}}, target: [0, 0, 0]", 60);
    assert_at(seen(&after, 0, 0, 0), 0, 0, -1);
}

/* ---- lens and pixel -------------------------------------------------------------------------- */

static const char LENS[] = "position: [1, 2, 9], target: [0, 1, 0], fov: 40 deg, roll: 20 deg, "
                           "aperture: 0.2 m, focus: 5 m";

struct point {
    double x, y;
};

/* A point, given right of, above and ahead of the pinhole camera of LENS, where a view shows it, px
 * from the top left. */
static struct point shown(const struct kiln_view *pinhole, const struct kiln_view *view,
                          double right, double up, double ahead)
{
    const float4 *m = pinhole->world_to_view;
    const double place[3] = {right, up, -ahead};
    double world[3] = {(double)pinhole->eye.x, (double)pinhole->eye.y, (double)pinhole->eye.z};
    for (int i = 0; i < 3; i++) {
        world[0] += place[i] * (double)m[i].x;
        world[1] += place[i] * (double)m[i].y;
        world[2] += place[i] * (double)m[i].z;
    }
    const float3 p = seen(view, (float)world[0], (float)world[1], (float)world[2]);
    const double scale = 0.5 * (double)view->frustum.w / (double)view->frustum.y;
    return (struct point){(double)view->principal.x + (double)(p.x / -p.z) * scale,
                          (double)view->principal.y - (double)(p.y / -p.z) * scale};
}

/* The instants of a frame without their places in the pixels. */
static struct kiln_instant lens_instant(const struct kiln_scene *scene, uint32_t moment)
{
    struct kiln_instant instant = kiln_scene_instant(scene, 0, moment);
    instant.pixel_x = instant.pixel_y = 0.0f;
    return instant;
}

/* All points of the lens show a point in the plane of focus in one place. Off the plane, they show
 * it over the circle of confusion of the formula of thin lenses. */
static void a_lens_blurs_what_is_out_of_focus(void **state)
{
    (void)state;
    enum { SAMPLES = 64 };
    struct kiln_scene *scene = scene_of(LENS, SAMPLES);
    const struct kiln_view pinhole = kiln_view_compute(scene, kiln_instant_at_step(0));
    static const double depths[] = {5, 2, 12};
    for (size_t d = 0; d < sizeof depths / sizeof *depths; d++) {
        const double depth = depths[d], right = 0.12 * depth, up = -0.2 * depth;
        const struct point middle = shown(&pinhole, &pinhole, right, up, depth);
        const double pixels_per_m = 50 / tan(20 * 3.14159265358979 / 180) / 5; /* in the plane */
        const double circle = 0.5 * 0.2 * fabs(depth - 5) / depth * pixels_per_m;
        double most = 0, squares = 0;
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const struct kiln_view view = kiln_view_compute(scene, lens_instant(scene, i));
            const struct point at = shown(&pinhole, &view, right, up, depth);
            const double away = hypot(at.x - middle.x, at.y - middle.y);
            most = fmax(most, away);
            squares += away * away / SAMPLES;
        }
        if (fabs(most - circle) > 0.02)
            fail_msg("%g m away: within %g px instead of %g", depth, most, circle);
        if (fabs(squares - 0.5 * circle * circle) > 0.02 * circle * circle + 1e-3)
            fail_msg("%g m away: %g px^2 instead of %g", depth, squares, 0.5 * circle * circle);
    }
    kiln_scene_destroy(&scene);
}

/* Without a distance, the target is in focus. */
static void the_target_is_in_focus(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        scene_of("position: [3, 1, 4], target: [0, 1, 0], aperture: 0.5", 16);
    for (uint32_t i = 0; i < 16; i++) {
        const struct kiln_view view = kiln_view_compute(scene, lens_instant(scene, i));
        const float3 p = seen(&view, 0, 1, 0);
        const double scale = 50 / (double)view.frustum.y;
        assert_true(fabs((double)view.principal.x + (double)(p.x / -p.z) * scale - 100) < 0.01);
        assert_true(fabs((double)view.principal.y - (double)(p.y / -p.z) * scale - 50) < 0.01);
    }
    kiln_scene_destroy(&scene);
}

/* Places in a pixel are spread as the filter is: about the middle, with its variance. The last
 * moment is a pinhole's, and with one sample there is nothing but the middle. */
static void pixels_are_filtered(void **state)
{
    (void)state;
    static const uint32_t counts[] = {4, 16, 100};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        struct kiln_scene *scene = scene_of("fov: 40 deg", counts[c]);
        double x = 0, y = 0, squares = 0, most = 0;
        assert_int_equal(kiln_scene_moment_count(scene), counts[c]);
        for (uint32_t i = 0; i < counts[c]; i++) {
            const struct kiln_instant instant = kiln_scene_instant(scene, 7, i);
            assert_int_equal(instant.step, kiln_scene_frame_step(scene, 7));
            const double px = (double)instant.pixel_x, py = (double)instant.pixel_y;
            x += px / counts[c];
            y += py / counts[c];
            squares += (px * px + py * py) / counts[c];
            most = fmax(most, hypot(px, py));
        }
        const struct kiln_instant last = kiln_scene_instant(scene, 7, counts[c] - 1);
        assert_true(last.lens_x == 0.0f && last.lens_y == 0.0f);
        /* A Gaussian of deviation s, cut at R: 2 s^2 (1 - q / (e^q - 1)) with q = R^2 / (2 s^2). */
        const double q = 1 / (2 * 0.4 * 0.4);
        const double variance = 2 * 0.4 * 0.4 * (1 - q / (exp(q) - 1));
        if (fabs(x) > 1e-6 || fabs(y) > 1e-6 || fabs(squares - variance) > 0.15 * variance ||
            most > 1.1)
            fail_msg("%u places: mean %g, %g; %g px^2 instead of %g; within %g px", counts[c], x, y,
                     squares, variance, most);
        kiln_scene_destroy(&scene);
    }
    struct kiln_scene *scene = scene_of("shutter: {samples: 8}", 1);
    for (uint32_t i = 0; i < 8; i++) {
        const struct kiln_instant instant = kiln_scene_instant(scene, 7, i);
        assert_true(instant.pixel_x == 0.0f && instant.pixel_y == 0.0f);
    }
    kiln_scene_destroy(&scene);
}

/* A place in the picture is of all pixels; a smaller picture has the same ones. */
static void a_coarse_view_has_the_same_axis(void **state)
{
    (void)state;
    struct kiln_scene *scene = scene_of(LENS, 16);
    const struct kiln_view view = kiln_view_compute(scene, kiln_scene_instant(scene, 0, 3));
    const struct kiln_view coarse = kiln_view_coarse(&view, 4);
    assert_true(fabsf(view.principal.x - 100) > 0.5f);
    assert_true(fabsf(4 * coarse.principal.x - view.principal.x) < 1e-4f);
    assert_true(fabsf(4 * coarse.principal.y - view.principal.y) < 1e-4f);
    const float tangent = coarse.principal.z * 0.5f * coarse.frustum.z / coarse.frustum.x;
    assert_true(fabsf(coarse.principal.x - 25 - tangent) < 1e-4f);
    kiln_scene_destroy(&scene);
}

/* A camera in a small node far from the origin, where the ulp of places is as great as the node. */
static void a_camera_looks_along_its_node(void **state)
{
    (void)state;
    static const char *const scales[] = {"1", "0.01", "0.0001", "0.000001", "1000"};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        char camera[256];
        snprintf(camera, sizeof camera,
                 "attach: eye}\nnodes: {eye: {position: [50, 20, 80], rotation: [0, 30 deg, 0], "
                 "scale: %s}",
                 scales[i]);
        const struct kiln_view view = view_of(camera, 0);
        assert_at(kiln_view_forward(&view), 0.5f, 0, sqrtf(0.75f));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_ahead_has_negative_z),
        cmocka_unit_test(a_roll_turns_the_picture),
        cmocka_unit_test(every_direction_is_a_direction),
        cmocka_unit_test(a_camera_looks_along_its_node),
        cmocka_unit_test(a_lens_blurs_what_is_out_of_focus),
        cmocka_unit_test(the_target_is_in_focus),
        cmocka_unit_test(pixels_are_filtered),
        cmocka_unit_test(a_coarse_view_has_the_same_axis),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, NULL);
}
