/* This file steps and hashes the particles of all systems on the host, in threads. Slots are
 * stepped independently, so the division among threads changes no bit. */
#include "sim/step/cpu.h"

#include <stdatomic.h>

#include "shared/state_hash.h"

enum { SLOTS_AT_A_TIME = 2048 };

bool kiln_sim_cpu_step(kiln_slots_step *step_slots, struct kiln_threads *threads,
                       const struct kiln_sim_params *params, const float4 *value_keys,
                       struct kiln_pool *pool, struct kiln_buffer *traces,
                       struct kiln_buffer *pushes, struct kiln_error *error)
{
    struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ_WRITE, error);
    struct kiln_trace *scratch =
        params->trace_count ? kiln_buffer_host(traces, KILN_READ_WRITE, error) : NULL;
    const bool has_words = params->grids->words.size > 0;
    const float4 *words =
        has_words ? kiln_buffer_host(&params->grids->words, KILN_READ, error) : NULL;
    const float4 *planes = params->grids->volumes.count
                               ? kiln_buffer_host(&params->grids->volumes.words, KILN_READ, error)
                               : NULL;
    const float4 *pushed = params->push_count ? kiln_buffer_host(pushes, KILN_READ, error) : NULL;
    uint4 *spins =
        params->spin_count ? kiln_buffer_host(&pool->spins, KILN_READ_WRITE, error) : NULL;
    if (!records || (params->trace_count && !scratch) || (has_words && !words) ||
        (params->grids->volumes.count && !planes) || (params->push_count && !pushed) ||
        (params->spin_count && !spins))
        return false;
    for (uint32_t k = 0; k < params->system_count; k++) {
        const struct kiln_step_params *step = &params->systems[params->order[k]];
        struct kiln_slots slots = {
            .sim = {.step = step,
                    .surroundings = &params->surroundings,
                    .value_keys = value_keys,
                    .grid_words = words,
                    .push_words = pushed,
                    .spin_words = spins,
                    .volume_words = planes},
            .records = records + step->base,
            .traces = scratch,
        };
        kiln_threads_for(threads, step->used, SLOTS_AT_A_TIME, step_slots, &slots);
    }
    return true;
}

struct hash_work {
    const struct kiln_particle *records; /* records of the system */
    const struct kiln_spin *spins;       /* spins of the system; NULL: its particles do not spin */
    const struct kiln_spin *ways;        /* ways of the system; NULL: its particles have none */
    uint32_t system;
    atomic_uint a, b, alive; /* sums of integers, in which the order of threads changes no bit */
};

static void hash_slots(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct hash_work *work = context;
    uint32_t a = 0, b = 0, alive = 0;
    for (size_t slot = begin; slot < end; slot++) {
        struct state_hash_lanes lanes = state_hash_particle(work->system, work->records[slot]);
        if (work->spins) {
            const struct state_hash_lanes turning =
                state_hash_spin(work->system, work->records[slot], work->spins[slot]);
            lanes.a += turning.a;
            lanes.b += turning.b;
        }
        if (work->ways) {
            const struct state_hash_lanes travelled =
                state_hash_spin(work->system, work->records[slot], work->ways[slot]);
            lanes.a += travelled.a;
            lanes.b += travelled.b;
        }
        a += lanes.a;
        b += lanes.b;
        alive += particle_is_alive(work->records[slot]);
    }
    atomic_fetch_add(&work->a, a);
    atomic_fetch_add(&work->b, b);
    atomic_fetch_add(&work->alive, alive);
}

bool kiln_sim_cpu_hash(struct kiln_threads *threads, struct kiln_pool *pool,
                       struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error)
{
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!records)
        return false;
    const struct kiln_spin *spins = NULL;
    if (pool->spins.size > 0) {
        spins = kiln_buffer_host(&pool->spins, KILN_READ, error);
        if (!spins)
            return false;
    }
    struct hash_work work = {.system = 0};
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        work.records = records + system->base;
        work.spins = spins && system->spins ? spins + system->first_spin : NULL;
        work.ways = spins && system->travels ? spins + system->first_way : NULL;
        work.system = i;
        kiln_threads_for(threads, kiln_pool_used(system), SLOTS_AT_A_TIME, hash_slots, &work);
    }
    *hash = (struct kiln_state_hash){{atomic_load(&work.a), atomic_load(&work.b)}};
    *alive = atomic_load(&work.alive);
    return true;
}
