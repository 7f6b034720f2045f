/* Computes the state hash in GL, for every technique that keeps the state there. */
#ifndef KILN_SIM_STEP_HASH_H
#define KILN_SIM_STEP_HASH_H

#include "sim/world/params.h"

struct kiln_sim_hash {
    struct kiln_device *device;
    GLuint program;
    GLuint spins;            /* program for how particles turn; 0 until some do */
    struct kiln_buffer sums; /* two lanes and the living */
};

/* After a failure, too, kiln_sim_hash_finish frees what there is. */
bool kiln_sim_hash_init(struct kiln_sim_hash *hash, struct kiln_device *device,
                        struct kiln_error *error);
void kiln_sim_hash_finish(struct kiln_sim_hash *hash);

bool kiln_sim_hash_run(struct kiln_sim_hash *hash, struct kiln_pool *pool,
                       struct kiln_state_hash *state, uint64_t *alive, struct kiln_error *error);

#endif
