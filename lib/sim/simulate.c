/* The stage: counts births on the host, then lets the technique move the particles. */
#include "sim/simulate.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/trace.h"
#include "sim/cpu.h"
#include "sim/inplace.h"

struct kiln_simulate {
    const struct kiln_scene *scene;
    enum kiln_simulate_technique technique;
    struct kiln_threads *threads;
    struct kiln_sim_params params;
    struct kiln_inplace inplace;
    struct kiln_buffer traces; /* of parents, within a step: no part of the state */
};

struct kiln_simulate *kiln_simulate_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           enum kiln_simulate_technique technique,
                                           struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_simulate *simulate = calloc(1, sizeof *simulate);
    if (!simulate) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "simulate: no memory");
        return NULL;
    }
    simulate->scene = scene;
    simulate->technique = technique;
    simulate->threads = threads;
    kiln_sim_params_init(&simulate->params, scene);
    kiln_buffer_init(&simulate->traces, technique == KILN_SIMULATE_CPU ? NULL : device,
                     (size_t)simulate->params.trace_count * sizeof(struct kiln_trace), "traces");
    if (technique == KILN_SIMULATE_INPLACE &&
        !kiln_inplace_init(&simulate->inplace, device, scene, &simulate->params, error))
        kiln_simulate_destroy(&simulate);
    return simulate;
}

void kiln_simulate_destroy(struct kiln_simulate **simulate)
{
    if (*simulate && (*simulate)->inplace.device)
        kiln_inplace_finish(&(*simulate)->inplace);
    if (*simulate)
        kiln_buffer_finish(&(*simulate)->traces);
    free(*simulate);
    *simulate = NULL;
}

bool kiln_simulate_step(struct kiln_simulate *simulate, struct kiln_pool *pool, uint32_t step,
                        struct kiln_error *error)
{
    if (!kiln_sim_params_step(&simulate->params, simulate->scene, pool, step, error))
        return false;
    switch (simulate->technique) {
    case KILN_SIMULATE_CPU:
        return kiln_sim_cpu_step(simulate->threads, &simulate->params, simulate->scene->keys, pool,
                                 &simulate->traces, error);
    case KILN_SIMULATE_INPLACE:
        return kiln_inplace_step(&simulate->inplace, &simulate->params, pool, &simulate->traces,
                                 error);
    }
    return false;
}

bool kiln_simulate_hash(struct kiln_simulate *simulate, struct kiln_pool *pool,
                        struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error)
{
    switch (simulate->technique) {
    case KILN_SIMULATE_CPU:
        return kiln_sim_cpu_hash(simulate->threads, pool, hash, alive, error);
    case KILN_SIMULATE_INPLACE:
        return kiln_inplace_hash(&simulate->inplace, pool, hash, alive, error);
    }
    return false;
}
