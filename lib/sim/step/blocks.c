/* This file uploads the parameters of a step into uniform blocks, and creates the programs of each
 * GL technique with only the code that the scene needs. The host uploads a few kilobytes a step and
 * reads nothing back. */
#include "sim/step/blocks.h"

#include <stddef.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "shared/trace.h"
#include "sim/step/uses.h"
#include "sim/world/colliders.h"

static size_t step_stride(void)
{
    GLint alignment = 0;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    size_t unit = alignment > 0 ? (size_t)alignment : 256;
    return (sizeof(struct kiln_step_params) + unit - 1) / unit * unit;
}

static uint32_t group_size(const struct kiln_device *device)
{
    return device->work_group_size ? device->work_group_size : SIM_GROUP_SIZE;
}

bool kiln_sim_blocks_init(struct kiln_sim_blocks *blocks, struct kiln_device *device,
                          const struct kiln_scene *scene, struct kiln_error *error)
{
    *blocks = (struct kiln_sim_blocks){
        .device = device, .group_size = group_size(device), .step_stride = step_stride()};
    if (blocks->group_size > (uint32_t)device->info.max_work_group_invocations)
        return kiln_error_set(
            error, KILN_USAGE, "a work group has %u invocations; %s takes at most %d",
            blocks->group_size, device->info.name, device->info.max_work_group_invocations);
    kiln_buffer_init(&blocks->keys, device,
                     kiln_scene_stores_keys(scene) ? 0 : KILN_BLOCK_KEYS * sizeof(float4),
                     "value keys");
    kiln_buffer_init(&blocks->steps, device,
                     (scene->system_count ? scene->system_count : 1) * blocks->step_stride,
                     "step parameters");
    kiln_buffer_init(&blocks->surroundings, device,
                     kiln_sim_stores_surroundings(scene) ? sizeof(struct kiln_surroundings)
                                                         : KILN_SURROUNDINGS_BLOCK,
                     "surroundings");
    if (blocks->keys.size == 0)
        return true;
    float4 *keys = kiln_buffer_host(&blocks->keys, KILN_READ_WRITE, error);
    if (keys && scene->key_count > 0)
        memcpy(keys, scene->keys, scene->key_count * sizeof *keys);
    return keys != NULL;
}

void kiln_sim_blocks_finish(struct kiln_sim_blocks *blocks)
{
    kiln_buffer_finish(&blocks->keys);
    kiln_buffer_finish(&blocks->steps);
    kiln_buffer_finish(&blocks->surroundings);
    *blocks = (struct kiln_sim_blocks){.device = NULL};
}

/* Copies the first of all tables of the surroundings, as a uniform block has them. */
static void pack_surroundings(const struct kiln_surroundings *around, unsigned char *block)
{
    const struct {
        const void *from;
        size_t size;
    } parts[] = {
        {around, offsetof(struct kiln_surroundings, colliders)},
        {around->colliders, KILN_BLOCK_COLLIDERS * sizeof *around->colliders},
        {around->grids, KILN_BLOCK_GRIDS * sizeof *around->grids},
        {around->poses, KILN_BLOCK_MESHES * sizeof *around->poses},
    };
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        memcpy(block, parts[i].from, parts[i].size);
        block += parts[i].size;
    }
}

/* Uploads the surroundings and binds them. */
static bool bind_surroundings(struct kiln_sim_blocks *blocks,
                              const struct kiln_surroundings *around, struct kiln_error *error)
{
    const bool stored = blocks->surroundings.size > KILN_SURROUNDINGS_BLOCK;
    unsigned char block[KILN_SURROUNDINGS_BLOCK];
    if (!stored)
        pack_surroundings(around, block);
    const GLuint buffer = kiln_buffer_upload(
        &blocks->surroundings, stored ? (const void *)around : (const void *)block, error);
    if (!buffer)
        return false;
    if (stored)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_AROUND, buffer);
    else
        glBindBufferBase(GL_UNIFORM_BUFFER, SIM_BIND_SURROUNDINGS, buffer);
    return true;
}

bool kiln_sim_blocks_upload(struct kiln_sim_blocks *blocks, const struct kiln_sim_params *params,
                            struct kiln_buffer *traces, struct kiln_buffer *pushes,
                            struct kiln_buffer *spins, struct kiln_error *error)
{
    unsigned char *steps = kiln_buffer_host(&blocks->steps, KILN_READ_WRITE, error);
    if (!steps)
        return false;
    for (uint32_t i = 0; i < params->system_count; i++)
        memcpy(steps + i * blocks->step_stride, &params->systems[i], sizeof params->systems[i]);
    if (!bind_surroundings(blocks, &params->surroundings, error) ||
        !kiln_buffer_gl(&blocks->steps, KILN_READ, error))
        return false;
    if (blocks->keys.size > 0) {
        GLuint keys = kiln_buffer_gl(&blocks->keys, KILN_READ, error);
        if (!keys)
            return false;
        glBindBufferBase(GL_UNIFORM_BUFFER, SIM_BIND_KEYS, keys);
    }
    if (params->grids->words.size > 0) {
        GLuint words = kiln_buffer_gl(&params->grids->words, KILN_READ, error);
        if (!words)
            return false;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_GRIDS, words);
    }
    if (params->grids->volumes.count > 0) {
        GLuint words = kiln_buffer_gl(&params->grids->volumes.words, KILN_READ, error);
        if (!words)
            return false;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_VOLUMES, words);
    }
    if (params->push_count > 0) {
        GLuint words = kiln_buffer_gl(pushes, KILN_READ, error);
        if (!words)
            return false;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_PUSHES, words);
    }
    if (params->spin_count > 0) {
        GLuint words = kiln_buffer_gl(spins, KILN_READ_WRITE, error);
        if (!words)
            return false;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_SPINS, words);
    }
    if (params->trace_count == 0)
        return true;
    GLuint scratch = kiln_buffer_gl(traces, KILN_READ_WRITE, error);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_TRACES, scratch);
    return scratch != 0;
}

