/* Computes the state hash in GL, for every technique that keeps the state there. */
#ifndef KILN_SIM_STEP_HASH_H
#define KILN_SIM_STEP_HASH_H

#include "sim/world/params.h"

struct kiln_sim_hash {
    struct kiln_device *device;
    GLuint program;
    GLuint spins;            /* program for spins; 0 before any particle spins */
    struct kiln_buffer sums; /* the two sums of the hash, and the number of living particles */
};

/* Creates the programs. kiln_sim_hash_finish frees everything, also after a failure. */
bool kiln_sim_hash_init(struct kiln_sim_hash *hash, struct kiln_device *device,
                        struct kiln_error *error);
void kiln_sim_hash_finish(struct kiln_sim_hash *hash);

bool kiln_sim_hash_run(struct kiln_sim_hash *hash, struct kiln_pool *pool,
                       struct kiln_state_hash *state, uint64_t *alive, struct kiln_error *error);

#endif
