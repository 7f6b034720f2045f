/* This file hashes the state of all particles by a compute shader (shaders/sim/step/hash.comp), so
 * that the records stay in GL. Three sums come back to the host: the two of the hash, and the
 * number of living particles.
 *
 * kiln_simulate_hash calls it when the hash of a state is wanted, for every technique that keeps
 * the particles in GL, and adds the painted textures to the hash itself. On the host,
 * kiln_sim_cpu_hash takes the place of this file. Both must give equal sums, since goldens and
 * saved states have the same hash whatever the technique: what a particle adds is written once, in
 * shared/state_hash.h. */
#include "sim/step/hash.h"

#include "gpu/program.h"

bool kiln_sim_hash_init(struct kiln_sim_hash *hash, struct kiln_device *device,
                        struct kiln_error *error)
{
    *hash = (struct kiln_sim_hash){.device = device};
    kiln_buffer_init(&hash->sums, device, sizeof(uint4), "state hash");
    hash->program = kiln_program_create(
        device, &(struct kiln_program_params){.compute = "sim/step/hash.comp"}, error);
    return hash->program != 0;
}

void kiln_sim_hash_finish(struct kiln_sim_hash *hash)
{
    kiln_buffer_finish(&hash->sums);
    if (hash->program)
        glDeleteProgram(hash->program);
    if (hash->spins)
        glDeleteProgram(hash->spins);
    *hash = (struct kiln_sim_hash){.device = NULL};
}

/* Adds the particles of a system, or their spins if that program is in use, to the sums. */
static void add_system(const struct kiln_sim_hash *hash, const struct kiln_pool *pool,
                       uint32_t system)
{
    const uint32_t used = kiln_pool_used(&pool->systems[system]);
    glUniform1ui(SIM_AT_SYSTEM, system);
    glUniform1ui(SIM_AT_BASE, pool->systems[system].base);
    glUniform1ui(SIM_AT_USED, used);
    kiln_device_dispatch(hash->device, (used + SIM_HASH_SLOTS - 1) / SIM_HASH_SLOTS,
                         SIM_GROUP_SIZE);
}

/* Adds the spins and ways of all systems that have them. Their program is made when it is first
 * used. */
static bool add_spins(struct kiln_sim_hash *hash, struct kiln_pool *pool, struct kiln_error *error)
{
    const GLuint spins = kiln_buffer_gl(&pool->spins, KILN_READ, error);
    if (!hash->spins)
        hash->spins =
            kiln_program_create(hash->device,
                                &(struct kiln_program_params){.compute = "sim/step/hash.comp",
                                                              .defines = "#define SPINS 1\n"},
                                error);
    if (!spins || !hash->spins)
        return false;
    glUseProgram(hash->spins);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_SPINS, spins);
    for (uint32_t i = 0; i < pool->system_count; i++) {
        glUniform1ui(SIM_AT_FIRST_SPIN, pool->systems[i].first_spin);
        if (pool->systems[i].spins)
            add_system(hash, pool, i);
        glUniform1ui(SIM_AT_FIRST_SPIN, pool->systems[i].first_way);
        if (pool->systems[i].travels)
            add_system(hash, pool, i);
    }
    return true;
}

bool kiln_sim_hash_run(struct kiln_sim_hash *hash, struct kiln_pool *pool,
                       struct kiln_state_hash *state, uint64_t *alive, struct kiln_error *error)
{
    uint4 *sums = kiln_buffer_host(&hash->sums, KILN_OVERWRITE, error);
    if (!sums)
        return false;
    *sums = UINT4(0, 0, 0, 0);
    GLuint sum_buffer = kiln_buffer_gl(&hash->sums, KILN_READ_WRITE, error);
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ, error);
    if (!sum_buffer || !records)
        return false;
    glUseProgram(hash->program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_SUMS, sum_buffer);
    for (uint32_t i = 0; i < pool->system_count; i++)
        add_system(hash, pool, i);
    if (pool->spins.size > 0 && !add_spins(hash, pool, error))
        return false;
    if (!kiln_device_check(hash->device, "state hash", error))
        return false;
    sums = kiln_buffer_host(&hash->sums, KILN_READ, error);
    if (!sums)
        return false;
    *state = (struct kiln_state_hash){{sums->x, sums->y}};
    *alive = sums->z;
    return true;
}
