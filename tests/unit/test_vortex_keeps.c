/* What docs/wind.md says of dust in a vortex: it is kept where speed^2 / (radius * pull) is below
 * `inward`, and flung out to a ring otherwise, and a core may widen with the height. If it failed,
 * the document would be wrong. */
#include <math.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* Returns the mean distance of dust from the axis, m, after it has turned for 30 s. It starts in
 * the core of a vortex of 1 m, whose air turns with 3 m/s. */
static double distance_after(double pull, double inward)
{
    char text[512];
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    snprintf(text, sizeof text,
             "kiln: 1\n"
             "output: {fps: 60, frames: 1900}\n"
             "systems:\n"
             "  dust:\n"
             "    emit: {bursts: {0 s: 200}, life: 40 s, speed: 0,\n"
             "           from: {disc: {direction: [0, 1, 0], radius: 0.8 m}}}\n"
             "    forces: [vortex: {speed: 3, radius: 1 m, pull: %g, inward: %g}]\n",
             pull, inward);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "dust.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 1800);
    const struct kiln_particle *records = simulation_records(&run);
    double sum = 0;
    for (int i = 0; i < 200; i++) {
        const float3 at = particle_position(records[i]);
        sum += hypot((double)at.x, (double)at.z);
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return sum / 200;
}

static void inward_air_keeps_dust_from_a_limit_on(void **state)
{
    (void)state;
    static const double pulls[] = {6, 12, 30};
    for (int i = 0; i < 3; i++) {
        const double limit = 9 / pulls[i]; /* speed^2 / (radius * pull) */
        const double kept = distance_after(pulls[i], 1.2 * limit);
        const double flung = distance_after(pulls[i], 0.8 * limit);
        const double ring = sqrt(limit / (0.8 * limit)); /* in radii */
        print_message("pull %g: %.3f m with 1.2 times the limit, %.3f m with 0.8, a ring at %.3f\n",
                      pulls[i], kept, flung, ring);
        assert_true(kept < 0.2);
        assert_true(fabs(flung - ring) < 0.1 * ring);
    }
}

/* Returns the speed of a particle that has been in a vortex for half a second, at a height of 1.5 m
 * and 0.1 m from the axis. */
static double speed_in_core(const char *radius)
{
    const char *const overrides[] = {radius, NULL};
    struct kiln_scene *scene = load_scene("kiln: 1\n"
                                          "output: {fps: 60, frames: 60}\n"
                                          "systems:\n"
                                          "  a:\n"
                                          "    emit: {bursts: {0 s: 1}, life: 9 s, speed: 0, from: "
                                          "{point: {origin: [0.1, 1.5, 0]}}}\n"
                                          "    forces: [vortex: {speed: 0.1, pull: 5}]\n",
                                          overrides);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 30);
    const float3 v = particle_velocity(simulation_records(&run)[0]);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return hypot((double)v.x, (double)v.z);
}

static void cores_widen_with_the_height(void **state)
{
    (void)state;
    const double there = speed_in_core("systems.a.forces.0.vortex.radius=0.6");
    const double wide = speed_in_core("systems.a.forces.0.vortex.radius=1.2");
    const double widened =
        speed_in_core("systems.a.forces.0.vortex.radius={height: {0 m: 0.2, 3 m: 1}}");
    assert_true(fabs(widened - there) < 1e-6);
    /* the air turns with 0.1 m/s * 0.1 m / radius, and a particle takes up most of that */
    assert_true(fabs(there - 0.1 * 0.1 / 0.6 * (1 - exp(-2.5))) < 5e-4);
    assert_true(there > 1.8 * wide);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inward_air_keeps_dust_from_a_limit_on),
        cmocka_unit_test(cores_widen_with_the_height),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
