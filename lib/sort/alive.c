/* This file lists the living particles on the device. It counts the living particles of each block
 * of slots, computes prefix sums of the counts, and writes each block's list behind the lists of
 * the blocks before it. The host reads back only the number of living particles. */
#include "sort/alive.h"

#include "base/error.h"
#include "gpu/program.h"
#include "shared/sort_layout.h"

bool kiln_alive_init(struct kiln_alive *alive, struct kiln_device *device,
                     enum kiln_alive_pairs kind, struct kiln_error *error)
{
    *alive = (struct kiln_alive){.device = device, .kind = kind};
    kiln_buffer_init(&alive->counts, device, 0, "counts of the living");
    if (!kiln_scan_init(&alive->scan, device, error))
        return false;
    struct kiln_program_params params = {.compute = "sort/alive_count.comp"};
    alive->count_program = kiln_program_create(device, &params, error);
    if (!alive->count_program)
        return false;
    params.compute = "sort/alive_list.comp";
    alive->list_program = kiln_program_create(device, &params, error);
    if (!alive->list_program)
        return false;
    params.defines = kind == KILN_ALIVE_INDICES ? "#define NUMBERED 1\n" : "#define PAIRED 1\n";
    alive->pair_program = kiln_program_create(device, &params, error);
    return alive->pair_program != 0;
}

void kiln_alive_finish(struct kiln_alive *alive)
{
    kiln_scan_finish(&alive->scan);
    kiln_buffer_finish(&alive->counts);
    glDeleteProgram(alive->count_program);
    glDeleteProgram(alive->list_program);
    glDeleteProgram(alive->pair_program);
    *alive = (struct kiln_alive){.device = NULL};
}

static uint32_t blocks_of(uint32_t slots)
{
    return slots / SORT_BLOCK + (slots % SORT_BLOCK != 0);
}

/* Returns how many blocks the chosen systems have. */
static uint32_t count_blocks(const struct kiln_pool *pool, uint64_t systems)
{
    uint32_t blocks = 0;
    for (uint32_t i = 0; i < pool->system_count; i++) {
        if (systems >> i & 1)
            blocks += blocks_of(kiln_pool_used(&pool->systems[i]));
    }
    return blocks;
}

/* Dispatches the current program once for each chosen system that has used slots. */
static void run_systems(struct kiln_alive *alive, const struct kiln_pool *pool, uint64_t systems)
{
    uint32_t first_block = 0;
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        uint32_t used = kiln_pool_used(system);
        if (!(systems >> i & 1) || used == 0)
            continue;
        glUniform1ui(SORT_AT_BASE, system->base);
        glUniform1ui(SORT_AT_CAPACITY, system->capacity);
        glUniform1ui(SORT_AT_OLDEST, (uint32_t)((system->next_serial - used) % system->capacity));
        glUniform1ui(SORT_AT_USED, used);
        glUniform1ui(SORT_AT_FIRST_BLOCK, first_block);
        glUniform1ui(SORT_AT_SYSTEM, i);
        kiln_device_dispatch(alive->device, used, SORT_BLOCK);
        first_block += blocks_of(used);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/* Binds a buffer that will be written; does nothing for NULL. */
static bool bind_output(GLuint binding, struct kiln_buffer *buffer, struct kiln_error *error)
{
    if (!buffer)
        return true;
    GLuint gl = kiln_buffer_gl(buffer, KILN_READ_WRITE, error);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, gl);
    return gl != 0;
}

bool kiln_alive_run(struct kiln_alive *alive, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *list,
                    struct kiln_buffer *pairs, uint32_t *count, struct kiln_error *error)
{
    *count = 0;
    uint32_t blocks = count_blocks(pool, params->systems);
    if (blocks == 0)
        return true;
    kiln_buffer_reserve(&alive->counts, blocks * sizeof(uint32_t));
    GLuint counts = kiln_buffer_gl(&alive->counts, KILN_OVERWRITE, error);
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ, error);
    if (!counts || !records)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_RECORDS, records);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, counts);
    glUseProgram(alive->count_program);
    run_systems(alive, pool, params->systems);
    if (!kiln_scan_run(&alive->scan, counts, blocks, error) ||
        !bind_output(SORT_BIND_ENTRIES, list, error) || !bind_output(SORT_BIND_PAIRS, pairs, error))
        return false;

    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, counts);
    glUseProgram(pairs ? alive->pair_program : alive->list_program);
    if (pairs) {
        glUniform3f(SORT_AT_EYE, params->eye.x, params->eye.y, params->eye.z);
        glUniform3f(SORT_AT_FORWARD, params->forward.x, params->forward.y, params->forward.z);
    }
    run_systems(alive, pool, params->systems);
    return kiln_device_check(alive->device, "sort: list", error) &&
           kiln_scan_total(&alive->scan, count, error);
}
