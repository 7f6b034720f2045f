/* Animated values and units: what a scene writes is, to the bit, what a run reads. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/scenes.h"

/* A scene with `text` as the roll of its camera, an angle over time. */
static struct kiln_scene *roll_scene(const char *text)
{
    char scene[512];
    snprintf(scene, sizeof scene, "kiln: 1\ncamera: {roll: %s}\n", text);
    return load_scene(scene, NULL);
}

/* A scene with `text` as the size of a system's particles, a length over time or life. */
static struct kiln_scene *size_scene(const char *text)
{
    char scene[512];
    snprintf(scene, sizeof scene, "kiln: 1\nsystems: {a: {look: {size: %s}}}\n", text);
    return load_scene(scene, NULL);
}

/* The clocks of a particle at a time, and at a part of its life. */
static struct value_clocks clocks_at(float time_s, float life)
{
    struct value_clocks clocks = value_clocks_at(time_s, 0, 0);
    clocks.life = life;
    return clocks;
}

static void units_convert_to_si(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        float si;
    } sizes[] = {
        {"2", 2},         {"2 m", 2},        {"2m", 2},        {"250 mm", 0.25f}, {"5 cm", 0.05f},
        {"1e-1", 0.1f},   {"+.5", 0.5f},     {"5.", 5},        {"\"3 m\"", 3},    {"0.1", 0.1f},
        {"1e-31", 0},     {"1e-60", 0},      {"-0", 0},        {"7e-31 m", 0},    {"8e-31", 8e-31f},
        {"33 cm", 0.33f}, {"1000", 1000.0f}, {"1 mm", 0.001f},
    };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct kiln_scene *scene = size_scene(sizes[i].text);
        float found = scene->systems[0].look.size.constant;
        assert_int_equal(FLOAT_BITS(found), FLOAT_BITS(sizes[i].si));
        kiln_scene_destroy(&scene);
    }
    static const struct {
        const char *text;
        double radians;
    } angles[] = {
        {"0", 0},
        {"180 deg", 3.14159265358979323846},
        {"-90 deg", -1.57079632679489661923},
        {"1.2 rad", 1.2},
        {"3600 deg", 62.8318530717958647693},
    };
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        struct kiln_scene *scene = roll_scene(angles[i].text);
        assert_true(scene->camera.roll.constant == (float)angles[i].radians);
        kiln_scene_destroy(&scene);
    }
}

/* What is printed with a unit is what is read again: angles are the hard case. */
static void angles_survive_printing(void **state)
{
    (void)state;
    uint32_t bits = 12345;
    for (int i = 0; i < 200; i++) {
        bits = bits * 1664525u + 1013904223u;
        float radians = (float)(bits >> 8) * 0x1p-20f - 8.0f;
        char text[64];
        snprintf(text, sizeof text, "%.9g rad", (double)radians);
        struct kiln_scene *scene = roll_scene(text);
        char *printed = print_scene(scene);
        struct kiln_scene *again = load_scene(printed, NULL);
        assert_true(scene->camera.roll.constant == radians);
        assert_true(again->camera.roll.constant == radians);
        free(printed);
        kiln_scene_destroy(&scene);
        kiln_scene_destroy(&again);
    }
}

