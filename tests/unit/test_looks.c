/* lib/draw/looks: what a look says over life, sampled. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "draw/moment/look_values.h"
#include "draw/moment/looks.h"
#include "shared/look_layout.h"
#include "support/cmocka.h"
#include "support/scenes.h"

static float4 table[KILN_LOOK_TEXELS];

static float4 texel(uint32_t system, uint32_t row, uint32_t sample)
{
    return table[(system * KILN_LOOK_ROWS + row) * KILN_LOOK_SAMPLES + sample];
}

static void assert_near(float found, double expected)
{
    if (!(fabs((double)found - expected) <= 1e-5))
        fail_msg("%.9g instead of %.9g", (double)found, expected);
}

/* A turn is the rotation of that age, and the spin so far: its mean times the age. */
static void turns_follow_their_curves(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\n"
        "systems:\n"
        "  a: {look: {rotation: {life: [0 rad, 2 rad]}, spin: {life: [0 rad/s, 6 rad/s]}}}\n"
        "  b: {look: {rotation: [1 rad, 2 rad], spin: [3 rad/s, {life: [4 rad/s, 8 rad/s]}]}}\n",
        NULL);
    kiln_looks_sample(scene, 0, table);
    assert_false(kiln_looks_vary(scene));
    for (uint32_t k = 0; k < KILN_LOOK_SAMPLES; k++) {
        double life = k / (double)(KILN_LOOK_SAMPLES - 1);
        assert_near(texel(0, KILN_LOOK_TURN, k).x, 2 * life);
        assert_near(texel(0, KILN_LOOK_SPREAD, k).z, 3 * life); /* 6 life^2 / 2 over life */
        assert_near(texel(0, KILN_LOOK_SPREAD, k).w, 3 * life);
        assert_near(texel(1, KILN_LOOK_TURN, k).x, 1);
        assert_near(texel(1, KILN_LOOK_TURN, k).y, 2);
        assert_near(texel(1, KILN_LOOK_SPREAD, k).z, 3);
        assert_near(texel(1, KILN_LOOK_SPREAD, k).w, 4 + 2 * life);
    }
    kiln_scene_destroy(&scene);
}

static void an_axis_has_any_length_but_0(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene("kiln: 1\n"
                                          "systems:\n"
                                          "  a: {look: {axis: [3e-30, 0, 4e-30]}}\n"
                                          "  b: {look: {axis: [0, 0, -1e5]}}\n"
                                          "  c: {look: {facing: {normal: [0, 3, -4]},\n"
                                          "             width: {life: [1, 3]}, height: 0.5}}\n",
                                          NULL);
    kiln_looks_sample(scene, 0, table);
    assert_near(texel(0, KILN_LOOK_AXIS, 5).x, 0.6);
    assert_near(texel(0, KILN_LOOK_AXIS, 5).y, 0);
    assert_near(texel(0, KILN_LOOK_AXIS, 5).z, 0.8);
    assert_near(texel(1, KILN_LOOK_AXIS, 5).z, -1);
    assert_near(texel(2, KILN_LOOK_AXIS, 5).y, 0.6);
    assert_near(texel(2, KILN_LOOK_AXIS, 5).z, -0.8);
    assert_near(texel(2, KILN_LOOK_FORM, KILN_LOOK_SAMPLES - 1).x, 3);
    assert_near(texel(2, KILN_LOOK_FORM, KILN_LOOK_SAMPLES - 1).y, 0.5);
    kiln_scene_destroy(&scene);
}

/* The row of a particle's look, from the table and the values over other clocks. */
static float4 row_of(const struct kiln_look_program *program, const float4 *rows,
                     const struct value_clocks *clocks, uint32_t row)
{
    const float x = clocks->life * (float)(KILN_LOOK_SAMPLES - 1);
    const uint32_t k = (uint32_t)x < KILN_LOOK_SAMPLES - 2 ? (uint32_t)x : KILN_LOOK_SAMPLES - 2;
    const float4 a = rows[row * KILN_LOOK_SAMPLES + k], b = rows[row * KILN_LOOK_SAMPLES + k + 1];
    const float t = x - (float)k;
    const float4 look = {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                         a.w + (b.w - a.w) * t};
    return kiln_look_multiply(rows, program, row, clocks, look);
}

