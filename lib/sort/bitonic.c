/* Bitonic merge sort (Heinz 2019, 2.4.1 and 3.4; UberFlow, 4.3.2): bunches of twice the size in
 * each stage, the list padded to a power of two, but at least to a block. Passes whose comparisons
 * stay within a block run as one kernel in shared memory; those that reach farther go through the
 * buffer, three at a time. */
#include "sort/bitonic.h"

#include <stdlib.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/sort_layout.h"
#include "sort/alive.h"

enum { PAIR_BYTES = 8, MAX_LEVELS = 3 };

struct kiln_bitonic {
    struct kiln_device *device;
    struct kiln_alive alive;
    GLuint pad_program, start_program, block_program, take_program;
    GLuint far_programs[MAX_LEVELS]; /* for 1, 2 and 3 passes at once */
    struct kiln_buffer pairs, list;
};

static bool create_programs(struct kiln_bitonic *bitonic, struct kiln_error *error)
{
    const struct {
        const char *file, *defines;
        GLuint *program;
    } kernels[] = {
        {"sort/bitonic_pad.comp", NULL, &bitonic->pad_program},
        {"sort/bitonic_block.comp", "#define FROM_START 1\n", &bitonic->start_program},
        {"sort/bitonic_block.comp", NULL, &bitonic->block_program},
        {"sort/bitonic_far.comp", "#define LEVELS 1\n", &bitonic->far_programs[0]},
        {"sort/bitonic_far.comp", "#define LEVELS 2\n", &bitonic->far_programs[1]},
        {"sort/bitonic_far.comp", "#define LEVELS 3\n", &bitonic->far_programs[2]},
        {"sort/bitonic_take.comp", NULL, &bitonic->take_program},
    };
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++) {
        const struct kiln_program_params params = {.compute = kernels[i].file,
                                                   .defines = kernels[i].defines};
        *kernels[i].program = kiln_program_create(bitonic->device, &params, error);
        if (!*kernels[i].program)
            return false;
    }
    return true;
}

struct kiln_bitonic *kiln_bitonic_create(struct kiln_device *device, struct kiln_error *error)
{
    struct kiln_bitonic *bitonic = calloc(1, sizeof *bitonic);
    if (!bitonic) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "sort: no memory");
        return NULL;
    }
    bitonic->device = device;
    kiln_buffer_init(&bitonic->pairs, device, 0, "sort pairs");
    kiln_buffer_init(&bitonic->list, device, 0, "unsorted entries");
    if (!kiln_alive_init(&bitonic->alive, device, KILN_ALIVE_PLACES, error) ||
        !create_programs(bitonic, error))
        kiln_bitonic_destroy(&bitonic);
    return bitonic;
}

void kiln_bitonic_destroy(struct kiln_bitonic **bitonic)
{
    if (!*bitonic)
        return;
    kiln_alive_finish(&(*bitonic)->alive);
    kiln_buffer_finish(&(*bitonic)->pairs);
    kiln_buffer_finish(&(*bitonic)->list);
    glDeleteProgram((*bitonic)->pad_program);
    glDeleteProgram((*bitonic)->start_program);
    glDeleteProgram((*bitonic)->block_program);
    for (int i = 0; i < MAX_LEVELS; i++)
        glDeleteProgram((*bitonic)->far_programs[i]);
    glDeleteProgram((*bitonic)->take_program);
    free(*bitonic);
    *bitonic = NULL;
}

uint32_t kiln_bitonic_padded(uint32_t count)
{
    uint32_t padded = 1;
    while (padded < count)
        padded *= 2;
    return padded;
}

/* One kernel over so many invocations' worth of work. */
static void dispatch(struct kiln_bitonic *bitonic, GLuint program, const uint32_t *uniforms,
                     GLint uniform_count, uint32_t work, uint32_t group_work)
{
    glUseProgram(program);
    for (GLint i = 0; i < uniform_count; i++)
        glUniform1ui(i, uniforms[i]);
    kiln_device_dispatch(bitonic->device, work, group_work);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/* The passes over distances from half a bunch down to a block, which are the first of its merge. */
static void run_far(struct kiln_bitonic *bitonic, uint32_t padded, uint32_t size)
{
    uint32_t distance = size / 2;
    while (distance >= BITONIC_BLOCK) {
        uint32_t levels = 1;
        while (levels < MAX_LEVELS && distance >> levels >= BITONIC_BLOCK)
            levels++;
        uint32_t spacing = distance >> (levels - 1);
        dispatch(bitonic, bitonic->far_programs[levels - 1], (uint32_t[]){padded, size, spacing}, 3,
                 padded >> levels, SORT_GROUP_SIZE);
        distance = spacing / 2;
    }
}

static void sort_padded(struct kiln_bitonic *bitonic, uint32_t padded)
{
    dispatch(bitonic, bitonic->start_program, (uint32_t[]){padded}, 1, padded, BITONIC_BLOCK);
    for (uint32_t size = BITONIC_BLOCK * 2; size <= padded; size *= 2) {
        run_far(bitonic, padded, size);
        dispatch(bitonic, bitonic->block_program, (uint32_t[]){padded, size}, 2, padded,
                 BITONIC_BLOCK);
    }
}

bool kiln_bitonic_pairs(struct kiln_bitonic *bitonic, struct kiln_buffer *pairs,
                        struct kiln_buffer *list, uint32_t count, bool reverse,
                        struct kiln_buffer *entries, struct kiln_error *error)
{
    if (count == 0)
        return true;
    GLuint pair_buffer = kiln_buffer_gl(pairs, KILN_READ_WRITE, error);
    GLuint list_buffer = pair_buffer ? kiln_buffer_gl(list, KILN_READ, error) : 0;
    GLuint sorted = list_buffer ? kiln_buffer_gl(entries, KILN_READ_WRITE, error) : 0;
    if (!sorted)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS, pair_buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, list_buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_ENTRIES, sorted);
    uint32_t padded = kiln_bitonic_padded(count);
    dispatch(bitonic, bitonic->pad_program, (uint32_t[]){count, padded}, 2, padded - count,
             SORT_GROUP_SIZE);
    sort_padded(bitonic, padded);
    dispatch(bitonic, bitonic->take_program, (uint32_t[]){count, reverse}, 2, count,
             SORT_GROUP_SIZE);
    return kiln_device_check(bitonic->device, "sort: bitonic", error);
}

bool kiln_bitonic_run(struct kiln_bitonic *bitonic, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_buffer *entries,
                      uint32_t *count, struct kiln_error *error)
{
    struct kiln_alive *alive = &bitonic->alive;
    if (params->order == KILN_SORT_BY_SERIAL)
        return kiln_alive_run(alive, pool, params, entries, NULL, count, error);
    kiln_buffer_reserve(&bitonic->pairs,
                        (size_t)kiln_bitonic_padded(pool->slot_count) * PAIR_BYTES);
    kiln_buffer_reserve(&bitonic->list, (size_t)pool->slot_count * sizeof(uint32_t));
    return kiln_alive_run(alive, pool, params, &bitonic->list, &bitonic->pairs, count, error) &&
           kiln_bitonic_pairs(bitonic, &bitonic->pairs, &bitonic->list, *count,
                              params->order == KILN_SORT_FRONT_TO_BACK, entries, error);
}
