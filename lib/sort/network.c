/* This file implements the steps that all sorting networks share: it lists the living particles as
 * pairs, pads the pairs to a power of two, runs the network and writes the sorted list. A sorting
 * network is not stable. So pairs hold the index in the unsorted list instead of the entry, which
 * makes equal depths keep their order. */
#include "sort/network.h"

#include <stdio.h>

#include "gpu/program.h"
#include "shared/sort_layout.h"

enum { PAIR_BYTES = 8, MAX_SHARED_BYTES = 32768 };

uint32_t kiln_network_group_size(const struct kiln_device *device)
{
    return kiln_device_group_size(device, NETWORK_GROUP_SIZE,
                                  MAX_SHARED_BYTES / (NETWORK_ITEMS * PAIR_BYTES));
}

bool kiln_network_programs(struct kiln_device *device, const struct kiln_network_kernel *kernels,
                           size_t count, struct kiln_error *error)
{
    for (size_t i = 0; i < count; i++) {
        char defines[128];
        snprintf(defines, sizeof defines, "#define NETWORK_GROUP_SIZE %u\n%s",
                 kiln_network_group_size(device), kernels[i].defines ? kernels[i].defines : "");
        const struct kiln_program_params params = {.compute = kernels[i].file, .defines = defines};
        *kernels[i].program = kiln_program_create(device, &params, error);
        if (!*kernels[i].program)
            return false;
    }
    return true;
}

bool kiln_network_init(struct kiln_network *network, struct kiln_device *device,
                       kiln_network_sort *sort, void *context, struct kiln_error *error)
{
    *network = (struct kiln_network){.device = device, .sort = sort, .context = context};
    kiln_buffer_init(&network->pairs, device, 0, "sort pairs");
    kiln_buffer_init(&network->list, device, 0, "unsorted entries");
    const struct kiln_network_kernel kernels[] = {
        {"sort/network_pad.comp", NULL, &network->pad_program},
        {"sort/network_take.comp", NULL, &network->take_program},
    };
    return kiln_alive_init(&network->alive, device, KILN_ALIVE_INDICES, error) &&
           kiln_network_programs(device, kernels, sizeof kernels / sizeof *kernels, error);
}

void kiln_network_finish(struct kiln_network *network)
{
    kiln_alive_finish(&network->alive);
    kiln_buffer_finish(&network->pairs);
    kiln_buffer_finish(&network->list);
    glDeleteProgram(network->pad_program);
    glDeleteProgram(network->take_program);
    *network = (struct kiln_network){.device = NULL};
}

uint32_t kiln_network_padded(uint32_t count)
{
    uint32_t padded = 1;
    while (padded < count)
        padded *= 2;
    return padded;
}

uint64_t kiln_network_bytes(uint32_t slots)
{
    return (uint64_t)kiln_network_padded(slots) * PAIR_BYTES +
           2 * sizeof(uint32_t) * (uint64_t)slots;
}

void kiln_network_dispatch(struct kiln_device *device, GLuint program,
                           const struct kiln_network_uniform *uniforms, size_t uniform_count,
                           uint32_t work, uint32_t group_work)
{
    glUseProgram(program);
    for (size_t i = 0; i < uniform_count; i++)
        glUniform1ui(uniforms[i].location, uniforms[i].value);
    kiln_device_dispatch(device, work, group_work);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

bool kiln_network_pairs(struct kiln_network *network, struct kiln_buffer *pairs,
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
    uint32_t padded = kiln_network_padded(count);
    const struct kiln_network_uniform pad_uniforms[] = {{SORT_AT_COUNT, count},
                                                        {SORT_AT_PADDED, padded}};
    kiln_network_dispatch(network->device, network->pad_program, pad_uniforms, 2, padded - count,
                          SORT_GROUP_SIZE);
    if (!network->sort(network->context, pairs, padded, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS, pairs->gl);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, list_buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_ENTRIES, sorted);
    const struct kiln_network_uniform take_uniforms[] = {{SORT_AT_COUNT, count},
                                                         {SORT_AT_REVERSE, reverse}};
    kiln_network_dispatch(network->device, network->take_program, take_uniforms, 2, count,
                          SORT_GROUP_SIZE);
    return kiln_device_check(network->device, "sort: network", error);
}

bool kiln_network_run(struct kiln_network *network, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_buffer *entries,
                      uint32_t *count, struct kiln_error *error)
{
    struct kiln_alive *alive = &network->alive;
    if (params->order == KILN_SORT_BY_SERIAL)
        return kiln_alive_run(alive, pool, params, entries, NULL, count, error);
    kiln_buffer_reserve(&network->pairs,
                        (size_t)kiln_network_padded(pool->slot_count) * PAIR_BYTES);
    kiln_buffer_reserve(&network->list, (size_t)pool->slot_count * sizeof(uint32_t));
    return kiln_alive_run(alive, pool, params, &network->list, &network->pairs, count, error) &&
           kiln_network_pairs(network, &network->pairs, &network->list, *count,
                              params->order == KILN_SORT_FRONT_TO_BACK, entries, error);
}
