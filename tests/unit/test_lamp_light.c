/* shared/lamp.h: the irradiance by rectangles against sums over small parts and closed forms, and
 * the light of spots and rectangles on particles. */
#include <math.h>
#include <stdint.h>

#include "shared/billboard_light.h"
#include "shared/lamp.h"
#include "support/cmocka.h"

static const double PI = 3.14159265358979;

/* Returns the next number from 0 to 1 of a sequence. */
static float next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) * 0x1p-24f;
}

static float3 next_unit(uint32_t *seed)
{
    const float z = 2.0f * next(seed) - 1.0f, a = 6.2831853f * next(seed);
    const float r = sqrtf(1.0f - z * z);
    return (float3){r * cosf(a), r * sinf(a), z};
}

static float4 with_w(float3 v, float w)
{
    return (float4){v.x, v.y, v.z, w};
}

/* Returns a rectangle around the origin with a radiance of 1. */
static struct kiln_draw_light rectangle(float3 facing, float3 beside, float width, float height)
{
    const float3 x = {1, 0, 0};
    const float3 right = float3_normalize(float3_cross(facing, beside), x);
    const float radius2 = width * height / (float)PI;
    return (struct kiln_draw_light){
        .position_radius2 = {0, 0, 0, radius2},
        .color = {radius2, radius2, radius2, sqrtf(radius2)},
        .facing = with_w(facing, KILN_LAMP_RECTANGLE),
        .right = with_w(float3_scale(right, 0.5f * width), 0),
        .up = with_w(float3_scale(float3_cross(right, facing), 0.5f * height), 0),
    };
}

/* Returns the irradiance by a rectangle, in which its colour counts, as surfaces get it. */
static double irradiance(const struct kiln_draw_light *lamp, float3 at, float3 normal)
{
    const float3 towards = {-at.x, -at.y, -at.z};
    return (double)(lamp->color.x * lamp_irradiance(*lamp, towards, normal));
}

static double dot_of(float3 a, const double b[3])
{
    return (double)a.x * b[0] + (double)a.y * b[1] + (double)a.z * b[2];
}

/* Returns the irradiance as a sum over small parts of the rectangle. */
static double summed(const struct kiln_draw_light *lamp, float3 at, float3 normal)
{
    enum { PARTS = 400 };
    const float4 r = lamp->right, p = lamp->up, f = lamp->facing;
    const float3 facing = {f.x, f.y, f.z};
    double sum = 0;
    for (int i = 0; i < PARTS * PARTS; i++) {
        const double u = (2 * (i % PARTS) + 1.0) / PARTS - 1;
        const double v = (2 * (i / PARTS) + 1.0) / PARTS - 1;
        const double way[3] = {u * (double)r.x + v * (double)p.x - (double)at.x,
                               u * (double)r.y + v * (double)p.y - (double)at.y,
                               u * (double)r.z + v * (double)p.z - (double)at.z};
        const double d2 = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        const double to = dot_of(normal, way), from = -dot_of(facing, way);
        sum += to > 0 && from > 0 ? to * from / (d2 * d2) : 0;
    }
    return sum * (double)lamp->position_radius2.w * PI / (PARTS * PARTS);
}

/* At 300 places around rectangles of all shapes, half of which are partly below the horizon. */
static void the_irradiance_is_the_sum_over_a_rectangle(void **state)
{
    (void)state;
    uint32_t seed = 1, lit = 0, partly = 0;
    double worst = 0;
    for (int i = 0; i < 300; i++) {
        const float3 facing = next_unit(&seed), normal = next_unit(&seed);
        const struct kiln_draw_light lamp = rectangle(
            facing, next_unit(&seed), 0.1f + 2.0f * next(&seed), 0.1f + 2.0f * next(&seed));
        float3 at = float3_scale(next_unit(&seed), 0.3f + 2.0f * next(&seed));
        const float ahead = float3_dot(at, facing);
        at = float3_add_scaled(at, facing, 0.3f + fabsf(ahead) - ahead);
        const double found = irradiance(&lamp, at, normal), sum = summed(&lamp, at, normal);
        const float middle = -float3_dot(at, normal);
        const float reach =
            fabsf(float3_dot((float3){lamp.right.x, lamp.right.y, lamp.right.z}, normal)) +
            fabsf(float3_dot((float3){lamp.up.x, lamp.up.y, lamp.up.z}, normal));
        lit += sum > 0.01;
        partly += fabsf(middle) < reach;
        worst = fmax(worst, fabs(found - sum));
        if (fabs(found - sum) > 2e-5)
            fail_msg("place %d: irradiance %.7f, expected %.7f", i, found, sum);
    }
    print_message("%u lit, %u partly below the horizon, worst %.1e\n", lit, partly, worst);
    assert_true(lit > 100 && partly > 60);
}

