/* Technique `cpu`: the step in threads, the records on the host. It is the reference, and the fast
 * path on a machine without a GPU. */
#ifndef KILN_SIM_STEP_CPU_H
#define KILN_SIM_STEP_CPU_H

#include "base/thread.h"
#include "sim/step/slots.h"
#include "sim/world/params.h"

/* traces: struct kiln_trace [params->trace_count], scratch. pushes: gathered. loops: for this
 * machine. */
bool kiln_sim_cpu_step(const struct kiln_slots_step *loops, struct kiln_threads *threads,
                       const struct kiln_sim_params *params, const float4 *value_keys,
                       struct kiln_pool *pool, struct kiln_buffer *traces,
                       struct kiln_buffer *pushes, struct kiln_error *error);

/* The sums over the host's records, in threads. */
bool kiln_sim_cpu_hash(struct kiln_threads *threads, struct kiln_pool *pool,
                       struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error);

#endif
