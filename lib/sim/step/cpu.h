/* Declares technique `cpu`, which steps particles in threads, with the records on the host. It is
 * the reference for all other techniques, and the fastest on a machine without a GPU. */
#ifndef KILN_SIM_STEP_CPU_H
#define KILN_SIM_STEP_CPU_H

#include "base/thread.h"
#include "sim/step/slots.h"
#include "sim/world/params.h"

/* Runs a step. traces: struct kiln_trace [params->trace_count], scratch memory. pushes have been
 * computed. step_slots: the loop for this processor. */
bool kiln_sim_cpu_step(kiln_slots_step *step_slots, struct kiln_threads *threads,
                       const struct kiln_sim_params *params, const float4 *value_keys,
                       struct kiln_pool *pool, struct kiln_buffer *traces,
                       struct kiln_buffer *pushes, struct kiln_error *error);

/* Computes the state hash of the host's records, in threads. */
bool kiln_sim_cpu_hash(struct kiln_threads *threads, struct kiln_pool *pool,
                       struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error);

#endif
