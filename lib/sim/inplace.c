/* The host uploads a few kilobytes a step and reads nothing back. */
#include "sim/inplace.h"

#include <string.h>

#include "base/error.h"
#include "gpu/program.h"

static bool has_families(const struct kiln_sim_params *params)
{
    bool any = false;
    for (uint32_t i = 0; i < params->system_count; i++)
        any = any || kiln_sim_is_family(&params->systems[i]);
    return any;
}

static bool has_round_colliders(const struct kiln_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        any = any || (object->collide && object->kind != KILN_OBJECT_BOX);
    }
    return any;
}

static bool create_programs(struct kiln_inplace *inplace, const struct kiln_scene *scene,
                            const struct kiln_sim_params *params, struct kiln_error *error)
{
    struct kiln_program_params program = {
        .compute = "sim/inplace.comp",
        .defines = has_round_colliders(scene) ? "#define COLLIDE_ROUND 1\n" : NULL,
    };
    inplace->step_program = kiln_program_create(inplace->device, &program, error);
    if (!inplace->step_program)
        return false;
    if (has_families(params)) {
        program.compute = "sim/family.comp";
        inplace->family_program = kiln_program_create(inplace->device, &program, error);
        if (!inplace->family_program)
            return false;
    }
    inplace->hash_program = kiln_program_create(
        inplace->device, &(struct kiln_program_params){.compute = "sim/hash.comp"}, error);
    return inplace->hash_program != 0;
}

static size_t step_stride(void)
{
    GLint alignment = 0;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    size_t unit = alignment > 0 ? (size_t)alignment : 256;
    return (sizeof(struct kiln_step_params) + unit - 1) / unit * unit;
}

bool kiln_inplace_init(struct kiln_inplace *inplace, struct kiln_device *device,
                       const struct kiln_scene *scene, const struct kiln_sim_params *params,
                       struct kiln_error *error)
{
    *inplace = (struct kiln_inplace){.device = device};
    if (!device)
        return kiln_error_set(error, KILN_USAGE, "simulate=inplace needs a device; use cpu");
    if (!device->info.exact)
        return kiln_error_set(error, KILN_USAGE,
                              "simulate=inplace: %s does not compute exactly; use simulate=cpu",
                              device->info.name);
    if (!create_programs(inplace, scene, params, error))
        return false;
    inplace->step_stride = step_stride();
    kiln_buffer_init(&inplace->keys, device, KILN_MAX_VALUE_KEYS * sizeof(float4), "value keys");
    kiln_buffer_init(&inplace->steps, device, KILN_MAX_SYSTEMS * inplace->step_stride,
                     "step parameters");
    kiln_buffer_init(&inplace->colliders, device, sizeof(struct kiln_colliders), "colliders");
    kiln_buffer_init(&inplace->sums, device, sizeof(uint4), "state hash");
    float4 *keys = kiln_buffer_host(&inplace->keys, KILN_READ_WRITE, error);
    if (!keys)
        return false;
    if (scene->key_count > 0)
        memcpy(keys, scene->keys, scene->key_count * sizeof *keys);
    return true;
}

void kiln_inplace_finish(struct kiln_inplace *inplace)
{
    kiln_buffer_finish(&inplace->keys);
    kiln_buffer_finish(&inplace->steps);
    kiln_buffer_finish(&inplace->colliders);
    kiln_buffer_finish(&inplace->sums);
    glDeleteProgram(inplace->step_program);
    glDeleteProgram(inplace->family_program);
    glDeleteProgram(inplace->hash_program);
    *inplace = (struct kiln_inplace){.device = NULL};
}

/* Uploads the step's parameters; returns the buffer that has every system's, 0 on failure. */
static GLuint upload(struct kiln_inplace *inplace, const struct kiln_sim_params *params,
                     struct kiln_error *error)
{
    unsigned char *steps = kiln_buffer_host(&inplace->steps, KILN_READ_WRITE, error);
    if (!steps)
        return 0;
    for (uint32_t i = 0; i < params->system_count; i++)
        memcpy(steps + i * inplace->step_stride, &params->systems[i], sizeof params->systems[i]);
    GLuint key_buffer = kiln_buffer_gl(&inplace->keys, KILN_READ, error);
    GLuint collider_buffer = kiln_buffer_upload(&inplace->colliders, &params->colliders, error);
    if (!key_buffer || !collider_buffer)
        return 0;
    glBindBufferBase(GL_UNIFORM_BUFFER, SIM_BIND_KEYS, key_buffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, SIM_BIND_COLLIDERS, collider_buffer);
    return kiln_buffer_gl(&inplace->steps, KILN_READ, error);
}

bool kiln_inplace_step(struct kiln_inplace *inplace, const struct kiln_sim_params *params,
                       struct kiln_pool *pool, struct kiln_buffer *traces, struct kiln_error *error)
{
    GLuint steps = upload(inplace, params, error);
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ_WRITE, error);
    if (!steps || !records)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    if (params->trace_count > 0) {
        GLuint scratch = kiln_buffer_gl(traces, KILN_READ_WRITE, error);
        if (!scratch)
            return false;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_TRACES, scratch);
    }
    for (uint32_t k = 0; k < params->system_count; k++) {
        uint32_t i = params->order[k];
        const struct kiln_step_params *step = &params->systems[i];
        if (step->family.born_of != BORN_OF_CLOCK) /* its parent has written traces */
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        glUseProgram(kiln_sim_is_family(step) ? inplace->family_program : inplace->step_program);
        glBindBufferRange(GL_UNIFORM_BUFFER, SIM_BIND_STEP, steps,
                          (GLintptr)(i * inplace->step_stride), sizeof(struct kiln_step_params));
        kiln_device_dispatch(inplace->device, step->used, SIM_GROUP_SIZE);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return kiln_device_check(inplace->device, "simulate", error);
}

bool kiln_inplace_hash(struct kiln_inplace *inplace, struct kiln_pool *pool,
                       struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error)
{
    uint4 *sums = kiln_buffer_host(&inplace->sums, KILN_OVERWRITE, error);
    if (!sums)
        return false;
    *sums = UINT4(0, 0, 0, 0);
    GLuint sum_buffer = kiln_buffer_gl(&inplace->sums, KILN_READ_WRITE, error);
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ, error);
    if (!sum_buffer || !records)
        return false;
    glUseProgram(inplace->hash_program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_SUMS, sum_buffer);
    for (uint32_t i = 0; i < pool->system_count; i++) {
        uint32_t used = kiln_pool_used(&pool->systems[i]);
        glUniform1ui(0, i);
        glUniform1ui(1, pool->systems[i].base);
        glUniform1ui(2, used);
        kiln_device_dispatch(inplace->device, (used + SIM_HASH_SLOTS - 1) / SIM_HASH_SLOTS,
                             SIM_GROUP_SIZE);
    }
    if (!kiln_device_check(inplace->device, "state hash", error))
        return false;
    sums = kiln_buffer_host(&inplace->sums, KILN_READ, error);
    if (!sums)
        return false;
    *hash = (struct kiln_state_hash){{sums->x, sums->y}};
    *alive = sums->z;
    return true;
}
