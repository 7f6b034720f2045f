/* lib/draw/moment/view.c: the camera. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "draw/moment/view.h"
#include "support/cmocka.h"

static struct kiln_view view_of(const char *camera, uint32_t step)
{
    char text[512];
    int length = snprintf(text, sizeof text,
                          "kiln: 1\noutput: {size: [200, 100], fps: 60, frames: 61}\n"
                          "camera: {%s}\n",
                          camera);
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, (size_t)length, "test", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
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

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_ahead_has_negative_z),
        cmocka_unit_test(a_roll_turns_the_picture),
        cmocka_unit_test(every_direction_is_a_direction),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, NULL);
}
