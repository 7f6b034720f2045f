/* Checks the headings of particles that have stopped (shaders/shared/heading.h): an arrow in a wall
 * would point elsewhere, or a mesh that never moved would have a direction. */
#include <math.h>

#include "shared/heading.h"
#include "support/cmocka.h"

static void directions_keep_within_a_word(void **state)
{
    (void)state;
    double worst = 0;
    for (uint32_t i = 0; i < 200000; i++) {
        /* a spiral around the sphere meets all of its octants and their borders */
        const double height = 1 - 2 * (double)i / 199999, angle = 2.399963229728653 * i;
        const double radius = sqrt(fmax(1 - height * height, 0));
        const double v[3] = {radius * cos(angle), height, radius * sin(angle)};
        const float3 scaled = {(float)(3.7 * v[0]), (float)(3.7 * v[1]), (float)(3.7 * v[2])};
        const float3 y = heading_unpack(heading_pack(scaled));
        worst = fmax(worst, fabs((double)y.x - v[0]));
        worst = fmax(worst, fabs((double)y.y - v[1]));
        worst = fmax(worst, fabs((double)y.z - v[2]));
    }
    if (!(worst < 6e-5))
        fail_msg("a direction is %g off", worst);
}

static void axes_are_exact(void **state)
{
    (void)state;
    for (int axis = 0; axis < 6; axis++) {
        float v[3] = {0, 0, 0};
        v[axis / 2] = axis % 2 ? -2.0f : 2.0f;
        const float3 y = heading_unpack(heading_pack((float3){v[0], v[1], v[2]}));
        assert_true(y.x == v[0] / 2 && y.y == v[1] / 2 && y.z == v[2] / 2);
    }
}

static void what_never_moved_has_none(void **state)
{
    (void)state;
    assert_int_equal(heading_pack((float3){0, 0, 0}), 0);
    assert_int_equal(heading_pack((float3){1e-35f, 0, 0}), 0);
    const float3 y = heading_unpack(0);
    assert_true(y.x == 0 && y.y == 0 && y.z == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_keep_within_a_word),
        cmocka_unit_test(axes_are_exact),
        cmocka_unit_test(what_never_moved_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