static void assert_about(const char *what, float found, float expected)
{
    if (!(fabsf(found - expected) <= 0.004f * fmaxf(1.0f, fabsf(expected))))
        fail_msg("%s is %.9g instead of %.9g", what, (double)found, (double)expected);
}

static const char OF_EVERY_CLOCK[] =
    "kiln: 1\n"
    "systems:\n"
    "  plain: {look: {size: {life: [1, 2]}}}\n"
    "  smoke:\n"
    "    look:\n"
    "      fade: {in: 0, out: 0}\n"
    "      size: {life: [1, 2], times: {random: [0.5, 2]}, plus: {age: {0 s: 0, 2 s: 1}}}\n"
    "      stretch: {random: {0: 0, 0.5: 1, 1: 2}, ease: smooth}\n"
    "      opacity: {speed: {0: 0, 8 m/s: 1}}\n"
    "      soft: {distance: {2 m: 1, 20 m: 3}}\n"
    "      color: {choose: [[0.1, 0.2, 0.3], [0.5, 0.6, 0.7], [0.9, 0.8, 0.1]],\n"
    "              weights: [5, 1, 2], times: {height: {0 m: 1, 4 m: 0.5}}}\n"
    "      lit: {noise: [0, 1], period: 0.2 s}\n"
    "      bloom: [{random: [0, 1]}, 0.25, {age: {0 s: 0, 1 s: 1}, repeat: mirror}]\n"
    "      thickness: {age: {0 s: 0, 0.7 s: 2}, repeat: loop}\n"
    "      scale: {choose: [1, 3]}\n"
    "      rotation: {random: [0 rad, 3 rad]}\n"
    "      spin: {life: [0 rad/s, 6 rad/s], times: {random: [1, 2]}}\n"
    "      intensity: {random: [1, 9]}\n"
    "      cycles: {random: [1, 2]}\n";