static void keys_are_joined_and_held(void **state)
{
    (void)state;
    struct kiln_scene *scene = size_scene("{keys: {1 s: 2, 3 s: 6, 3500 ms: 6, 4 s: 0}}");
    const struct kiln_value *size = &scene->systems[0].look.size;
    assert_int_equal(VALUE_CLOCK(size->how), KILN_CLOCK_TIME);
    assert_int_equal(size->count, 4);
    static const float expected[][2] = {{-5, 2},    {1, 2},    {1.5f, 3},  {2, 4}, {3, 6},
                                        {3.25f, 6}, {3.5f, 6}, {3.75f, 3}, {4, 0}, {9, 0}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_true(kiln_scene_value(scene, size, expected[i][0]) == expected[i][1]);
    assert_true(kiln_scene_value_max(scene, size) == 6);
    /* The slopes of the table: divided once, on the host. */
    const float4 *keys = scene->keys + size->first;
    assert_true(keys[0].z == 2 && keys[1].z == 0 && keys[2].z == -12 && keys[3].z == 0);
    kiln_scene_destroy(&scene);
}

static void curves_span_the_life(void **state)
{
    (void)state;
    static const char *const same[] = {
        "{life: [0, 2, 1]}",
        "{life: {0: 0, 0.5: 2, 1: 1}}",
        "{life: {0: 0, 50 %: 200 cm, 100%: 1 m}}",
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        struct kiln_scene *scene = size_scene(same[i]);
        const struct kiln_value *size = &scene->systems[0].look.size;
        assert_int_equal(VALUE_CLOCK(size->how), KILN_CLOCK_LIFE);
        static const float expected[][2] = {{0, 0},        {0.25f, 1}, {0.5f, 2},
                                            {0.75f, 1.5f}, {1, 1},     {2, 1}};
        for (size_t j = 0; j < sizeof expected / sizeof *expected; j++)
            assert_true(value_at(scene->keys, *size, clocks_at(77, expected[j][0])) ==
                        expected[j][1]);
        kiln_scene_destroy(&scene);
    }
    struct kiln_scene *single = size_scene("{life: [3]}");
    assert_true(value_at(single->keys, single->systems[0].look.size, clocks_at(0, 0.5f)) == 3);
    kiln_scene_destroy(&single);
}

/* A slope is IEEE's quotient of IEEE's differences, in float. */
static void slopes_round_once(void **state)
{
    (void)state;
    struct kiln_scene *scene = size_scene("{keys: {0.1: 0.3, 0.7: 0.9, 0.8: 0.1}}");
    const float4 *keys = scene->keys + scene->systems[0].look.size.first;
    volatile float x[3] = {0.1f, 0.7f, 0.8f}, y[3] = {0.3f, 0.9f, 0.1f};
    for (int i = 0; i < 2; i++) {
        volatile float dy = y[i + 1] - y[i], dx = x[i + 1] - x[i];
        volatile float slope = dy / dx;
        assert_true(keys[i].x == x[i] && keys[i].y == y[i] && keys[i].z == slope);
    }
    kiln_scene_destroy(&scene);
}

static void vectors_vary_whole_or_in_parts(void **state)
{
    (void)state;
    static const char *const same[] = {
        "{keys: {0 s: [0, 1, 10], 2 s: [2, 1, 30]}}",
        "[{keys: {0 s: 0, 2 s: 2}}, {keys: {0 s: 1, 2 s: 1}}, {keys: {0 s: 10, 2 s: 30}}]",
        "[{keys: {0 s: 0, 2 s: 2}}, 1, {keys: {0 s: 10, 1 s: 20, 2 s: 30}}]",
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        char text[256];
        snprintf(text, sizeof text, "kiln: 1\ncamera: {position: %s}\n", same[i]);
        struct kiln_scene *scene = load_scene(text, NULL);
        float3 v = kiln_scene_value3(scene, &scene->camera.position, 1);
        assert_true(v.x == 1 && v.y == 1 && v.z == 20);
        kiln_scene_destroy(&scene);
    }
}

static void colors_may_be_grey(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\nsystems: {a: {look: {color: 0.5, bloom: {life: [1, [0, 1, 0]]}}}}\n", NULL);
    const struct kiln_look *look = &scene->systems[0].look;
    assert_true(look->color.x.constant == 0.5f && look->color.z.constant == 0.5f);
    assert_true(value_at(scene->keys, look->bloom.x, clocks_at(0, 0.5f)) == 0.5f);
    assert_true(value_at(scene->keys, look->bloom.y, clocks_at(0, 0.5f)) == 1);
    kiln_scene_destroy(&scene);
}

/* Frame f is at f / fps, whatever the rate and the warm-up are. */
static void clip_time_is_exact(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "kiln: 1\noutput: {fps: 30, frames: 100000}\nsimulation: {warmup: 2 s}\n",
        "kiln: 1\noutput: {fps: 30000/1001, frames: 100000}\n",
        "kiln: 1\noutput: {fps: 24, frames: 100000}\nsimulation: {rate: 240, warmup: 0.1 s}\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct kiln_scene *scene = load_scene(texts[i], NULL);
        for (uint32_t frame = 0; frame < scene->frames; frame += 997) {
            double time_s = (double)frame * scene->fps.den / scene->fps.num;
            uint32_t step = kiln_scene_frame_step(scene, frame);
            assert_true(kiln_scene_time(scene, step) == (float)time_s);
        }
        assert_true(kiln_scene_time(scene, scene->warmup_steps) == 0);
        float start = kiln_scene_time(scene, 0);
        assert_true(fabsf(start + (float)scene->warmup_s) <= scene->dt_s);
        kiln_scene_destroy(&scene);
    }
}

/* The sum of a curve against the trapezoids that it consists of, held outside of its keys; and it
 * never falls, not by a bit. */
static void sums_are_the_areas(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\nsystems: {a: {look: {opacity: {life: {0.1: 0.4, 0.3: 1, 0.5: 0, 0.8: 0.002}},\n"
        "  size: 3}}}\n",
        NULL);
    const struct kiln_look *look = &scene->systems[0].look;
    const struct kiln_value *curve = &look->opacity;
    const struct value_clocks none = clocks_at(0, 0);
    static const double sums[][2] = {{0, 0},       {0.1, 0.04}, {0.2, 0.095},  {0.3, 0.18},
                                     {0.4, 0.255}, {0.5, 0.28}, {0.8, 0.2803}, {1, 0.2807}};
    for (size_t i = 0; i < sizeof sums / sizeof *sums; i++) {
        double sum = (double)value_sum_at(scene->keys, *curve, none, (float)sums[i][0]);
        if (!(fabs(sum - sums[i][1]) < 1e-6))
            fail_msg("%g up to %g, not %g", sum, sums[i][0], sums[i][1]);
    }
    float before = 0;
    for (uint32_t i = 0; i <= 1 << 20; i++) {
        float sum = value_sum_at(scene->keys, *curve, none, (float)i * 0x1p-20f);
        assert_true(sum >= before);
        before = sum;
    }
    assert_true(value_sum_at(scene->keys, look->size, none, 0.5f) == 1.5f);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_convert_to_si),
        cmocka_unit_test(angles_survive_printing),
        cmocka_unit_test(keys_are_joined_and_held),
        cmocka_unit_test(curves_span_the_life),
        cmocka_unit_test(slopes_round_once),
        cmocka_unit_test(vectors_vary_whole_or_in_parts),
        cmocka_unit_test(colors_may_be_grey),
        cmocka_unit_test(clip_time_is_exact),
        cmocka_unit_test(sums_are_the_areas),
    };
    return cmocka_run_group_tests_name("value", tests, NULL, NULL);
}