/* The form factor of a rectangle from a point below its centre that faces it, and close below,
 * where the rectangle fills the view. */
static void the_irradiance_in_front_has_a_closed_form(void **state)
{
    (void)state;
    const float3 down = {0, -1, 0}, up = {0, 1, 0}, z = {0, 0, 1};
    for (double d = 1e-3; d < 50; d *= 3) {
        const struct kiln_draw_light lamp = rectangle(down, z, 1.6f, 0.5f);
        const double a = 0.8 / d, b = 0.25 / d, p = sqrt(1 + a * a), q = sqrt(1 + b * b);
        const double expected = 2 * (a / p * atan(b / p) + b / q * atan(a / q));
        const double found = irradiance(&lamp, (float3){0, (float)-d, 0}, up);
        assert_float_equal((float)(found / expected), 1.0f, 3e-5f);
    }
    const struct kiln_draw_light lamp = rectangle(down, z, 1, 1);
    assert_true(irradiance(&lamp, (float3){0, 0.1f, 0}, down) == 0);
    assert_true(irradiance(&lamp, (float3){0, -1, 0}, down) == 0);
}

/* A small rectangle far away gives the light of a point of its colour, times its cosine. */
static void from_afar_a_rectangle_is_a_point(void **state)
{
    (void)state;
    const float3 down = {0, -1, 0}, z = {0, 0, 1}, at = {6, -8, 0};
    const float3 normal = float3_normalize((float3){-0.2f, 1, 0.5f}, z);
    const struct kiln_draw_light lamp = rectangle(down, z, 0.05f, 0.02f);
    struct kiln_draw_light point = lamp;
    point.facing.w = KILN_LAMP_POINT;
    const double ratio = irradiance(&lamp, at, normal) / irradiance(&point, at, normal);
    assert_float_equal((float)ratio, 0.8f, 1e-3f);
}

static float particle_light(struct kiln_draw_light lamp, float3 at)
{
    const struct light_sum none = {.red = {0}};
    const struct light_parts whole = {.all = 1.0f, .straight = 1.0f};
    return light_sum_add_lamp(none, lamp, 1.0f, at, whole).red.all;
}

/* Half of the radiance of a white surface that faces the lamp counts as light from all sides. For a
 * disc, pi r^2 / (d^2 + r^2) is the irradiance in front; a square is nearly one. */
static void particles_get_the_light_of_rectangles(void **state)
{
    (void)state;
    const float3 down = {0, -1, 0}, up = {0, 1, 0}, z = {0, 0, 1};
    const struct kiln_draw_light lamp = rectangle(down, z, 1, 1);
    for (float d = 0.01f; d < 10; d *= 2) {
        const float3 at = {0, -d, 0};
        const float ratio =
            particle_light(lamp, at) / (float)(0.5 / PI * irradiance(&lamp, at, up));
        assert_float_equal(ratio, 1.0f, 0.02f);
    }
    assert_float_equal(particle_light(lamp, (float3){0, 0.5f, 0}), 0.0f, 0.0f);
}

static void particles_get_the_light_of_a_cone(void **state)
{
    (void)state;
    const struct kiln_draw_light point = {.position_radius2 = {0, 0, 0, 0.01f},
                                          .color = {3, 3, 3, 0.1f}};
    struct kiln_draw_light spot = point;
    spot.facing = (float4){0, -1, 0, KILN_LAMP_SPOT};
    spot.right.w = cosf(0.5f);
    spot.up.w = 1.0f / (cosf(0.3f) - cosf(0.5f));
    for (int i = 0; i < 16; i++) {
        const float angle = 0.05f * (float)i;
        const float3 at = {2 * sinf(angle), -2 * cosf(angle), 0};
        const float part = particle_light(spot, at) / particle_light(point, at);
        const float t = (cosf(angle) - cosf(0.5f)) / (cosf(0.3f) - cosf(0.5f));
        const float within = fminf(fmaxf(t, 0), 1);
        assert_float_equal(part, within * within * (3 - 2 * within), 1e-4f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_irradiance_is_the_sum_over_a_rectangle),
        cmocka_unit_test(the_irradiance_in_front_has_a_closed_form),
        cmocka_unit_test(from_afar_a_rectangle_is_a_point),
        cmocka_unit_test(particles_get_the_light_of_rectangles),
        cmocka_unit_test(particles_get_the_light_of_a_cone),
    };
    return cmocka_run_group_tests_name("lamp_light", tests, NULL, NULL);
}
