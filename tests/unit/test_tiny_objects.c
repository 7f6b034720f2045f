/* Objects of a hundredth of a millimetre, the smallest that a scene may have: particles bounce off
 * them and stay outside. If it failed, particles would fly through them, or be put several of their
 * sizes away. */
#include <math.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/simulation.h"

/* Half of the height of each object, m. */
static const double HALF = 1e-5;

/* Particles fall straight onto an object from 0.05 mm above its middle, at 1 mm/s. */
static struct kiln_scene *load(const char *object)
{
    char text[1024];
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    snprintf(text, sizeof text,
             "kiln: 1\n"
             "simulation: {rate: 960}\n"
             "backdrop: {floor: none, objects: [%s]}\n"
             "systems:\n"
             "  grit:\n"
             "    emit: {rate: 960, life: 1 s, speed: 0.001,\n"
             "           from: {point: {origin: [0.000001, 0.00005, 0.000001],\n"
             "                          direction: [0, -1, 0], angle: 0}}}\n"
             "    collide: {slowdown: 1}\n",
             object);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "tiny.yaml", &params, &error);
    if (!scene)
        fail_msg("%s: %s", object, error.message);
    return scene;
}

static void particles_bounce_off_tiny_objects(void **state)
{
    (void)state;
    static const char *const objects[] = {
        "box: {center: [0, 0, 0], size: [0.00002, 0.00002, 0.00002]}",
        "box: {center: [0, 0, 0], size: [0.00002, 0.00002, 0.00002], rotation: [0, 30 deg, 0]}",
        "sphere: {center: [0, 0, 0], radius: 0.01 mm}",
        "cylinder: {center: [0, 0, 0], radius: 0.01 mm, height: 0.02 mm}",
        "capsule: {center: [0, -0.00001, 0], radius: 0.01 mm, height: 0.02 mm}",
    };
    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++) {
        struct kiln_scene *scene = load(objects[i]);
        struct simulation run;
        simulation_start(&run, scene, NULL, 1);
        double nearest = 1, returned = 0;
        for (int step = 0; step < 120; step++) {
            simulation_run(&run, 1);
            const struct kiln_particle *records = simulation_records(&run);
            for (uint32_t k = 0; k < run.pool.systems[0].next_serial; k++) {
                const float3 at = particle_position(records[k]);
                const double above = (double)at.y - HALF;
                const float3 velocity = particle_velocity(records[k]);
                nearest = fmin(nearest, above);
                returned += velocity.y > 0.0f ? 1 : 0;
            }
        }
        print_message("%s: within %.2g m\n", objects[i], nearest);
        /* A sphere is a little lower where the particles meet it. */
        assert_true(nearest > -1e-7 && nearest < 2e-6);
        assert_true(returned > 1000);
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(particles_bounce_off_tiny_objects)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
