/* lib/draw/looks: what a look says over life, sampled. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

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
                                          "  b: {look: {axis: [0, 0, -1e5]}}\n",
                                          NULL);
    kiln_looks_sample(scene, 0, table);
    assert_near(texel(0, KILN_LOOK_AXIS, 5).x, 0.6);
    assert_near(texel(0, KILN_LOOK_AXIS, 5).y, 0);
    assert_near(texel(0, KILN_LOOK_AXIS, 5).z, 0.8);
    assert_near(texel(1, KILN_LOOK_AXIS, 5).z, -1);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_follow_their_curves),
        cmocka_unit_test(an_axis_has_any_length_but_0),
    };
    return cmocka_run_group_tests_name("looks", tests, NULL, NULL);
}
