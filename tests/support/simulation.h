/* Runs the simulation of a scene step by step, without drawing, so that tests can check particles
 * and state hashes after each step. */
#ifndef KILN_TESTS_SIMULATION_H
#define KILN_TESTS_SIMULATION_H

#include "sim/step/simulate.h"

struct simulation {
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool;
    uint32_t step; /* steps done */
};

/* Starts a run at step 0. device: NULL for the technique `cpu`; threads: number of worker threads.
 * The scene must outlive the run, which the caller ends with simulation_end. */
void simulation_start_with(struct simulation *run, const struct kiln_scene *scene,
                           struct kiln_device *device, enum kiln_simulate_technique technique,
                           uint32_t threads);

/* Starts a run whose gas has a technique of its own, too. */
void simulation_start_gas(struct simulation *run, const struct kiln_scene *scene,
                          struct kiln_device *device, enum kiln_simulate_technique technique,
                          enum kiln_gas_technique gas, uint32_t threads);

/* Starts a run with the technique `inplace` on a device, or `cpu` if the device is NULL. */
void simulation_start(struct simulation *run, const struct kiln_scene *scene,
                      struct kiln_device *device, uint32_t threads);

/* Runs `steps` more steps. */
void simulation_run(struct simulation *run, uint32_t steps);

/* Returns the hash of the state after the last step, and sets *alive to the number of living
 * particles. */
struct kiln_state_hash simulation_hash(struct simulation *run, uint64_t *alive);

/* Runs `steps` more steps, and returns a hash of the state hashes after each of them. */
struct kiln_state_hash simulation_run_hashed(struct simulation *run, uint32_t steps);

/* Returns the particle records of all slots, in host memory, valid until the next step. */
const struct kiln_particle *simulation_records(struct simulation *run);
void simulation_end(struct simulation *run);

/* Starts a run of the scene of a text with the technique `cpu`, and returns the scene;
 * simulation_end_text ends the run and destroys the scene. */
struct kiln_scene *simulation_start_text(struct simulation *run, const char *text,
                                         uint32_t threads);
void simulation_end_text(struct simulation *run, struct kiln_scene *scene);

/* Saves the state after the last step in a file. A failure fails the test. */
void simulation_save(struct simulation *run, const char *path);

/* Lets a run go on from the state in a file, of a run of the same scene. Returns false with an
 * error if the file cannot be read. */
bool simulation_take_up(struct simulation *run, const char *path, struct kiln_error *error);

/* A group set-up for cmocka that opens the device. If the device does not round as the CPU does
 * (shared/exact.h), the program ends as skipped, since states on it may differ from those of the
 * CPU. Such a device does not go unnoticed: gpu.exact fails if a device should be exact but is not.
 */
int simulation_device_open(void **state);

#endif