void kiln_sim_blocks_bind(const struct kiln_sim_blocks *blocks,
                          const struct kiln_sim_params *params, uint32_t system)
{
    if (params->systems[system].family.born_of != BORN_OF_CLOCK) /* the system's parent has left
                                                                  * traces */
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glBindBufferRange(GL_UNIFORM_BUFFER, SIM_BIND_STEP, blocks->steps.gl,
                      (GLintptr)(system * blocks->step_stride), sizeof(struct kiln_step_params));
}

/* Returns whether there are systems of families, or others. */
static bool has_systems(const struct kiln_sim_params *params, bool families)
{
    bool any = false;
    for (uint32_t i = 0; i < params->system_count; i++)
        any = any || kiln_sim_is_family(&params->systems[i]) == families;
    return any;
}

static bool has_rubbing(const struct kiln_sim_params *params)
{
    bool any = false;
    for (uint32_t i = 0; i < params->system_count; i++)
        any = any || params->systems[i].rubs;
    return any;
}

/* The kinds of colliders that look up a grid that does not change. */
enum { KINDS_FIELD = 1u << COLLIDER_TERRAIN | 1u << COLLIDER_SDF | 1u << COLLIDER_DEPTH };

static void add_define(struct kiln_text *defines, const char *name, bool wanted)
{
    if (wanted)
        kiln_text_add(defines, "#define %s 1\n", name);
}

/* Adds the defines of a kernel, which choose the parts of its code that its systems need. */
static void add_defines(struct kiln_text *defines, const struct kiln_device *device,
                        const struct kiln_scene *scene, const struct kiln_sim_params *params,
                        bool families)
{
    const uint colliders = kiln_sim_colliders_used(scene);
    const bool grids = params->grids->count > 0 || params->grids->has_sources,
               pushes = params->push_count > 0;
    const bool forces = kiln_sim_needs_all_forces(scene);
    kiln_text_add(defines, "#define SIM_GROUP_SIZE %u\n", group_size(device));
    add_define(defines, "COLLIDE_RUB", has_rubbing(params));
    add_define(defines, "GRIDS", grids);
    add_define(defines, "SURROUNDINGS_STORED", kiln_sim_stores_surroundings(scene));
    add_define(defines, "KEYS_STORED", params->grids->key_words > 0);
    add_define(defines, "COLLIDE_FIELD", (colliders & KINDS_FIELD) != 0);
    add_define(defines, "COLLIDE_VOLUME", (colliders & 1u << COLLIDER_VOLUME) != 0);
    add_define(defines, "COLLIDE_DEPTH", (colliders & 1u << COLLIDER_DEPTH) != 0);
    add_define(defines, "SOURCES", params->grids->has_sources);
    add_define(defines, "PUSHES", pushes);
    add_define(defines, "SPINS", params->spin_count > 0);
    add_define(defines, "FORCES_ALL", forces);
    add_define(defines, "SWEEP_ALL", scene->integration != KILN_INTEGRATE_SEMI_IMPLICIT);
    add_define(defines, "FAMILY", families);
    kiln_sim_add_uses(defines, scene, params, families);
}

/* Creates one of the two programs of a kernel, if a system needs it. */
static bool create_program(GLuint *program, struct kiln_device *device,
                           const struct kiln_scene *scene, const struct kiln_sim_params *params,
                           bool families, struct kiln_program_params files,
                           struct kiln_error *error)
{
    struct kiln_text defines = {0};
    if (!has_systems(params, families))
        return true;
    kiln_text_add(&defines, "%s", files.defines ? files.defines : "");
    add_defines(&defines, device, scene, params, families);
    *program = kiln_program_create_defined(device, &files, &defines, error);
    return *program != 0;
}

bool kiln_sim_programs_init(struct kiln_sim_programs *programs, struct kiln_device *device,
                            const struct kiln_scene *scene, const struct kiln_sim_params *params,
                            struct kiln_program_params files, struct kiln_error *error)
{
    *programs = (struct kiln_sim_programs){.alone = 0};
    return create_program(&programs->alone, device, scene, params, false, files, error) &&
           create_program(&programs->family, device, scene, params, true, files, error);
}

void kiln_sim_programs_finish(struct kiln_sim_programs *programs)
{
    if (programs->alone)
        glDeleteProgram(programs->alone);
    if (programs->family)
        glDeleteProgram(programs->family);
    *programs = (struct kiln_sim_programs){.alone = 0};
}

GLuint kiln_sim_programs_of(const struct kiln_sim_programs *programs,
                            const struct kiln_step_params *step)
{
    return kiln_sim_is_family(step) ? programs->family : programs->alone;
}
