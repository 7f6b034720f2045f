/* This file steps particles in place, in one compute dispatch a system. One invocation reads and
 * writes each slot, so no second buffer is needed. */
#include "sim/step/row.h"

static void finish(void *technique)
{
    kiln_sim_programs_finish(technique);
}

static bool init(void *technique, struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_sim_params *params, struct kiln_error *error)
{
    const struct kiln_program_params files = {.compute = "sim/step/inplace.comp"};
    return kiln_sim_programs_init(technique, device, scene, params, files, error);
}

static bool step_pool(void *technique, const struct kiln_sim_blocks *blocks,
                      const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t number,
                      struct kiln_error *error)
{
    (void)number;
    const struct kiln_sim_programs *programs = technique;
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ_WRITE, error);
    if (!records)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    for (uint32_t k = 0; k < params->system_count; k++) {
        uint32_t i = params->order[k];
        const struct kiln_step_params *step = &params->systems[i];
        kiln_sim_blocks_bind(blocks, params, i);
        glUseProgram(kiln_sim_programs_of(programs, step));
        kiln_device_dispatch(blocks->device, step->used, blocks->group_size);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return kiln_device_check(blocks->device, "simulate", error);
}

const struct kiln_simulate_row kiln_simulate_inplace_row = {
    .copies = 1,
    .size = sizeof(struct kiln_sim_programs),
    .init = init,
    .finish = finish,
    .step = step_pool,
};
