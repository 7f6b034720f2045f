/* This file steps particles in compute from the pool's buffer into a second one. Then the two
 * buffers change places, so no record is copied. */
#include "shared/papers/step_layout.h"
#include "sim/step/papers/common.h"
#include "sim/step/papers/papers.h"

struct pingpong {
    struct kiln_sim_programs programs;
    struct kiln_buffer second; /* as large as the pool's records */
};

static void finish(void *technique)
{
    struct pingpong *pingpong = technique;
    kiln_sim_programs_finish(&pingpong->programs);
    kiln_buffer_finish(&pingpong->second);
}

static bool init(void *technique, struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_sim_params *params, struct kiln_error *error)
{
    struct pingpong *pingpong = technique;
    kiln_buffer_init(&pingpong->second, device, 0, KILN_SIM_SECOND);
    const struct kiln_program_params files = {.compute = "sim/step/papers/pingpong.comp"};
    return kiln_sim_programs_init(&pingpong->programs, device, scene, params, files, error);
}

static bool step_pool(void *technique, const struct kiln_sim_blocks *blocks,
                      const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t number,
                      struct kiln_error *error)
{
    (void)number;
    struct pingpong *pingpong = technique;
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ_WRITE, error);
    GLuint second = kiln_sim_second(&pingpong->second, pool, error);
    if (!records || !second)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_SECOND, second);
    for (uint32_t k = 0; k < params->system_count; k++) {
        uint32_t i = params->order[k];
        const struct kiln_step_params *step = &params->systems[i];
        kiln_sim_blocks_bind(blocks, params, i);
        glUseProgram(kiln_sim_programs_of(&pingpong->programs, step));
        kiln_device_dispatch(blocks->device, step->used, blocks->group_size);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    kiln_buffer_swap_gl(&pool->records, &pingpong->second);
    return kiln_device_check(blocks->device, "simulate", error);
}

const struct kiln_simulate_row kiln_simulate_pingpong_row = {
    .copies = 2,
    .size = sizeof(struct pingpong),
    .init = init,
    .finish = finish,
    .step = step_pool,
};
