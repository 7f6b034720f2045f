/* Runs the simulation of a scene step by step, without drawing, hashes its states, and gives tests
 * the particles. */
#include "support/simulation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/state.h"
#include "shared/random.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/pools.h"
#include "support/scenes.h"

void simulation_start_gas(struct simulation *run, const struct kiln_scene *scene,
                          struct kiln_device *device, enum kiln_simulate_technique technique,
                          enum kiln_gas_technique gas, uint32_t threads)
{
    struct kiln_error error = {0};
    *run = (struct simulation){.threads = kiln_threads_create(threads)};
    assert_non_null(run->threads);
    run->simulate = kiln_simulate_create(device, scene, technique, gas, run->threads, &error);
    if (!run->simulate)
        fail_msg("%s", error.message);
    pool_init_of(&run->pool, device, scene);
}

void simulation_start_with(struct simulation *run, const struct kiln_scene *scene,
                           struct kiln_device *device, enum kiln_simulate_technique technique,
                           uint32_t threads)
{
    simulation_start_gas(run, scene, device, technique, KILN_GAS_CPU, threads);
}

void simulation_start(struct simulation *run, const struct kiln_scene *scene,
                      struct kiln_device *device, uint32_t threads)
{
    simulation_start_with(run, scene, device, device ? KILN_SIMULATE_INPLACE : KILN_SIMULATE_CPU,
                          threads);
}

void simulation_run(struct simulation *run, uint32_t steps)
{
    struct kiln_error error = {0};
    for (uint32_t i = 0; i < steps; i++)
        if (!kiln_simulate_step(run->simulate, &run->pool, ++run->step, &error))
            fail_msg("%s", error.message);
}

struct kiln_state_hash simulation_hash(struct simulation *run, uint64_t *alive)
{
    struct kiln_error error = {0};
    struct kiln_state_hash hash;
    if (!kiln_simulate_hash(run->simulate, &run->pool, &hash, alive, &error))
        fail_msg("%s", error.message);
    return hash;
}

struct kiln_state_hash simulation_run_hashed(struct simulation *run, uint32_t steps)
{
    struct kiln_state_hash all = {{0, 0}};
    for (uint32_t step = 0; step < steps; step++) {
        simulation_run(run, 1);
        uint64_t alive;
        struct kiln_state_hash hash = simulation_hash(run, &alive);
        all.lane[0] = random_mix(all.lane[0] + hash.lane[0]);
        all.lane[1] = random_mix(all.lane[1] + hash.lane[1]);
    }
    return all;
}

const struct kiln_particle *simulation_records(struct simulation *run)
{
    struct kiln_error error = {0};
    const struct kiln_particle *records = kiln_buffer_host(&run->pool.records, KILN_READ, &error);
    assert_non_null(records);
    return records;
}

void simulation_end(struct simulation *run)
{
    kiln_pool_finish(&run->pool);
    kiln_simulate_destroy(&run->simulate);
    kiln_threads_destroy(&run->threads);
}

int simulation_device_open(void **state)
{
    test_device_open(state);
    struct kiln_device *device = *state;
    if (!device->info.exact) {
        fputs("skipped: the device does not compute exactly\n", stderr);
        exit(77);
    }
    return 0;
}

struct kiln_scene *simulation_start_text(struct simulation *run, const char *text, uint32_t threads)
{
    struct kiln_scene *scene = load_scene(text, NULL);
    simulation_start(run, scene, NULL, threads);
    return scene;
}

void simulation_end_text(struct simulation *run, struct kiln_scene *scene)
{
    simulation_end(run);
    kiln_scene_destroy(&scene);
}

void simulation_save(struct simulation *run, const char *path)
{
    static const char motion[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
    struct kiln_state state = {.pool = &run->pool};
    struct kiln_error error = {0};
    memcpy(state.info.motion, motion, sizeof state.info.motion);
    state.info.step = run->step;
    state.info.hash = simulation_hash(run, &state.info.alive);
    if (!kiln_state_write(&state, path, true, run->threads, &error))
        fail_msg("%s", error.message);
}

bool simulation_take_up(struct simulation *run, const char *path, struct kiln_error *error)
{
    struct kiln_state state = {.pool = &run->pool};
    if (!kiln_state_read(&state, path, run->threads, error))
        return false;
    run->step = state.info.step;
    return true;
}
