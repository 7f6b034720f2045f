/* Techniques `cpu` and `inplace` give the same state, with everything in the scene. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>

#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

enum { STEPS = 300 };

/* Steps the scene both ways and compares after each step. */
static void both_agree(struct kiln_device *device, const struct kiln_scene *scene, uint32_t threads,
                       uint32_t steps)
{
    struct simulation cpu, inplace;
    simulation_start(&cpu, scene, NULL, threads);
    simulation_start(&inplace, scene, device, 1);
    uint64_t most = 0;
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&cpu, 1);
        simulation_run(&inplace, 1);
        uint64_t cpu_alive, inplace_alive;
        struct kiln_state_hash a = simulation_hash(&cpu, &cpu_alive);
        struct kiln_state_hash b = simulation_hash(&inplace, &inplace_alive);
        if (cpu_alive != inplace_alive || a.lane[0] != b.lane[0] || a.lane[1] != b.lane[1])
            fail_msg("step %u: %08x%08x of %u on cpu, %08x%08x of %u inplace", step, a.lane[0],
                     a.lane[1], (unsigned)cpu_alive, b.lane[0], b.lane[1], (unsigned)inplace_alive);
        most = cpu_alive > most ? cpu_alive : most;
    }
    assert_true(most > 1000);
    assert_memory_equal(simulation_records(&cpu), simulation_records(&inplace),
                        cpu.pool.slot_count * sizeof(struct kiln_particle));
    simulation_end(&cpu);
    simulation_end(&inplace);
}

static void cpu_and_inplace_agree(struct kiln_device *device, enum kiln_integration order,
                                  uint32_t threads)
{
    fixture_zoo(&fixture, order, STEPS);
    both_agree(device, &fixture.scene, threads, STEPS);
}

static void one_thread(void **state)
{
    cpu_and_inplace_agree(*state, KILN_INTEGRATE_SEMI_IMPLICIT, 1);
}

static void two_threads(void **state)
{
    cpu_and_inplace_agree(*state, KILN_INTEGRATE_SEMI_IMPLICIT, 2);
}

static void eight_threads(void **state)
{
    cpu_and_inplace_agree(*state, KILN_INTEGRATE_SEMI_IMPLICIT, 8);
}

static void position_first(void **state)
{
    cpu_and_inplace_agree(*state, KILN_INTEGRATE_POSITION_FIRST, 2);
}

static void round_colliders(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    fixture_add_round(&fixture);
    both_agree(*state, &fixture.scene, 2, STEPS);
}

static void families_agree(void **state)
{
    for (int order = 0; order < 2; order++) {
        fixture_family(&fixture, (enum kiln_integration)order);
        fixture_finish(&fixture, 200);
        both_agree(*state, &fixture.scene, 2, 200);
    }
}

/* The front-page scene as the loader makes it, with a tenth of its particles. */
static void a_scene_from_a_file(void **state)
{
    struct kiln_error error = {0};
    const char *const overrides[] = {"systems.*.emit.rate=2000"};
    struct kiln_scene_params params = KILN_SCENE_DEFAULTS;
    params.overrides = overrides;
    params.override_count = 1;
    struct kiln_scene *scene =
        kiln_scene_load(KILN_SOURCE_DIR "/scenes/fire_beam.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    both_agree(*state, scene, 2, 120);
    kiln_scene_destroy(&scene);
}

/* A run may change its technique half-way: the records move, the state goes on. */
static void a_run_can_change_its_technique(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 120);
    struct simulation cpu, inplace;
    simulation_start(&cpu, &fixture.scene, NULL, 1);
    simulation_run(&cpu, 120);
    simulation_start(&inplace, &fixture.scene, *state, 1);
    simulation_run(&inplace, 50);
    struct kiln_error error = {0};
    struct kiln_simulate *other =
        kiln_simulate_create(NULL, &fixture.scene, KILN_SIMULATE_CPU, inplace.threads, &error);
    assert_non_null(other);
    for (uint32_t step = 51; step <= 90; step++)
        assert_true(kiln_simulate_step(other, &inplace.pool, step, &error));
    inplace.step = 90;
    simulation_run(&inplace, 30);
    assert_memory_equal(simulation_records(&cpu), simulation_records(&inplace),
                        cpu.pool.slot_count * sizeof(struct kiln_particle));
    kiln_simulate_destroy(&other);
    simulation_end(&cpu);
    simulation_end(&inplace);
}

static void inplace_needs_an_exact_device(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    fixture_init(&fixture);
    assert_null(kiln_simulate_create(NULL, &fixture.scene, KILN_SIMULATE_INPLACE, NULL, &error));
    assert_int_equal(error.code, KILN_USAGE);
    bool exact = device->info.exact;
    device->info.exact = false;
    assert_null(kiln_simulate_create(device, &fixture.scene, KILN_SIMULATE_INPLACE, NULL, &error));
    assert_int_equal(error.code, KILN_USAGE);
    device->info.exact = exact;
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(one_thread),
        test_on_device(two_threads),
        test_on_device(eight_threads),
        test_on_device(position_first),
        test_on_device(round_colliders),
        test_on_device(families_agree),
        test_on_device(a_scene_from_a_file),
        test_on_device(a_run_can_change_its_technique),
        test_on_device(inplace_needs_an_exact_device),
    };
    return cmocka_run_group_tests_name("simulate", tests, simulation_device_open,
                                       test_device_close);
}