/* Compares rows of a look with the values of the scene. */
static void compare_rows(const float4 r[KILN_LOOK_ROWS], const struct kiln_scene *scene,
                         const struct value_clocks *clocks)
{
    const struct kiln_look *look = &scene->systems[1].look;
    const struct value_clocks c = *clocks;
    const struct {
        const char *name;
        float found;
        const struct kiln_value *value;
    } rows[] = {
        {"size", r[KILN_LOOK_SHAPE].x, &look->size},
        {"stretch", r[KILN_LOOK_SHAPE].y, &look->stretch},
        {"opacity", r[KILN_LOOK_SHAPE].z, &look->opacity},
        {"soft", r[KILN_LOOK_SHAPE].w, &look->soft},
        {"red", r[KILN_LOOK_COVER].x, &look->color.x},
        {"green", r[KILN_LOOK_COVER].y, &look->color.y},
        {"blue", r[KILN_LOOK_COVER].z, &look->color.z},
        {"lit", r[KILN_LOOK_COVER].w, &look->lit},
        {"bloom's red", r[KILN_LOOK_BLOOM].x, &look->bloom.x},
        {"bloom's green", r[KILN_LOOK_BLOOM].y, &look->bloom.y},
        {"bloom's blue", r[KILN_LOOK_BLOOM].z, &look->bloom.z},
        {"least scale", r[KILN_LOOK_SPREAD].x, &look->scale.min},
        {"most scale", r[KILN_LOOK_SPREAD].y, &look->scale.max},
        {"rotation", r[KILN_LOOK_TURN].x, &look->rotation.min},
        {"cycles", r[KILN_LOOK_COOL].w, &look->cycles},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_about(rows[i].name, rows[i].found, value_at(scene->keys, *rows[i].value, c));
    if (c.life > 0.0f)
        assert_about("spin", r[KILN_LOOK_SPREAD].z,
                     value_sum_at(scene->keys, look->spin.min, c, c.life) / c.life);
}

/* Whatever clock a value of a look has, a particle is drawn with the value that the scene says. */
static void values_over_other_clocks_multiply(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(OF_EVERY_CLOCK, NULL);
    static struct kiln_look_program programs[KILN_MAX_SYSTEMS];
    const uint32_t rows = kiln_look_rows(scene);
    float4 *all = calloc((size_t)rows * KILN_LOOK_SAMPLES, sizeof *all);
    assert_non_null(all);
    assert_true(rows > 2 * KILN_LOOK_ROWS);
    kiln_look_programs_fill(scene, programs);
    assert_int_equal(programs[0].count, 0);
    const float time_s = 1.3f;
    kiln_looks_sample(scene, time_s, all);
    kiln_look_programs_sample(scene, programs, time_s, all);
    const float4 *own = all + (size_t)KILN_LOOK_ROWS * KILN_LOOK_SAMPLES;
    const uint32_t key = random_system_key(scene->seed, 1);
    for (uint32_t serial = 0; serial < 400; serial++) {
        struct value_clocks c = kiln_scene_clocks(scene, 1, time_s);
        c.life = (float)serial / 400.0f;
        c.age_s = (float)(serial % 37) * 0.1f;
        c.height = (float)(serial % 11) - 3.0f;
        c.distance = (float)(serial % 29);
        c.velocity = (float3){(float)(serial % 7), 1.0f, 2.0f};
        c.stream = random_stream(key, serial);
        float4 r[KILN_LOOK_ROWS];
        for (uint32_t row = 0; row < KILN_LOOK_ROWS; row++) {
            const float4 over_life = row_of(&programs[0], own, &c, row);
            r[row] = kiln_look_multiply(all, &programs[1], row, &c, over_life);
        }
        compare_rows(r, scene, &c);
    }
    free(all);
    kiln_scene_destroy(&scene);
}

/* The light of a temperature that is random is that of a system with this temperature. */
static void random_temperatures_have_their_light(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load_scene("kiln: 1\n"
                   "systems:\n"
                   "  fire: {look: {blend: add, temperature: {random: [1000 K, 3000 K]}, color: "
                   "[1, 0.5, 0]}}\n"
                   "  same: {look: {blend: add, temperature: 2000 K, color: [1, 0.5, 0]}}\n",
                   NULL);
    static struct kiln_look_program programs[KILN_MAX_SYSTEMS];
    float4 *all = calloc((size_t)kiln_look_rows(scene) * KILN_LOOK_SAMPLES, sizeof *all);
    assert_non_null(all);
    kiln_look_programs_fill(scene, programs);
    kiln_looks_sample(scene, 0, all);
    kiln_look_programs_sample(scene, programs, 0, all);
    const float4 *same = all + (size_t)KILN_LOOK_ROWS * KILN_LOOK_SAMPLES;
    uint32_t found = 0;
    for (uint32_t serial = 0; serial < 20000; serial++) {
        struct value_clocks c = kiln_scene_clocks(scene, 0, 0);
        c.stream = random_stream(c.system, serial);
        const float kelvin = value_at(scene->keys, scene->systems[0].look.temperature, c);
        if (fabsf(kelvin - 2000.0f) > 2.0f)
            continue;
        found++;
        for (uint32_t row = KILN_LOOK_HOT; row <= KILN_LOOK_COOL; row++) {
            const float4 a = row_of(&programs[0], all, &c, row);
            const float4 b = same[row * KILN_LOOK_SAMPLES];
            assert_true(fabsf(a.x - b.x) < 0.02f * b.x && fabsf(a.y - b.y) < 0.02f * b.y + 1e-6f);
        }
    }
    assert_true(found > 10);
    free(all);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_follow_their_curves),
        cmocka_unit_test(an_axis_has_any_length_but_0),
        cmocka_unit_test(values_over_other_clocks_multiply),
        cmocka_unit_test(random_temperatures_have_their_light),
    };
    return cmocka_run_group_tests_name("looks", tests, NULL, NULL);
}
