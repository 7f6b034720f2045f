/* Stage 2: one step of every system. All techniques give the same bits. */
#ifndef KILN_SIM_STEP_SIMULATE_H
#define KILN_SIM_STEP_SIMULATE_H

#include "base/thread.h"
#include "particles/pool.h"
#include "scene/scene.h"

enum kiln_simulate_technique {
    KILN_SIMULATE_CPU,
    KILN_SIMULATE_INPLACE,
    KILN_SIMULATE_PINGPONG,
    KILN_SIMULATE_FEEDBACK,
    KILN_SIMULATE_TEXELS,
};

struct kiln_simulate;

/* device may be NULL for `cpu`; scene and threads are borrowed. KILN_USAGE when the technique needs
 * what the device does not have; KILN_NO_DEVICE when it is inexact in a stage that the technique
 * runs on. */
struct kiln_simulate *kiln_simulate_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           enum kiln_simulate_technique technique,
                                           struct kiln_threads *threads, struct kiln_error *error);
void kiln_simulate_destroy(struct kiln_simulate **simulate);

/* Runs step number `step` (1, 2, ...) on the pool, always the same one. */
bool kiln_simulate_step(struct kiln_simulate *simulate, struct kiln_pool *pool, uint32_t step,
                        struct kiln_error *error);

/* A warning about the steps so far, once; NULL: none. It lives as long as the simulation. */
const char *kiln_simulate_warning(struct kiln_simulate *simulate);

/* The state hash, of what is painted as well, and the number of living particles, reduced where the
 * state lives. */
bool kiln_simulate_hash(struct kiln_simulate *simulate, struct kiln_pool *pool,
                        struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error);

/* Bytes that a slot's state takes: techniques with two buffers have it twice, the one with textures
 * twice there and once as a record (Heinz 2019, 4.2). */
size_t kiln_simulate_slot_bytes(enum kiln_simulate_technique technique);

#endif
