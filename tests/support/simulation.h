/* A run of a fixture scene. */
#ifndef KILN_TESTS_SIMULATION_H
#define KILN_TESTS_SIMULATION_H

#include "sim/step/simulate.h"

struct simulation {
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool;
    uint32_t step; /* steps done */
};

/* device: NULL for `cpu`. */
void simulation_start_with(struct simulation *run, const struct kiln_scene *scene,
                           struct kiln_device *device, enum kiln_simulate_technique technique,
                           uint32_t threads);

/* `inplace` on the device, or `cpu` where it is NULL. */
void simulation_start(struct simulation *run, const struct kiln_scene *scene,
                      struct kiln_device *device, uint32_t threads);

void simulation_run(struct simulation *run, uint32_t steps);
struct kiln_state_hash simulation_hash(struct simulation *run, uint64_t *alive);

/* Runs so many steps and mixes the hashes of all their states. */
struct kiln_state_hash simulation_run_hashed(struct simulation *run, uint32_t steps);

const struct kiln_particle *simulation_records(struct simulation *run);
void simulation_end(struct simulation *run);

/* A group set-up: the device, if it may simulate; gpu.exact says whether one should. */
int simulation_device_open(void **state);

#endif
