/* Checks forces that act in a region alone, against closed forms. If this fails, a force acts
 * outside of its region, or fades there by another curve than the manual says. */
#include <math.h>
#include <string.h>

#include "shared/force_region.h"
#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* Returns 3 t^2 - 2 t^3 of the depth inside of a border. */
static double weight_at(double depth, double falloff)
{
    const double t = fmin(fmax(depth / falloff, 0), 1);
    return t * t * (3 - 2 * t);
}

static void weights_are_the_closed_form(void **state)
{
    (void)state;
    const float4 center = {1, 2, 3, 0.5f}, box = {1, 2, 1.5f, 0}, ball = {1.25f, 0, 0, 0};
    for (int i = 0; i < 4000; i++) {
        const float3 at = {1 + 0.25f * (float)(i % 16 - 8), 2 + 0.3f * (float)(i / 16 % 16 - 8),
                           3 + 0.2f * (float)(i / 256 - 8)};
        const double x = fabs((double)at.x - 1), y = fabs((double)at.y - 2);
        const double z = fabs((double)at.z - 3);
        const double in_box = fmin(1 - x, fmin(2 - y, 1.5 - z));
        const double in_ball = 1.25 - sqrt(x * x + y * y + z * z);
        const double of_box = (double)force_region_weight(at, REGION_BOX, center, box);
        const double of_ball = (double)force_region_weight(at, REGION_SPHERE, center, ball);
        assert_true(fabs(of_box - weight_at(in_box, 0.5)) < 2e-6);
        assert_true(fabs(of_ball - weight_at(in_ball, 0.5)) < 2e-6);
        assert_true(in_box > -1e-6 || of_box == 0);
        assert_true(in_ball > -1e-6 || of_ball == 0);
        assert_true(in_box < 0.500001 || of_box == 1);
    }
}

/* Returns place and velocity of a particle after half a second, which starts at rest at a place
 * along x. */
static struct kiln_particle fly(const char *force, double x, double speed, const char *integration)
{
    char text[512];
    snprintf(
        text, sizeof text,
        "kiln: 1\n"
        "output: {fps: 60, frames: 60}\n"
        "simulation: {integration: %s}\n"
        "systems:\n"
        "  a:\n"
        "    emit: {bursts: {0 s: 1}, life: 9 s, speed: %g, from: {point: {origin: [%g, 0, 0],\n"
        "           direction: [1, 0, 0]}}}\n"
        "    forces: [%s]\n",
        integration, speed, x, force);
    struct kiln_scene *scene = load_scene(text, NULL);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 30);
    const struct kiln_particle p = simulation_records(&run)[0];
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return p;
}

static bool same(struct kiln_particle a, struct kiln_particle b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

#define BALL "region: {sphere: {radius: 2}, falloff: 1 m}"

static void outside_nothing_acts_and_inside_all(void **state)
{
    (void)state;
    static const char *const orders[] = {"semi_implicit", "position_first", "trapezoid", "rk4"};
    for (int i = 0; i < 4; i++) {
        const char *with = "gravity: {acceleration: [0, 0, 1], " BALL "}";
        assert_true(same(fly(with, 3, 1, orders[i]), fly("", 3, 1, orders[i])));
        assert_true(
            same(fly(with, 0.2, 0.2, orders[i]), fly("gravity: [0, 0, 1]", 0.2, 0.2, orders[i])));
        assert_false(same(fly(with, 0.2, 0.2, orders[i]), fly("", 0.2, 0.2, orders[i])));
        with = "drag: {strength: 2, " BALL "}";
        assert_true(same(fly(with, 3, 1, orders[i]), fly("", 3, 1, orders[i])));
        assert_true(same(fly(with, 0.2, 0.2, orders[i]), fly("drag: 2", 0.2, 0.2, orders[i])));
    }
}

/* Across the way of fading, where the weight is one half, half of a force is left. */
static void half_way_half_is_left(void **state)
{
    (void)state;
    const char *with = "gravity: {acceleration: [0, 0, 0.5], region: {box: {size: [4, 4, 100]}, "
                       "falloff: 1 m}}";
    const float3 v = particle_velocity(fly(with, 1.5, 0, "rk4"));
    assert_true(fabs((double)v.z - 0.125) < 1e-6); /* 0.5 / 2 * 0.5 s */
    const struct kiln_particle drag =
        fly("drag: {strength: 2, region: {box: {size: [100, 1, 100]}, falloff: 1 m}}", 0, 3, "rk4");
    const double left = 3 * exp(-2 * 0.5 * 0.5); /* the border is 0.5 m above and below */
    assert_true(fabs((double)particle_velocity(drag).x - left) < 1e-5);
}

/* A region without falloff has a sharp border, which may move. */
static void regions_may_move(void **state)
{
    (void)state;
    const char *with = "gravity: {acceleration: [0, 0, 6], region: {box: {center: {keys: {0 s: "
                       "[0, 0, 0], 0.25 s: [9, 0, 0]}, ease: step}, size: [1, 1, 9]}}}";
    const float3 v = particle_velocity(fly(with, 0, 0, "semi_implicit"));
    assert_true(fabs((double)v.z - 6 * 15 / 60.0) < 1e-5); /* steps before 0.25 s */
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_are_the_closed_form),
        cmocka_unit_test(outside_nothing_acts_and_inside_all),
        cmocka_unit_test(half_way_half_is_left),
        cmocka_unit_test(regions_may_move),
    };
    return cmocka_run_group_tests_name("regions", tests, NULL, NULL);
}
