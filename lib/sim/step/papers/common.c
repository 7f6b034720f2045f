/* This file has what several techniques of this folder need: the check of a stage that particles
 * are moved in, and a second buffer of records. */
#include "sim/step/papers/common.h"

#include "base/error.h"

bool kiln_sim_check_stage(struct kiln_device *device, const struct kiln_sim_params *params,
                          enum kiln_probe_stage stage, struct kiln_error *error)
{
    const bool fragment = stage == KILN_PROBE_FRAGMENT;
    const char *name = fragment ? "fragment" : "geometry";
    GLint blocks = 0;
    glGetIntegerv(fragment ? GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS
                           : GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS,
                  &blocks);
    const GLint needed = (params->trace_count > 0) + (params->grids->words.size > 0) +
                         (params->grids->volumes.count > 0) + (params->push_count > 0) +
                         (params->spin_count > 0);
    if (blocks < needed)
        return kiln_error_set(
            error, KILN_NO_DEVICE,
            "%s: there are %d storage blocks in %s shaders, and this scene, with children, paint, "
            "grids, volumes or interaction, needs %d; use simulate=pingpong",
            device->info.name, blocks, name, needed);
    char reason[256];
    struct kiln_error problem = {0};
    if (kiln_probe_exact(device, stage, reason, &problem))
        return true;
    return kiln_error_set(error, KILN_NO_DEVICE,
                          "%s computes inexactly in %s shaders (%s); use simulate=pingpong",
                          device->info.name, name, reason[0] ? reason : problem.message);
}

GLuint kiln_sim_second(struct kiln_buffer *second, const struct kiln_pool *pool,
                       struct kiln_error *error)
{
    if (second->size != pool->records.size) {
        struct kiln_device *device = second->device;
        kiln_buffer_finish(second);
        kiln_buffer_init(second, device, pool->records.size, KILN_SIM_SECOND);
    }
    return kiln_buffer_gl(second, KILN_READ_WRITE, error);
}
