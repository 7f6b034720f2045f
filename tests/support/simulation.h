/* Runs the simulation of a scene that a test has made. */
#ifndef KILN_TESTS_SIMULATION_H
#define KILN_TESTS_SIMULATION_H

#include "sim/step/simulate.h"

struct simulation {
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool;
    uint32_t step; /* steps done */
};

/* Starts a run with a technique. device: NULL for `cpu`. */
void simulation_start_with(struct simulation *run, const struct kiln_scene *scene,
                           struct kiln_device *device, enum kiln_simulate_technique technique,
                           uint32_t threads);

/* Starts a run with the technique `inplace`, or `cpu` if the device is NULL. */
void simulation_start(struct simulation *run, const struct kiln_scene *scene,
                      struct kiln_device *device, uint32_t threads);

void simulation_run(struct simulation *run, uint32_t steps);
struct kiln_state_hash simulation_hash(struct simulation *run, uint64_t *alive);

/* Runs `steps` steps and returns a hash of the hashes of all their states. */
struct kiln_state_hash simulation_run_hashed(struct simulation *run, uint32_t steps);

const struct kiln_particle *simulation_records(struct simulation *run);
void simulation_end(struct simulation *run);

/* A group set-up that opens the device. It ends the program as skipped if the device does not
 * compute exactly; the test gpu.exact fails if the device should. */
int simulation_device_open(void **state);

#endif
