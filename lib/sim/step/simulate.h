/* Declares stage 2, which runs one step of every system. All techniques give the same bits. */
#ifndef KILN_SIM_STEP_SIMULATE_H
#define KILN_SIM_STEP_SIMULATE_H

#include "base/thread.h"
#include "particles/pool.h"
#include "scene/scene.h"
#include "sim/gas/gas.h"

enum kiln_simulate_technique {
    KILN_SIMULATE_CPU,
    KILN_SIMULATE_INPLACE,
    KILN_SIMULATE_PINGPONG,
    KILN_SIMULATE_FEEDBACK,
    KILN_SIMULATE_TEXELS,
};

struct kiln_simulate;

/* Creates the stage. gas: technique that steps gas. device may be NULL if both are `cpu`; scene and
 * threads are borrowed. KILN_USAGE when the device lacks what the technique needs; KILN_NO_DEVICE
 * when it is inexact in a stage that the technique runs on. */
struct kiln_simulate *kiln_simulate_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           enum kiln_simulate_technique technique,
                                           enum kiln_gas_technique gas,
                                           struct kiln_threads *threads, struct kiln_error *error);

/* Adds the memory of the technique `cpu`, without pools. */
void kiln_simulate_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_simulate_destroy(struct kiln_simulate **simulate);

/* Runs step number `step` (1, 2, ...) on the pool, which must be the same one in every call. */
bool kiln_simulate_step(struct kiln_simulate *simulate, struct kiln_pool *pool, uint32_t step,
                        struct kiln_error *error);

/* kiln_simulate_show_births adds the particles of bursts at exactly the end of step `step`, the
 * last one that was run, to the pool, at age 0. So a burst at the time of a frame can be drawn and
 * hashed in that frame, although it happens in the next step. kiln_simulate_hide_births restores
 * the pool, bit for bit; it must be called before the next step. */
bool kiln_simulate_show_births(struct kiln_simulate *simulate, struct kiln_pool *pool,
                               uint32_t step, struct kiln_error *error);
bool kiln_simulate_hide_births(struct kiln_simulate *simulate, struct kiln_pool *pool,
                               struct kiln_error *error);

/* Returns a warning about the steps so far, once; NULL: none. The text lives as long as the
 * simulation. */
const char *kiln_simulate_warning(struct kiln_simulate *simulate);

/* Fills in the seconds of processors that each pass of the steps of gas has taken (enum gas_timer
 * of sim/gas/solver.h). They count from the first call on. */
void kiln_simulate_gas_seconds(struct kiln_simulate *simulate, double seconds[]);

/* Computes the state hash, which includes paint, and the number of living particles, on the side
 * where the state lies. */
bool kiln_simulate_hash(struct kiln_simulate *simulate, struct kiln_pool *pool,
                        struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error);

/* Returns the bytes of a slot's state. Techniques with two buffers have it twice; the one with
 * textures has it twice there and once as a record (Heinz 2019, 4.2). */
size_t kiln_simulate_slot_bytes(enum kiln_simulate_technique technique);

#endif
